"""Turbulence: eddies of all sizes about a mean wind, as real wind has them (paper, section 3.3)."""

from collections.abc import Mapping, Sequence
from math import cos, pi, radians, sin
from typing import ClassVar, Literal, cast

import numpy as np
from pydantic import Field

from ...components.arrays import Floats
from ...components.wind import Grass, TwinValues
from ...engine.noise import ASLANT, PERIOD, smooth_noise, wander
from .eddies import FINE, FINER, WIDE, eddy_tables
from .mean import MeanWind

Record = dict[str, Sequence[float]]

CLOSER = FINER * FINE / PERIOD
"""Density of the points in the table of small eddies relative to the table of large ones."""

LIFE, SOONER = 64.0, 8.0
"""Way of the wind while large eddies change into others [length scales]; ratio of their life to that of small ones."""

TURNS = 2.0 * pi
"""Largest phase that mixes the two halves of a table, as eddies change [rad]."""

SWAY = 1.5
"""Distance that eddies wander from the path of the mean wind, ahead and aside [length scales]."""


class Turbulence(MeanWind):
    """A wind over the whole prairie that is as turbulent as real wind, with von Karman's spectrum of eddies."""

    twin: ClassVar[str | None] = "turbulence.glsl"
    color: ClassVar[tuple[float, float, float] | None] = (0.62, 0.70, 1.00)

    kind: Literal["turbulence"] = "turbulence"
    """A turbulent wind."""

    intensity: float = Field(default=0.35, ge=0.0, le=1.0)
    """Standard deviation along its direction, and across, as a part of its mean; 0 is steady."""

    swing: float = Field(default=0.03, ge=0.0, le=0.5)
    """Largest posture index of a blade's own small oscillations; more of them stand out of the spectrum at 1 Hz."""

    scale: float = Field(default=12.0, ge=2.0, le=1000.0)
    """Size of its eddies: the integral length scale along its direction [m]."""

    def rates(self) -> tuple[float, ...]:
        """Return the velocity of its eddies along x and z, and their speed [length scales/s]."""
        x, z = self.velocity
        return x / self.scale, z / self.scale, self.speed / self.scale

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return its messages at ground positions (n, 2): the mean plus its eddies, shape (n, 2)."""
        values = self.twin_values(time=time, seed=seed)
        record = {name: np.asarray(each, np.float32) for name, each in cast(Record, values.numbers).items()}
        (ahead_x, ahead_z), (across, along) = record["mean"], record["lie"]
        x, z = place[:, 0], place[:, 1]
        grid = np.stack([across * x - along * z, along * x + across * z], axis=1)
        ahead, aside = self._eddies(grid, record, values.sheets)
        ahead += np.float32(1.0)
        x, z = ahead_x * ahead - ahead_z * aside, ahead_z * ahead + ahead_x * aside
        length = np.maximum(np.sqrt(x * x + z * z), np.float32(1.0))
        return np.stack([x / length, z / length], axis=1)

    @staticmethod
    def _eddies(grid: Floats, record: Mapping[str, Floats], tables: Sequence[Floats]) -> tuple[Floats, Floats]:
        """Return the fluctuations along the mean wind and to its right, relative to the mean, shape (n,) each.

        `grid` (n, 2) has the places in the table of large eddies [samples].
        """
        shift, share = record["shift"], record["share"]
        large = smooth_noise(tables[0], grid, shift=(shift[0], shift[1]))
        small = smooth_noise(tables[1], np.float32(CLOSER) * grid, shift=(shift[2], shift[3]))
        ahead, aside = (
            share[0] * large[:, part]
            + share[1] * large[:, part + 2]
            + share[2] * small[:, part]
            + share[3] * small[:, part + 2]
            for part in (0, 1)
        )
        return ahead, aside

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return the mean message, the tables' rotation and scale, their shifts, and the weights of their halves."""
        heading, step = radians(self.direction), self.scale * WIDE / PERIOD
        first = radians(self.first.direction)  # a wind that a game turns leaves its tables as they lie
        gone_x, gone_z, gone = self.phases(time=time)
        x, z = sin(first), -cos(first)
        ahead, aside = ASLANT
        large, _, more, across = wander(seed, 2, gone / LIFE)
        _, small, _, _ = wander(seed, 2, gone * SOONER / LIFE)
        way = (x * gone_x + z * gone_z + SWAY * more) * PERIOD / WIDE
        off = (x * gone_z - z * gone_x + SWAY * across) * PERIOD / WIDE
        carried = -ahead * way - aside * off, aside * way - ahead * off
        shift = [closer * part % side for closer, side in ((1.0, PERIOD), (CLOSER, FINE)) for part in carried]
        lie = (ahead * x - aside * z) / step, (-ahead * z - aside * x) / step
        share = [self.intensity * part for phase in (TURNS * large, TURNS * small) for part in (cos(phase), sin(phase))]
        x, z = sin(heading), -cos(heading)
        mean = self.strength * x, self.strength * z
        return TwinValues({"mean": mean, "lie": lie, "shift": shift, "share": share}, eddy_tables(seed))
