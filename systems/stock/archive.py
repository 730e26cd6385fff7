"""Growths as bytes, and back."""

from collections.abc import Mapping
from dataclasses import fields
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...engine.zipped import zipped
from ..grow.record import Blades, Growth, PatchModel, Postures, Response
from ..show.registry import REPRESENTATIONS


def pack(growth: Growth, /) -> bytes:
    """Return a growth as the bytes of a file such as numpy's `savez` writes."""
    return zipped(_flatten(growth, "growth"))


def unpack(data: bytes | memoryview, /) -> Growth:
    """Return a growth that was packed. Nothing is ever unpickled."""
    growth = _nested(data)["growth"]
    return Growth(
        postures=Postures(**growth["postures"]),
        response=Response(**growth["response"]),
        models=tuple(
            PatchModel(Blades(**model["blades"]), _pictures(model.get("pictures", {})))
            for model in growth["models"].values()
        ),
    )


def _flatten(record: Any, name: str, /) -> dict[str, NDArray[Any]]:
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


def _nested(data: bytes | memoryview, /) -> dict[str, Any]:
    """Return the arrays and numbers of a file in a mapping for each part of their dotted names, in the file's order."""
    tree: dict[str, Any] = {}
    with np.load(BytesIO(data), allow_pickle=False) as archive:
        for name in archive.files:
            *path, last = name.split(".")
            node = tree
            for part in path:
                node = node.setdefault(part, {})
            array = archive[name]
            node[last] = array if array.ndim else float(array)
    return tree


def _pictures(given: Mapping[str, Mapping[str, Any]], /) -> dict[str, tuple[Any, ...]]:
    """Return a patch model's pictures, by representation."""
    drawn = [(each.name, each.record) for each in REPRESENTATIONS if each.record is not None]
    return {name: tuple(record(**picture) for picture in given.get(name, {}).values()) for name, record in drawn}
