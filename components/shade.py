"""What casts a shadow on the grass."""

from dataclasses import dataclass
from math import isfinite


@dataclass(frozen=True, slots=True)
class Shade:
    """Something that stands between the sun and the grass, taken as a ball: the component of a game's own entity.

    A prairie in the same world draws its shadow; of many, those count that are nearest to the eye. Raises ValueError
    for a place that is nowhere, and for a radius that is no length.
    """

    place: tuple[float, float, float]
    """Where its middle is (x, y, z) [m]."""

    radius: float
    """How large it is, above 0 [m]."""

    def __post_init__(self) -> None:
        """Raise ValueError for what cannot cast a shadow."""
        if len(self.place) != 3 or not all(map(isfinite, self.place)):
            raise ValueError(f"a shade's place is three finite numbers (x, y, z), not {self.place!r}")
        if not (isfinite(self.radius) and self.radius > 0.0):
            raise ValueError(f"a shade's radius is above 0 m, not {self.radius!r}")
