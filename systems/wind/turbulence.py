"""Turbulence: eddies of all sizes about a mean wind, as real wind has them (paper, section 3.3)."""

from math import cos, pi, radians, sin
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ...components.wind import Grass, TwinValues, WindPrimitive
from ...engine.noise import PERIOD, noise_table, smooth_noise
from .eddies import ASLANT, FINER, WIDE, eddy_tables

Floats = NDArray[np.float32]

LIVES = np.array([64.0, 64.0 / FINER])
"""How many length scales the wind goes while large and small eddies become others altogether."""

TURNS = 2.0 * pi
"""Largest phase that eddies come to as they become others [rad]."""

SWAY = 4.0
"""How many length scales, ahead and aside, they wander from the way that the mean wind carries them."""


class Turbulence(WindPrimitive):
    """A wind over the whole prairie that is as turbulent as real wind, with von Karman's spectrum of eddies."""

    twin: ClassVar[str | None] = "turbulence.glsl"
    color: ClassVar[tuple[float, float, float] | None] = (0.62, 0.70, 1.00)

    kind: Literal["turbulence"] = "turbulence"
    """A turbulent wind."""

    direction: float = Field(default=90.0, ge=-360.0, le=360.0)
    """Where it blows to, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    strength: float = Field(default=0.3, ge=0.0, le=1.0)
    """Posture index of the grass in its mean."""

    intensity: float = Field(default=0.35, ge=0.0, le=1.0)
    """Standard deviation of it along its direction, and across, of its mean; 0 is steady."""

    scale: float = Field(default=12.0, ge=2.0, le=1000.0)
    """How large its eddies are: the integral length scale along its direction [m]."""

    speed: float = Field(default=4.0, ge=0.0, le=40.0)
    """How fast it carries them along [m/s]."""

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return 1 everywhere: it has no edge."""
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return its messages at ground positions (n, 2): the mean with its eddies, shape (n, 2)."""
        values = self.twin_values(time=time, seed=seed)
        ahead_x, ahead_z, across, along, *_ = (np.float32(number) for number in values.numbers)
        x, z = place[:, 0], place[:, 1]
        faster, aside = self._eddies(np.stack([across * x - along * z, along * x + across * z], axis=1), values)
        faster += np.float32(1.0)
        x, z = ahead_x * faster - ahead_z * aside, ahead_z * faster + ahead_x * aside
        length = np.maximum(np.sqrt(x * x + z * z), np.float32(1.0))
        return np.stack([x / length, z / length], axis=1)

    @staticmethod
    def _eddies(at: Floats, values: TwinValues) -> tuple[Floats, Floats]:
        """Return how much faster the wind is than its mean, and how much goes aside, of the mean, shape (n,) each."""
        shift, share = values.numbers[4:8], [np.float32(number) for number in values.numbers[8:]]
        large = smooth_noise(values.sheets[0], at, shift=(shift[0], shift[1]))
        small = smooth_noise(values.sheets[1], np.float32(FINER) * at, shift=(shift[2], shift[3]))
        faster, aside = (
            share[0] * large[:, part]
            + share[1] * large[:, part + 2]
            + share[2] * small[:, part]
            + share[3] * small[:, part + 2]
            for part in (0, 1)
        )
        return faster, aside

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return the mean, how the tables lie, how far they are carried, and how much is felt of each half of both."""
        heading, lie = radians(self.direction), radians(self.direction) + ASLANT
        step = self.scale * WIDE / PERIOD
        mean = self.strength * sin(heading), -self.strength * cos(heading)
        phases, (more, aside) = _wander(self.speed * time / self.scale, seed)
        ahead, aside = self.speed * time / step + PERIOD / WIDE * more, PERIOD / WIDE * aside
        column, row = -cos(ASLANT) * ahead - sin(ASLANT) * aside, sin(ASLANT) * ahead - cos(ASLANT) * aside
        shift = [finer * part % PERIOD for finer in (1.0, FINER) for part in (column, row)]
        share = [self.intensity * part for phase in phases for part in (cos(phase), sin(phase))]
        return TwinValues((*mean, sin(lie) / step, cos(lie) / step, *shift, *share), eddy_tables(seed))


def _wander(gone: float, seed: int) -> tuple[list[float], list[float]]:
    """Return the phases of large and small eddies [rad], and how much farther and aside they are carried.

    The wind has gone `gone` length scales, and so are the distances.
    """
    way = np.mod(np.outer(gone / LIVES, [cos(ASLANT), sin(ASLANT)]), PERIOD).astype(np.float32)
    (large, _, more, aside), (_, small, _, _) = smooth_noise(noise_table(seed, 2), way).tolist()
    return [TURNS * large, TURNS * small], [SWAY * more, SWAY * aside]
