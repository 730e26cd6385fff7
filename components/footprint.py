"""Footprints: the outlines on the ground under which grass is pressed down, cut, sown or cleared."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from numbers import Real
from reprlib import repr as shortened
from typing import TYPE_CHECKING, ClassVar

from .immutable import immutable


@immutable
@dataclass(frozen=True, slots=True)
class Footprint:
    """A disc; with a `length` a capsule; with `corners` a polygon, which may be hollow but does not cross itself.

    A `Pose` says where it lies. Raises ValueError for an impossible footprint.
    """

    _largest: ClassVar[float] = 1000.0

    radius: float = 0.3
    """Radius of a disc, and half the width of a capsule [m]."""

    length: float = 0.0
    """Distance between the middles of a capsule's round ends, along its heading [m]."""

    corners: tuple[tuple[float, float], ...] = ()
    """Corners (x, z) of a polygon in its own frame, x to the right and -z ahead [m]; in place of the other two."""

    if TYPE_CHECKING:  # places may stand in lists and arrays

        def __init__(self, radius: float = 0.3, length: float = 0.0, corners: Iterable[Iterable[float]] = ()) -> None:
            """Take what `__post_init__` makes of it."""

    def __post_init__(self) -> None:
        """Convert the corners to pairs; raise ValueError for an impossible footprint."""
        object.__setattr__(self, "corners", _pairs(self.corners, "a footprint's corners are"))
        most = self._largest
        if not is_between(0.02, self.radius, most):
            raise ValueError(f"a footprint's radius is from 0.02 to {most:g} m, not {shortened(self.radius)}")
        if not is_between(0.0, self.length, most):
            raise ValueError(f"a footprint's length is from 0 to {most:g} m, not {shortened(self.length)}")
        if self.corners and not (
            len(self.corners) >= 3
            and all(isfinite(number) and abs(number) <= most for corner in self.corners for number in corner)
            and _area(self.corners) > 1e-3
        ):
            raise ValueError(
                f"a footprint's corners are 3 or more places (x, z) within {most:g} m, that enclose an area"
            )


@immutable
@dataclass(frozen=True, slots=True)
class Road:
    """A way of one width along a line of places, round at its ends and bends; a `Pose` says where its frame lies.

    Raises ValueError for an impossible road.
    """

    _farthest: ClassVar[float] = 20_000.0

    line: tuple[tuple[float, float], ...]
    """Places (x, z) in its own frame that it goes through, straight from each to the next, 2 or more [m]."""

    width: float = 4.0
    """Width [m]."""

    if TYPE_CHECKING:

        def __init__(self, line: Iterable[Iterable[float]], width: float = 4.0) -> None:
            """Take what `__post_init__` makes of it."""

    def __post_init__(self) -> None:
        """Convert the places to pairs; raise ValueError for an impossible road."""
        object.__setattr__(self, "line", _pairs(self.line, "a road goes through"))
        far, numbers = self._farthest, [number for place in self.line for number in place]
        if len(self.line) < 2 or not all(isfinite(number) and abs(number) <= far for number in numbers):
            raise ValueError(f"a road goes through 2 or more places (x, z) within {far:g} m")
        if not is_between(0.05, self.width, 1000.0):
            raise ValueError(f"a road's width is from 0.05 to 1000 m, not {shortened(self.width)}")


def is_between(least: float, thing: object, most: float) -> bool:
    """Return whether something is a number from `least` to `most`."""
    # `type` first, as it is quicker than `isinstance`, and this is called within frames.
    try:
        return (type(thing) is float or isinstance(thing, Real)) and least <= float(thing) <= most
    except OverflowError:  # an integer beyond all floats
        return False


def _pairs(places: Iterable[Iterable[float]], due: str) -> tuple[tuple[float, float], ...]:
    try:
        return tuple((float(x), float(z)) for x, z in places)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{due} places (x, z), not {shortened(places)}") from None


def _area(corners: tuple[tuple[float, float], ...]) -> float:
    turned = (*corners[1:], corners[0])
    return abs(sum(x * other_z - other_x * z for (x, z), (other_x, other_z) in zip(corners, turned, strict=True))) / 2.0
