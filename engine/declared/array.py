"""Arrays and functions that a program hands in where a scene file names a file."""

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, GetCoreSchemaHandler, GetPydanticSchema
from pydantic_core import CoreSchema, core_schema

from ...components.declaration import DeclarationError


class MapArray:
    """A read-only copy of a program's array. Two are equal if they hold the same numbers."""

    __slots__ = ("values",)

    def __init__(self, array: NDArray[Any], /) -> None:
        self.values = np.array(array, order="C")
        self.values.flags.writeable = False

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MapArray) or self.values.dtype != other.values.dtype:
            return False
        return self is other or np.array_equal(self.values, other.values, equal_nan=self.values.dtype.kind == "f")

    def __hash__(self) -> int:
        return hash((self.values.shape, self.values.dtype.str))

    def __repr__(self) -> str:
        return f"<array of shape {self.values.shape}, {self.values.dtype}>"


class HeightFunction:
    """A program's function that returns heights of the ground. Two are equal if they are the same function."""

    __slots__ = ("function",)

    def __init__(self, function: Callable[..., Any], /) -> None:
        self.function = function

    def __eq__(self, other: object) -> bool:
        return isinstance(other, HeightFunction) and self.function == other.function

    def __hash__(self) -> int:
        return hash(self.function)

    def __repr__(self) -> str:
        return f"<function {self.name}>"

    @property
    def name(self) -> str:
        """Name of the function."""
        return str(getattr(self.function, "__qualname__", type(self.function).__qualname__))


def _asked(value: Any, as_text: core_schema.ValidatorFunctionWrapHandler) -> Any:
    if isinstance(value, HeightFunction):
        return value
    is_function = callable(value) and not isinstance(value, type | MapArray)
    return HeightFunction(value) if is_function else _taken(value, as_text)


def _taken(value: Any, as_text: core_schema.ValidatorFunctionWrapHandler) -> Any:
    if isinstance(value, np.ma.MaskedArray):
        raise DeclarationError("the mask of a masked array is not read; hand in what its filled() returns")
    if isinstance(value, list | tuple):
        raise DeclarationError("a map is a file's name or, in a program, an array: hand in numpy.array(rows), no list")
    if isinstance(value, MapArray):
        return value
    return MapArray(value) if isinstance(value, np.ndarray) else as_text(value)


def _or_array(text: Any, /, take: Callable[..., Any] = _taken) -> GetPydanticSchema:
    """Return the schema of a file's name, or of values that `take` accepts instead; editors see the name alone."""

    def made(_: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        shown = core_schema.plain_serializer_function_ser_schema(
            lambda value: repr(value) if isinstance(value, MapArray | HeightFunction) else value, when_used="json"
        )
        return core_schema.no_info_wrap_validator_function(take, handler(text), serialization=shown)

    return GetPydanticSchema(made)


HeightsSource = Annotated[str | MapArray | HeightFunction, _or_array(str, _asked)]
"""Name of a map's file, the map itself, or a function of places."""

PictureOrArray = Annotated[str | MapArray, _or_array(Annotated[str, Field(min_length=1)])]
"""Name of a picture's file, or its array."""
