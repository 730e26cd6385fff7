"""Pressers that walk through the grass, as a scene's file declares them."""

from dataclasses import fields
from typing import Self

from pydantic import Field, model_validator

from ...components.declaration import DeclarationError, Pair
from ...components.presser import Presser
from .way import Placed

LARGEST = 20.0

SHAPE = tuple(field.name for field in fields(Presser))
"""Fields of a presser's shape; a scene declares them under the same names."""


class PresserOnPath(Placed):
    """A footprint that presses grass down, at a fixed place or on its way along a path."""

    radius: float = Field(default=0.3, ge=0.02, le=LARGEST)
    """Radius of a disc, and half the width of a capsule [m]."""

    length: float = Field(default=0.0, ge=0.0, le=LARGEST)
    """Distance between the middles of a capsule's round ends, along its heading [m]."""

    corners: list[Pair] = Field(default=[], max_length=64)
    """Corners (x, z) of a polygon, x to its right and -z ahead, instead of `radius` and `length` [m]."""

    strength: float = Field(default=1.0, ge=0.0, le=1.0)
    """Strength of the pressure: 1 lays grass of stiffness 1 flat."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        try:
            self.footprint()
        except ValueError as error:
            raise DeclarationError(str(error), "corners") from error
        return self

    def footprint(self) -> Presser:
        """Return the component of the presser."""
        return Presser(**{name: getattr(self, name) for name in SHAPE if name in type(self).model_fields})
