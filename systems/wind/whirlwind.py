"""The whirlwind: a disc that bends grass along circles, strongest near the middle (paper, section 3.3)."""

from math import cos, pi, sin
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from ...components.arrays import Floats
from ...components.wind import Extent, Grass, TwinValues
from .placed import PlacedWind
from .shape import rim, rim_width, smooth

EYE = 0.3
"""Radius of the calm middle, where circles have no direction [m]."""

LOBES, UNEVEN, FALLS = 2, 0.18, 0.85
"""Number of stronger sides around the middle; their amplitude, of the strength; loss of strength at the rim."""


class Whirlwind(PlacedWind):
    """A turning wind: grass lies along circles around its middle, and a stronger side goes slowly round."""

    twin: ClassVar[str | None] = "whirlwind.glsl"
    color: ClassVar[tuple[float, float, float] | None] = (1.00, 0.42, 0.85)

    kind: Literal["whirlwind"] = "whirlwind"
    """A whirlwind."""

    priority: int = Field(default=20, ge=-1000, le=1000)
    """The highest priority at a place cancels the others; a whirlwind's goes over a gust's."""

    radius: float = Field(default=6.0, gt=0.1, le=1000.0)
    """Radius of its disc [m]."""

    strength: float = Field(default=0.75, ge=0.0, le=1.0)
    """Posture index near its middle."""

    spin: Literal["left", "right"] = "left"
    """Direction in which it turns, seen from above."""

    turning: float = Field(default=0.35, ge=0.0, le=10.0)
    """Speed at which its stronger sides turn [turns/s]."""

    soft: float = Field(default=1.5, ge=0.0, le=1000.0)
    """Distance from its edge over which it sets in, unless winds meet by priority [m]."""

    def rates(self) -> tuple[float]:
        """Return the speed of its stronger sides, clockwise seen from above [turns/s]."""
        return (-self.turning if self.spin == "left" else self.turning,)

    def extent(self, *, time: float) -> Extent:
        """Return the square around its disc."""
        return Extent(-self.radius, self.radius, -self.radius, self.radius)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return 1 in the middle of the disc, falling to 0 at its edge over `soft` [m]."""
        away = np.sqrt(place[:, 0] * place[:, 0] + place[:, 1] * place[:, 1])
        return rim(away, -self.radius, self.radius, self.soft)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return its messages: tangent to circles, with an index that falls from the middle to the edge."""
        x, z = place[:, 0], place[:, 1]
        away = np.asarray(np.maximum(np.sqrt(x * x + z * z), np.float32(1e-6)), np.float32)
        fraction = np.minimum(away / np.float32(self.radius), np.float32(1.0))
        fall = np.float32(1.0) - fraction * fraction * np.float32(FALLS)
        sign = np.float32(-1.0 if self.spin == "left" else 1.0)
        phase = np.arctan2(z, x) * np.float32(LOBES) - np.float32(self._phase(time))
        uneven = np.float32(1.0 - UNEVEN) + np.float32(UNEVEN) * np.cos(phase)
        index = np.float32(self.strength) * fall * uneven * smooth(away / np.float32(EYE))
        return np.stack([-sign * z / away * index, sign * x / away * index], axis=1)

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return the width of its rim [m], its sense of rotation, and cosine and sine of its stronger sides' phase."""
        sign, phase = -1.0 if self.spin == "left" else 1.0, self._phase(time)
        width = rim_width(-self.radius, self.radius, self.soft)
        return TwinValues({"side": width, "sign": sign, "turned": (cos(phase), sin(phase))})

    def _phase(self, time: float) -> float:
        """Return `LOBES` times the angle that its stronger sides have gone round, within one turn [rad]."""
        return 2.0 * pi * LOBES * self.phases(time=time)[0] % (2.0 * pi)
