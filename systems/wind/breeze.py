"""The gentle breeze: everywhere, small oscillations about a mean that drifts slowly (paper, section 3.3)."""

from math import radians
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from ...components.arrays import Floats
from ...components.wind import Grass, TwinValues
from ...engine.noise import PERIOD, noise_table, smooth_noise
from .mean import MeanWind

WAVE, VEERS = 7.0, 0.7
"""Length of the waves that travel over the prairie [m]; largest turn of the wind in them at a gustiness of 1 [rad]."""


class Breeze(MeanWind):
    """A light wind over the whole prairie, whose strength and direction drift in waves that travel with it."""

    twin: ClassVar[str | None] = "breeze.glsl"
    color: ClassVar[tuple[float, float, float] | None] = (0.55, 0.90, 1.00)

    kind: Literal["breeze"] = "breeze"
    """A gentle breeze."""

    gustiness: float = Field(default=0.5, ge=0.0, le=1.0)
    """Amplitude of the waves in which its strength and direction drift; 0 is steady."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return its messages at ground positions (n, 2): a mean that drifts slowly, shape (n, 2)."""
        heading, (x, z) = np.radians(self.direction), self.phases(time=time)
        wave = smooth_noise(noise_table(seed, 0), place / np.float32(WAVE), shift=(-x / WAVE, -z / WAVE))
        drift = np.float32(self.gustiness) * (wave[:, 0] + np.float32(0.5) * wave[:, 1])
        index = np.clip(np.float32(self.strength) * (1 + drift), 0.0, 1.0)
        angle = np.float32(heading) + np.float32(VEERS * self.gustiness) * wave[:, 2]
        return np.stack([np.sin(angle) * index, -np.cos(angle) * index], axis=1).astype(np.float32)

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return its heading [rad], and the shift of its waves within the noise's period [lattice units]."""
        x, z = self.phases(time=time)
        shift = -x / WAVE % PERIOD, -z / WAVE % PERIOD
        return TwinValues({"heading": radians(self.direction), "shift": shift}, (noise_table(seed, 0),))
