"""Growths as bytes, and back. Bytes are accepted only if types and shapes are right."""

import io
import zipfile
from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from typing import Any, TypeVar, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.quality import Quality
from ..grow.record import GIVES, Blades, Growth, PatchModel, Postures, Response
from ..grow.response import SAMPLES
from ..grow.simulate import LINKS
from ..show.registry import REPRESENTATIONS
from .models import ROWS, VARIANTS

Arrays = dict[str, NDArray[Any]]
Record = TypeVar("Record")


def pack(growth: Growth, /) -> bytes:
    """Return a growth as the bytes of a file of numpy's `savez`."""
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **_flatten(growth, "growth"))
    return buffer.getvalue()


def unpack(data: bytes | memoryview, /, *, quality: Quality, blades: int) -> Growth | None:
    """Return a growth that was packed; None if it does not fit the quality. Nothing is ever unpickled."""
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            growth = _rebuild({name: archive[name] for name in archive.files}, quality)
    except (OSError, ValueError, KeyError, zipfile.BadZipFile):
        return None
    return growth if _fits(growth, quality, blades) else None


def _flatten(record: Any, name: str, /) -> Arrays:
    """Return all arrays and numbers of a record, by their dotted names."""
    if isinstance(record, np.ndarray | float):
        return {name: np.asarray(record)}
    if isinstance(record, Mapping):
        parts = list(record.items())
    elif isinstance(record, tuple):
        parts = [(str(number), part) for number, part in enumerate(record)]
    else:
        parts = [(field.name, getattr(record, field.name)) for field in fields(record)]
    return {key: array for part, value in parts for key, array in _flatten(value, f"{name}.{part}").items()}


def _rebuild(arrays: Arrays, quality: Quality, /) -> Growth:
    return Growth(
        postures=_record(Postures, arrays, "growth.postures"),
        response=_record(Response, arrays, "growth.response"),
        models=tuple(
            PatchModel(
                blades=_record(Blades, arrays, f"growth.models.{model}.blades"),
                pictures=_pictures(arrays, f"growth.models.{model}.pictures"),
            )
            for model in range(quality.models)
        ),
    )


def _pictures(arrays: Arrays, name: str, /) -> dict[str, tuple[Any, ...]]:
    """Return a patch model's pictures by representation, as many as the arrays hold."""
    pictures: dict[str, tuple[Any, ...]] = {}
    for each in REPRESENTATIONS:
        if each.record is not None:
            prefix = f"{name}.{each.name}."
            numbers = {int(key[len(prefix) :].partition(".")[0]) for key in arrays if key.startswith(prefix)}
            pictures[each.name] = tuple(_record(each.record, arrays, f"{prefix}{number}") for number in sorted(numbers))
    return pictures


def _record(kind: type[Record], arrays: Arrays, name: str, /) -> Record:
    """Return a record made of its arrays; raises KeyError or ValueError if one is missing or of a wrong type."""
    values: dict[str, Any] = {}
    for field, wanted, is_array in _fields(kind):  # type: ignore[arg-type]  # a class can be hashed
        value = arrays[f"{name}.{field}"]
        if value.dtype != wanted or (value.dtype.kind == "f" and not np.isfinite(value).all()):
            raise ValueError(f"{name}.{field} is not finite {wanted}")
        values[field] = value if is_array else float(value)
    return kind(**values)


@cache
def _fields(kind: type, /) -> tuple[tuple[str, np.dtype[Any], bool], ...]:
    """Return each field of a record: its name, its dtype, and whether it is an array."""
    found = []
    for field, hint in get_type_hints(kind).items():
        last = get_args(hint)[-1:] or (np.float64,)  # from numpy 2.5 on, NDArray[T] is an alias
        (dtype,) = get_args(*last) or last
        found.append((field, np.dtype(dtype), hint is not float))
    return tuple(found)


def _fits(growth: Growth, quality: Quality, blades: int, /) -> bool:
    """Return whether every array has the shape that its record and the quality prescribe."""
    postures, response = growth.postures, growth.response
    return (
        postures.index.shape == (ROWS,)
        and postures.give.shape == (GIVES,)
        and postures.shape.shape == (VARIANTS, ROWS, LINKS + 1, 2)
        and response.rise.shape == response.fall.shape == (SAMPLES,)
        and all(_model_fits(model, quality, blades) for model in growth.models)
    )


def _model_fits(model: PatchModel, quality: Quality, blades: int, /) -> bool:
    grown = model.blades
    rows = (grown.height, grown.width, grown.facing, grown.variant, grown.rank)
    return (
        grown.root.shape == grown.rest.shape == (blades, 2)
        and all(row.shape == (blades,) for row in rows)
        and all(len(row) in (1, blades) for row in (grown.organ, grown.stem, grown.part, grown.stem_rest))
        and all(
            each.fits(model.pictures[each.name], quality, blades) for each in REPRESENTATIONS if each.record is not None
        )
    )
