"""Footprints: the outlines on the ground under which grass is pressed down or cut."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from numbers import Real
from reprlib import repr as shortened
from typing import ClassVar


@dataclass(frozen=True, slots=True)
class Footprint:
    """A disc; with a `length` a capsule; with `corners` a polygon, which may be hollow but does not cross itself.

    A `Pose` says where it lies. Raises ValueError for what is no footprint.
    """

    _largest: ClassVar[float] = 1000.0

    radius: float = 0.3
    """Radius of a disc, and half the width of a capsule [m]."""

    length: float = 0.0
    """Distance between the middles of a capsule's round ends, along its heading [m]."""

    corners: tuple[tuple[float, float], ...] = ()
    """Corners (x, z) of a polygon in its own frame, x to the right and -z ahead [m]; in place of the other two."""

    def __post_init__(self) -> None:
        """Make pairs of the corners, whatever they stand in; raise ValueError for what is no footprint."""
        object.__setattr__(self, "corners", _pairs(self.corners))
        most = self._largest
        if not is_between(0.02, self.radius, most):
            raise ValueError(f"a footprint's radius is from 0.02 to {most:g} m, not {self.radius!r}")
        if not is_between(0.0, self.length, most):
            raise ValueError(f"a footprint's length is from 0 to {most:g} m, not {self.length!r}")
        if self.corners and not (
            len(self.corners) >= 3
            and all(isfinite(number) and abs(number) <= most for corner in self.corners for number in corner)
            and _area(self.corners) > 1e-3
        ):
            raise ValueError(f"a footprint's corners are 3 or more places (x, z) within {most:g} m, not in a line")


def is_between(least: float, thing: object, most: float) -> bool:
    """Return whether something is a number from `least` to `most`."""
    return isinstance(thing, Real) and least <= float(thing) <= most


def _pairs(corners: Iterable[Iterable[float]]) -> tuple[tuple[float, float], ...]:
    try:
        return tuple((float(x), float(z)) for x, z in corners)
    except (TypeError, ValueError):
        raise ValueError(f"a footprint's corners are places (x, z), not {shortened(corners)}") from None


def _area(corners: tuple[tuple[float, float], ...]) -> float:
    turned = (*corners[1:], corners[0])
    return abs(sum(x * other_z - other_x * z for (x, z), (other_x, other_z) in zip(corners, turned, strict=True))) / 2.0
