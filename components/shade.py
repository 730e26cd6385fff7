"""Shades: things that cast a shadow on the grass."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import hypot, isfinite
from reprlib import repr as shortened
from sys import float_info
from typing import TYPE_CHECKING

from .footprint import is_between
from .immutable import immutable

_LARGEST = float_info.max


@immutable
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

    if TYPE_CHECKING:  # the three may be lists, vectors and arrays

        def __init__(
            self, place: Iterable[float], radius: float | None = None, height: float | None = None,
            up: Iterable[float] = (0.0, 1.0, 0.0), capsule: bool = False, size: Iterable[float] | None = None,  # noqa: FBT001, FBT002
            yaw: float = 0.0,
        ) -> None:  # fmt: skip
            """Take what `__post_init__` makes of it."""

    def __post_init__(self) -> None:
        """Convert place, direction and size to tuples; raise ValueError for an impossible shade."""
        self._set_three("place", "a shade's place is three finite numbers (x, y, z)")
        self._set_three("up", "a shade's up is a direction (x, y, z)")
        if hypot(*self.up) < 1e-6:
            raise ValueError(f"a shade's up is a direction (x, y, z), not {self.up}")
        if self.size is None:
            self._must_be_round()
        else:
            self._must_be_a_box()

    def _set_three(self, name: str, due: str) -> None:
        """Convert a field to a tuple of three numbers; raise ValueError for anything else, and say what is `due`."""
        given = getattr(self, name)
        if type(given) is tuple and [*map(type, given)] == [float] * 3 and all(map(isfinite, given)):
            return  # a short cut for the usual type: bodies make shades in every frame
        try:
            x, y, z = given
        except (TypeError, ValueError):
            raise ValueError(f"{due}, not {shortened(given)}") from None
        if not all(is_between(-_LARGEST, number, _LARGEST) for number in (x, y, z)):
            raise ValueError(f"{due}, not {shortened(given)}")
        object.__setattr__(self, name, (float(x), float(y), float(z)))

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
        self._set_three("size", due := "a shade's size is three lengths above 0 m")
        if not all(map(_is_length, self.size)):  # type: ignore[arg-type]
            raise ValueError(f"{due}, not {self.size}")
        if self.radius is not None or self.height is not None or self.capsule:
            raise ValueError("a shade with a size is a box: it has no radius, no height, and is no capsule")
        if not is_between(-_LARGEST, self.yaw, _LARGEST):
            raise ValueError(f"a shade's yaw is finite, not {shortened(self.yaw)}")


def _is_length(thing: object) -> bool:
    return is_between(0.0, thing, _LARGEST) and thing != 0.0
