"""What casts a shadow on the grass."""

from dataclasses import dataclass
from math import hypot, isfinite


@dataclass(frozen=True, slots=True)
class Shade:
    """Something that stands between the sun and the grass: the component of a game's own entity.

    It is taken as a ball; with a `height`, as one stretched or pressed flat along `up`: a disc, an egg, a trunk. The
    farther its shadow falls, the softer is its edge. A prairie in the same world draws it; of many, those eight count
    that are nearest to the eye. Raises ValueError for a place that is nowhere, for an `up` that leads nowhere, and for
    a radius or height that is no length.
    """

    place: tuple[float, float, float]
    """Where its middle is (x, y, z) [m]."""

    radius: float
    """How large it is about `up`, above 0 [m]."""

    height: float | None = None
    """How high it is from end to end along `up`, above 0 [m]; without it, twice the radius, which is a ball."""

    up: tuple[float, float, float] = (0.0, 1.0, 0.0)
    """The direction of the axis that it is round about, of any length."""

    def __post_init__(self) -> None:
        """Raise ValueError for what cannot cast a shadow."""
        if len(self.place) != 3 or not all(map(isfinite, self.place)):
            raise ValueError(f"a shade's place is three finite numbers (x, y, z), not {self.place!r}")
        if not (isfinite(self.radius) and self.radius > 0.0):
            raise ValueError(f"a shade's radius is above 0 m, not {self.radius!r}")
        if self.height is not None and not (isfinite(self.height) and self.height > 0.0):
            raise ValueError(f"a shade's height is above 0 m, not {self.height!r}")
        if len(self.up) != 3 or not all(map(isfinite, self.up)) or hypot(*self.up) < 1e-6:
            raise ValueError(f"a shade's up is a direction (x, y, z), not {self.up!r}")
