"""What lies grass down where it goes: people, animals, wheels."""

from dataclasses import dataclass
from math import isfinite

LARGEST = 20.0
"""How far a footprint may reach from its middle [m]."""


@dataclass(frozen=True, slots=True)
class Presser:
    """A footprint that presses grass down: the component of a game's own entity, whose `Pose` says where it is.

    It is a disc; with a `length` a capsule; with `corners` a polygon. Grass under it lies down away from it, grass
    beside it bends aside. Raises ValueError for what is no footprint.
    """

    radius: float = 0.3
    """Radius of a disc, and half the width of a capsule [m]."""

    length: float = 0.0
    """Distance between the middles of a capsule's round ends, along its heading [m]."""

    corners: tuple[tuple[float, float], ...] = ()
    """Corners (x, z) of a polygon in its own frame, x to the right and -z ahead [m]; in place of the other two."""

    strength: float = 1.0
    """The length of the message in its middle, in [0, 1]: 1 lays grass of stiffness 1 flat."""

    def __post_init__(self) -> None:
        """Raise ValueError for what is no footprint."""
        if not 0.02 <= self.radius <= LARGEST:
            raise ValueError(f"a footprint's radius is from 0.02 to {LARGEST:g} m, not {self.radius!r}")
        if not 0.0 <= self.length <= LARGEST:
            raise ValueError(f"a footprint's length is from 0 to {LARGEST:g} m, not {self.length!r}")
        if not 0.0 <= self.strength <= 1.0:
            raise ValueError(f"a presser's strength is from 0 to 1, not {self.strength!r}")
        if self.corners and not (
            len(self.corners) >= 3
            and all(isfinite(number) and abs(number) <= LARGEST for corner in self.corners for number in corner)
            and _area(self.corners) > 1e-3
        ):
            raise ValueError(f"a footprint's corners are 3 or more places (x, z) within {LARGEST:g} m, not in a line")


def _area(corners: tuple[tuple[float, float], ...]) -> float:
    turned = (*corners[1:], corners[0])
    return abs(sum(x * other_z - other_x * z for (x, z), (other_x, other_z) in zip(corners, turned, strict=True))) / 2.0
