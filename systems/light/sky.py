"""The sky: its colours on a small map, what it sends down, and the colour of the haze before what is far away."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.light import Light
from .air import from_all_sides, seen
from .color import luminance, shown_as, srgb
from .sun import sun_at

Doubles = NDArray[np.float64]

COLUMNS, ROWS = 33, 32
"""Size of the map of the sky: from the sun's azimuth to the opposite one, and from the horizon to the zenith."""

SUN = 5.0
"""Irradiance of the sun before the air, where a white leaf that sends on all of it is as bright as 5 / pi."""

BRIGHTER = 2.0
"""How much brighter the sky is shown than it is beside the sun, as photographs are exposed that show both."""

MEETS = 0.05
"""Sine of the elevation up to which the sky passes into the haze of the horizon."""

NIGHT = np.array([0.0030, 0.0052, 0.0120])
"""Radiance of the sky at night, by stars and by a moon that is not seen."""


@dataclass(frozen=True, slots=True, eq=False)
class Sky:
    """The colours of a sky, linear radiance."""

    map: Doubles
    """By elevation, in even steps of its sine's square root, and by azimuth from the sun, in even steps from 0 to pi,
    shape (ROWS, COLUMNS, 3)."""

    horizon: Doubles
    """Colour of the horizon by the cosine c of the azimuth from the sun: coefficients of 1, c and c^2, shape (3, 3)."""

    down: Doubles
    """What it sends to level ground, as the radiance of an even sky that sends as much, shape (3,)."""


def sky_of(light: Light, /) -> Sky:
    """Return the sky of a scene's light: that of clear air, or one between the colours that the scene gives."""
    height = (np.arange(ROWS) / (ROWS - 1.0)) ** 2
    azimuth = np.linspace(0.0, pi, COLUMNS)
    map_ = _clouded(_given(clear_sky(light, height, azimuth), light, height), light.clouds)
    c = np.cos(azimuth)
    powers = np.stack([np.ones_like(c), c, c * c], axis=1)
    horizon = np.linalg.lstsq(powers, map_[0], rcond=None)[0]
    low = np.clip(1.0 - height / MEETS, 0.0, 1.0)[:, None, None]
    return Sky(map_ * (1.0 - low) + np.maximum(powers @ horizon, 0.0) * low, horizon, _sent_down(map_, height))


def clear_sky(light: Light, height: Doubles, azimuth: Doubles, /) -> Doubles:
    """Return the radiance of clear air by sine of elevation (r,) and azimuth from the sun (c,), shape (r, c, 3)."""
    up = radians(sun_at(light)[1])
    sun = np.array([0.0, sin(up), -cos(up)])
    level = np.sqrt(1.0 - height**2)[:, None]
    direction = np.stack(
        [level * np.sin(azimuth), height[:, None] + 0.0 * azimuth, -level * np.cos(azimuth)], axis=-1
    ).reshape(-1, 3)
    once = seen(direction, sun, light.turbidity, around=from_all_sides(sun, light.turbidity))
    return np.asarray(once.reshape(len(height), len(azimuth), 3) * (SUN * BRIGHTER * min(light.strength, 1.0)) + NIGHT)


def _given(clear: Doubles, light: Light, height: Doubles, /) -> Doubles:
    """Return the sky between the colours that a scene gives for zenith and horizon; without them it is clear air's."""
    if light.zenith is None and light.horizon is None:
        return clear
    zenith = clear[-1].mean(axis=0) if light.zenith is None else shown_as(srgb(light.zenith))
    horizon = clear[0].mean(axis=0) if light.horizon is None else shown_as(srgb(light.horizon))
    low = ((1.0 - height) ** 4)[:, None]
    return np.broadcast_to((zenith * (1.0 - low) + horizon * low)[:, None], clear.shape)


def _clouded(sky: Doubles, clouds: float, /) -> Doubles:
    """Return the mean of a sky and its clouds, which are grey and brighter than the sky in the mean."""
    part = 0.35 * clouds
    return np.asarray(sky * (1.0 - part) + 1.3 * luminance(sky).mean() * part)


def _sent_down(sky: Doubles, height: Doubles, /) -> Doubles:
    """Return the mean over the hemisphere, weighted by the sine of the elevation: the ground is level."""
    across = np.ones(sky.shape[1])
    across[[0, -1]] = 0.5
    weight = np.gradient(height**2)[:, None] * across
    return np.asarray((sky * (weight / weight.sum())[:, :, None]).sum(axis=(0, 1)))
