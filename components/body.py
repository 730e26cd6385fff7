"""What is seen of a thing that flies over the prairie."""

from dataclasses import dataclass
from typing import Literal

Model = Literal["saucer"]
"""What a body looks like."""


@dataclass(frozen=True, slots=True)
class Body:
    """A flying thing of one instant: first turned by `yaw`, then its nose tilted, then banked."""

    place: tuple[float, float, float]
    """Where the middle of it is (x, y, z) [m]."""

    yaw: float = 0.0
    """Heading: 0 is -z, positive turns right [rad]."""

    nose: float = 0.0
    """Tilt about its right axis: positive lifts the nose [rad]."""

    bank: float = 0.0
    """Tilt about its forward axis: positive lowers its right side [rad]."""

    model: Model = "saucer"
