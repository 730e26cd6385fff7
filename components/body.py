"""What is seen of a thing that flies over the prairie."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

Model = Literal["saucer"]
"""What a body looks like."""

HIGHEST = 1000.0
"""How high a body may fly above the grass [m]."""


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


@dataclass(frozen=True, slots=True)
class Hover:
    """A thing that hovers over a wind, as a saucer does over its jet: what it looks like and how high it flies."""

    model: Model = "saucer"
    """What it looks like."""

    height: float = 2.0
    """How high its middle flies above the grass [m]."""

    def __post_init__(self) -> None:
        """Raise ValueError for what cannot be drawn, or not there."""
        if self.model not in get_args(Model):
            raise ValueError(f"a body looks like one of {', '.join(get_args(Model))}, not like {self.model!r}")
        height: object = self.height
        if not isinstance(height, float | int | np.floating | np.integer) or not 0.0 < height <= HIGHEST:
            raise ValueError(f"a body flies above 0 and up to {HIGHEST:g} m high, not {height!r}")
