"""Records that are saved as JSON: their components lie there by fields, and their arrays beside it."""

from dataclasses import asdict
from numbers import Real
from types import NoneType
from typing import Annotated, Any, NoReturn

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PlainSerializer
from pydantic_core import core_schema

Time = Annotated[float, Field(ge=0.0, le=1e9)]
"""A time that a prairie may have [s]."""


class Stored:
    """The annotation of an array of this type and shape, where None is any length.

    In JSON an array is its index in the context, a list. Numbers of single precision lie there as planes of bytes,
    which compress far better.
    """

    def __init__(self, kind: type[np.generic], *shape: int | None) -> None:
        self._kind, self._shape = np.dtype(kind), shape

    def __get_pydantic_core_schema__(self, _source: object, _handler: object) -> core_schema.CoreSchema:
        """Return how an array is read and written."""
        write = core_schema.plain_serializer_function_ser_schema(self._write, info_arg=True)
        return core_schema.with_info_plain_validator_function(self._read, serialization=write)

    def _read(self, given: Any, info: core_schema.ValidationInfo) -> NDArray[Any]:
        if isinstance(given, int):
            if info.context is None or not 0 <= given < len(info.context):
                raise ValueError("an array is missing")
            given = self._joined(info.context[given])
        fits = isinstance(given, np.ndarray) and given.dtype == self._kind and given.ndim == len(self._shape)
        if not fits or any(due not in (None, n) for due, n in zip(self._shape, given.shape, strict=True)):
            raise ValueError("an array has a wrong type or shape")
        if self._kind == np.float64 and not np.isfinite(given).all():  # heights may be NaN, over holes
            raise ValueError("an array has numbers that are not finite")
        found: NDArray[Any] = given
        return found

    def _write(self, array: NDArray[Any], info: core_schema.SerializationInfo) -> int:
        arrays: list[NDArray[Any]] = info.context  # type: ignore[assignment]
        is_split = self._kind == np.float32
        arrays.append(np.moveaxis(array[..., None].view(np.uint8), -1, 0) if is_split else array)
        return len(arrays) - 1

    def _joined(self, array: NDArray[Any]) -> NDArray[Any]:
        if self._kind != np.float32 or array.dtype != np.uint8 or array.shape[:1] != (4,):
            return array
        return np.ascontiguousarray(np.moveaxis(array, 0, -1)).view(np.float32)[..., 0]


def _fields_of(component: Any) -> dict[str, object]:
    return {name: _plain(value) for name, value in asdict(component).items()}


def _plain(value: Any) -> object:
    if isinstance(value, bool | str | NoneType):
        return value
    return float(value) if isinstance(value, Real) else [_plain(each) for each in value]


AS_FIELDS = PlainSerializer(_fields_of)
"""The annotation of a component, whose fields may be numpy's numbers."""


def refuse(why: str, /) -> NoReturn:
    """Raise ValueError for an invalid state, whose checksum matches nevertheless."""
    raise ValueError(f"this state is invalid: {' '.join(why.split())[:200]}")


def unfit(why: str, /) -> NoReturn:
    """Raise ValueError for a state that does not fit a scene."""
    raise ValueError(f"this state does not fit this scene: {why}")
