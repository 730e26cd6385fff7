"""Growth as bytes, and back: only what is whole, ours and of the right shapes is ever believed."""

import io
import zipfile
from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from typing import Any, TypeVar, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.quality import Quality
from ...engine.kept import DIGEST, checksum
from ..grow.record import GIVES, Blades, Growth, PatchModel, Postures, Response
from ..grow.response import SAMPLES
from ..grow.simulate import LINKS
from ..show.registry import REPRESENTATIONS
from .models import ROWS, VARIANTS

Arrays = dict[str, NDArray[Any]]
Record = TypeVar("Record")


def pack(growth: Growth, /, *, key: str) -> bytes:
    """Return a growth as bytes that begin with a checksum over the rest and `key`."""
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **_flatten(growth, "growth"))
    data = buffer.getvalue()
    return checksum(data, key) + data


def unpack(data: bytes, /, *, key: str, quality: Quality, blades: int) -> Growth | None:
    """Return the growth that was packed with `key`, or None unless it is whole and fits.

    Nothing is parsed before the checksum holds, and nothing is ever unpickled.
    """
    told = memoryview(data)[DIGEST:]
    if data[:DIGEST] != checksum(told, key):
        return None
    try:
        with np.load(io.BytesIO(told), allow_pickle=False) as archive:
            growth = _rebuild({name: archive[name] for name in archive.files}, quality)
    except (OSError, ValueError, KeyError, zipfile.BadZipFile):
        return None
    return growth if _fits(growth, quality, blades) else None


def _flatten(record: Any, name: str, /) -> Arrays:
    """Return every array and number of a record under its dotted name."""
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
    """Return what each representation has grown of a model: as many records as there are."""
    pictures: dict[str, tuple[Any, ...]] = {}
    for each in REPRESENTATIONS:
        if each.record is not None:
            head = f"{name}.{each.name}."
            numbers = {int(key[len(head) :].partition(".")[0]) for key in arrays if key.startswith(head)}
            pictures[each.name] = tuple(_record(each.record, arrays, f"{head}{number}") for number in sorted(numbers))
    return pictures


def _record(kind: type[Record], arrays: Arrays, name: str, /) -> Record:
    """Return a record from its arrays; raises KeyError or ValueError unless all are there, of their types."""
    values: dict[str, Any] = {}
    for field, wanted, is_array in _fields(kind):  # type: ignore[arg-type]  # a class can be hashed
        value = arrays[f"{name}.{field}"]
        if value.dtype != wanted or (value.dtype.kind == "f" and not np.isfinite(value).all()):
            raise ValueError(f"{name}.{field} is not finite {wanted}")
        values[field] = value if is_array else float(value)
    return kind(**values)


@cache
def _fields(kind: type, /) -> tuple[tuple[str, np.dtype[Any], bool], ...]:
    """Return the name of each of a record's fields, what it is made of, and whether it is an array or one number."""
    found = []
    for field, hint in get_type_hints(kind).items():
        last = get_args(hint)[-1:] or (np.float64,)  # from numpy 2.5 on, NDArray[T] is an alias
        (wanted,) = get_args(*last) or last
        found.append((field, np.dtype(wanted), hint is not float))
    return tuple(found)


def _fits(growth: Growth, quality: Quality, blades: int, /) -> bool:
    """Tell whether every array has the shape that its record and the quality promise."""
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
