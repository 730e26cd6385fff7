"""The base of everything a scene file can declare."""

from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, WithJsonSchema

from .colour import LONG, SHORT, hex_of
from .immutable import unset


class Declaration(BaseModel):
    """A part of a scene file: strict numbers, no unknown keys, no NaN, frozen once read."""

    model_config = ConfigDict(
        extra="forbid", strict=True, frozen=True, allow_inf_nan=False, use_attribute_docstrings=True
    )

    if not TYPE_CHECKING:  # with it, type checkers would take any name

        def __setattr__(self, name: str, value: object) -> None:
            """Set a private attribute; raises AttributeError with a sentence for all others."""
            try:
                super().__setattr__(name, value)
            except ValidationError as error:
                if error.errors(include_url=False)[0]["type"] != "frozen_instance":
                    raise
                raise AttributeError(unset(self, name, type(self).model_fields)) from None


class DeclarationError(ValueError):
    """Several values of a declaration do not fit together.

    `where` leads from the declaration to the value that is wrong, as in `"path", 2, "at"`; a reader of scene
    files points there.
    """

    def __init__(self, message: str, *where: str | int) -> None:
        super().__init__(message)
        self.where = where


Number = Annotated[float, Field(ge=-1e6, le=1e6)]
"""One number of several; a million metres leave single precision room to compute with."""


def _listed(value: Any) -> Any:
    """Return a program's tuple or array as a list, as scene files give; anything else unchanged."""
    return value.tolist() if isinstance(value, np.ndarray) else list(value) if isinstance(value, tuple) else value


Pair = Annotated[list[Number], BeforeValidator(_listed), Field(min_length=2, max_length=2)]
"""Two numbers; a list rather than a tuple, because schema readers of draft 7 know its length limits."""

Triple = Annotated[list[Number], BeforeValidator(_listed), Field(min_length=3, max_length=3)]
"""Three numbers."""

Color = Annotated[
    str,
    BeforeValidator(hex_of),
    Field(pattern=f"^{LONG}$"),
    WithJsonSchema({"type": "string", "pattern": f"^({LONG}|{SHORT}|[a-zA-Z]+)$"}),
]
"""An sRGB colour `#rrggbb`; it may be written `#rgb`, or by its name in CSS."""


def rising(what: str, least: float, most: float, /) -> AfterValidator:
    """Return the validator of a rising pair of lengths within limits [m]; `what` begins its message."""

    def must_rise(pair: list[float]) -> list[float]:
        if not least <= pair[0] <= pair[1] <= most:
            raise DeclarationError(f"{what}, rising, between {least:g} and {most:g} m")
        return pair

    return AfterValidator(must_rise)
