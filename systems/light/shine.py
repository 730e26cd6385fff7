"""What every program knows of the light that shines."""

from collections.abc import Sequence
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.grass import GrassKind
from ...engine.declared.light import Light
from .clouds import clouds_of
from .daylight import Daylight
from .materials import apart, grain, pigment
from .sun import sun_at


def shine(record: NDArray[np.void], declared: Light, light: Daylight, kinds: Sequence[GrassKind], /) -> None:
    """Write the light that is `declared`, and what it does to the kinds of grass."""
    row = record[0]
    row["sun"], row["sunlight"], row["skylight"] = light.direction, light.sun, light.down
    row["cloud_edge"], row["haze_density"] = clouds_of(declared.clouds).edge, 1.0 / declared.haze
    row["exposure"], row["lamplight"], row["cloudlight"] = light.exposure, light.lamplight, light.clouds
    row["zenith"] = light.sky.map[-1].mean(axis=0)
    row["horizon"][:, :3] = light.sky.horizon
    row["toward_sun"] = toward_sun(declared)
    row["soil"] = pigment(declared.ground)
    for index, kind in enumerate(kinds):
        row["kinds"]["grain_c"][index], row["kinds"]["grain_s"][index] = grain(kind, light)
        row["kinds"]["apart"][index] = apart(kind, light)


def toward_sun(light: Light, /) -> tuple[float, float]:
    """Return the direction over the ground that the sun stands in (x, z)."""
    azimuth = radians(sun_at(light)[0])
    return sin(azimuth), -cos(azimuth)
