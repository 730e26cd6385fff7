"""Bodies: things that fly over the prairie."""

from dataclasses import dataclass
from reprlib import repr as shortened
from typing import Literal, get_args

import numpy as np

from .immutable import immutable

Model = Literal["saucer"]
"""Name of a body's model."""

HIGHEST = 1000.0
"""Greatest height of a body above the grass [m]."""


@immutable
@dataclass(frozen=True, slots=True)
class Body:
    """A flying body at one instant: turned by `yaw`, then its nose tilted, then banked."""

    place: tuple[float, float, float]
    """Position of its middle (x, y, z) [m]."""

    yaw: float = 0.0
    """Heading: 0 is -z, positive turns right [rad]."""

    nose: float = 0.0
    """Tilt about its right axis: positive lifts the nose [rad]."""

    bank: float = 0.0
    """Tilt about its forward axis: positive lowers its right side [rad]."""

    model: Model = "saucer"


@immutable
@dataclass(frozen=True, slots=True)
class Hover:
    """A body that hovers over a wind, as a saucer does over its jet."""

    model: Model = "saucer"
    """Name of its model."""

    height: float = 2.0
    """Height of its middle above the grass [m]."""

    def __post_init__(self) -> None:
        """Raise ValueError for an unknown model, or a height out of range."""
        if self.model not in get_args(Model):
            raise ValueError(f"a body's model is one of {', '.join(get_args(Model))}, not {shortened(self.model)}")
        height: object = self.height
        if not isinstance(height, float | int | np.floating | np.integer) or not 0.0 < height <= HIGHEST:
            raise ValueError(f"a body flies above 0 and up to {HIGHEST:g} m high, not {shortened(height)}")
