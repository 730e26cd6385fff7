"""Winds that blow everywhere, about a mean that has a direction."""

from math import cos, radians, sin

import numpy as np
from pydantic import Field

from ...components.arrays import Floats
from ...components.wind import WindPrimitive

TOWARDS = 90.0
"""Default direction that winds blow to, as a camera's yaw [degrees]."""


class MeanWind(WindPrimitive):
    """A wind over the whole prairie, with a direction and a mean strength; its waves or eddies travel with it."""

    direction: float = Field(default=TOWARDS, ge=-360.0, le=360.0)
    """Where it blows to, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    strength: float = Field(default=0.3, ge=0.0, le=1.0)
    """Mean posture index of the grass in it."""

    speed: float = Field(default=4.0, ge=0.0, le=40.0)
    """Speed of its waves or eddies [m/s]."""

    @property
    def velocity(self) -> tuple[float, float]:
        """Velocity of its waves or eddies along x and z [m/s]."""
        heading = radians(self.direction)
        return self.speed * sin(heading), -self.speed * cos(heading)

    def rates(self) -> tuple[float, ...]:
        """Return the velocity of its waves along x and z [m/s]."""
        return self.velocity

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return 1 everywhere: it has no edge."""
        return np.ones(len(place), np.float32)
