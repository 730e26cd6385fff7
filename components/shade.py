"""What casts a shadow on the grass."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Shade:
    """Something that stands between the sun and the grass, of one instant, taken as a ball."""

    place: tuple[float, float, float]
    """Where its middle is (x, y, z) [m]."""

    radius: float
    """How large it is [m]."""
