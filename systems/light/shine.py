"""What every program knows of the light that shines."""

from collections.abc import Sequence
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.grass import GrassKind
from ...engine.declared.light import Light
from .daylight import Daylight
from .materials import apart, grain, pigment
from .sun import sun_at


def shine(record: NDArray[np.void], declared: Light, light: Daylight, kinds: Sequence[GrassKind], /) -> None:
    """Write the light that is `declared`, and what it does to the kinds of grass."""
    row = record[0]
    row["sun"][:3] = light.direction
    row["sunlight"] = (*light.sun, declared.clouds)
    row["skylight"] = (*light.down, 1.0 / declared.haze)
    row["zenith"][:3] = light.sky.map[-1].mean(axis=0)
    row["horizon"][:, :3] = light.sky.horizon
    row["drift"][2:] = toward_sun(declared)
    row["soil"][:3] = pigment(declared.ground)
    for index, kind in enumerate(kinds):
        row["grain_c"][index, :3], row["grain_s"][index, :3] = grain(kind, light)
        row["grain_c"][index, 3] = apart(kind, light)


def toward_sun(light: Light, /) -> tuple[float, float]:
    """Return the direction over the ground that the sun stands in (x, z)."""
    azimuth = radians(sun_at(light)[0])
    return sin(azimuth), -cos(azimuth)
