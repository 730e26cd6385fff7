"""Shades: things that cast a shadow on the grass."""

from dataclasses import dataclass
from math import hypot, isfinite
from reprlib import repr as shortened
from sys import float_info

from .footprint import is_between

_LARGEST = float_info.max


@dataclass(frozen=True, slots=True)
class Shade:
    """A thing that casts a shadow on the prairie: the component of a game's own entity, in the prairie's world.

    With a `radius` it is a ball. With a `height` too, it is an ellipsoid along `up`: a disc, an egg, a crown of leaves.
    With `capsule` it is a rod with round ends: a person, a trunk. With a `size` it is a box: a house, a wall, a car.
    The farther its shadow falls, the softer is its edge. There may be any number; of those whose shadows are in view,
    the 256 nearest to the eye count. Raises ValueError for a place that is not finite, an `up` of length 0, an invalid
    length, and a shape that is both round and a box, or neither.
    """

    place: tuple[float, float, float]
    """Position of its middle (x, y, z) [m]."""

    radius: float | None = None
    """Radius about `up`, above 0 [m]; a box has none."""

    height: float | None = None
    """Height from end to end along `up`, above 0 [m]; without it, twice the radius, which is a ball."""

    up: tuple[float, float, float] = (0.0, 1.0, 0.0)
    """Direction of its axis, along which a box stands; its length does not count."""

    capsule: bool = False
    """Whether it is a rod with round ends instead of an ellipsoid; its `height` is at least twice its radius."""

    size: tuple[float, float, float] | None = None
    """Lengths of a box: to its right, along `up`, and ahead, each above 0 [m]."""

    yaw: float = 0.0
    """Heading of a box, as of a `Pose`: 0 is -z, positive turns right [rad]."""

    def __post_init__(self) -> None:
        """Raise ValueError for an impossible shade."""
        if not _is_place(self.place):
            raise ValueError(f"a shade's place is three finite numbers (x, y, z), not {shortened(self.place)}")
        if not _is_place(self.up) or hypot(*self.up) < 1e-6:
            raise ValueError(f"a shade's up is a direction (x, y, z), not {shortened(self.up)}")
        if self.size is None:
            self._must_be_round()
        else:
            self._must_be_a_box()

    def _must_be_round(self) -> None:
        if self.radius is None:
            raise ValueError("a shade has a radius, or the size of a box")
        if not _is_length(self.radius):
            raise ValueError(f"a shade's radius is above 0 m, not {shortened(self.radius)}")
        if self.height is not None and not _is_length(self.height):
            raise ValueError(f"a shade's height is above 0 m, not {shortened(self.height)}")
        if self.capsule and (self.height is None or self.height < 2.0 * self.radius):
            raise ValueError(f"a capsule's height is at least twice its radius, {self.radius!r}, not {self.height!r}")

    def _must_be_a_box(self) -> None:
        if not _is_place(self.size) or not all(map(_is_length, self.size)):  # type: ignore[arg-type]
            raise ValueError(f"a shade's size is three lengths above 0 m, not {shortened(self.size)}")
        if self.radius is not None or self.height is not None or self.capsule:
            raise ValueError("a shade with a size is a box: it has no radius, no height, and is no capsule")
        if not is_between(-_LARGEST, self.yaw, _LARGEST):
            raise ValueError(f"a shade's yaw is finite, not {shortened(self.yaw)}")


def _is_place(thing: object) -> bool:
    if type(thing) is tuple and len(thing) == 3 and {float}.issuperset(map(type, thing)):
        return all(map(isfinite, thing))  # a short cut for the usual type: bodies make shades in every frame
    try:
        numbers: tuple[object, ...] = tuple(thing)  # type: ignore[arg-type]
    except TypeError:
        return False
    return len(numbers) == 3 and all(is_between(-_LARGEST, number, _LARGEST) for number in numbers)


def _is_length(thing: object) -> bool:
    return is_between(0.0, thing, _LARGEST) and thing != 0.0
