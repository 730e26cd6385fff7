"""The sky: a small map of its radiance, its irradiance on the ground, and the colour of haze at the horizon."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, radians, sin

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.light import Light
from .air import FORWARD, HEIGHTS, multiple_scattering, sky_radiance
from .clouds import FADE, Clouds, clouds_of, from_below, in_shade, sent_down
from .color import luminance, shown_as, srgb
from .sun import sun_at, transmitted_from_zenith

COLUMNS, ROWS = 33, 32
"""Size of the sky map: columns from the sun's azimuth to the opposite one, rows from the horizon to the zenith."""

SUN = 5.0
"""Solar irradiance above the atmosphere: a white diffuse leaf has the radiance 5 / pi."""

SKY_BRIGHTENED = 2.0
"""Factor by which the sky is brightened relative to the sun, as in photographs exposed for both."""

DESATURATION = 0.45
"""Fraction by which the sky's irradiance is desaturated, as eyes and film balanced for shade do."""

FIT_LEAST = 1e-6
"""Smallest radiance, and smallest relative singular value, in the horizon's fit: under a high sun, terms are
collinear."""

VEIL = 0.35
"""Part of the clouds' light that veils the gaps between them at the zenith, relative to the part of sky they hide."""

BLEND_SINE = 0.05
"""Sine of elevation up to which the sky blends into the horizon's haze."""

MULTIPLE_PIECES, MAP_PIECES = 10, 22
"""Number of work pieces for multiple scattering, and for the sky map."""

PIECES = MULTIPLE_PIECES + MAP_PIECES
"""Number of work pieces for a whole sky."""

PEAK = (1.0 + FORWARD**2) / (2.0 * FORWARD)
"""Constant of the haze's forward scattering, (PEAK - s)^-1.5, where s is the cosine of the angle to the sun."""

GLSL = {"PEAK": PEAK}

NIGHT = np.array([0.0030, 0.0052, 0.0120])
"""Mean radiance of the night sky: faint stars, and a moon that is not drawn. Bright stars are drawn one by one."""

NIGHT_FALLS = 6.0, 12.0
"""Depressions of the sun between which the night sky becomes darker overhead than at the horizon [degrees]: the ends of
civil and nautical twilight."""

_SINE = (np.arange(ROWS) / (ROWS - 1.0)) ** 2
_AZIMUTH = np.linspace(0.0, pi, COLUMNS)
_LOW = np.clip(1.0 - _SINE / BLEND_SINE, 0.0, 1.0)[:, None, None]


def _sky_weights() -> Doubles:
    """Return the weight of each texel of the sky map in the irradiance on level ground, shape (ROWS, COLUMNS, 1)."""
    across = np.ones(COLUMNS)
    across[[0, -1]] = 0.5
    weight = np.gradient(_SINE**2)[:, None] * across
    return np.asarray((weight / weight.sum())[:, :, None])


_WEIGHTS = _sky_weights()


@dataclass(frozen=True, slots=True, eq=False)
class Sky:
    """A sky in linear radiance."""

    map: Doubles
    """Radiance by elevation, in even steps of the square root of its sine, and by azimuth from the sun, in even steps
    from 0 to pi, shape (ROWS, COLUMNS, 3)."""

    horizon: Doubles
    """Coefficients of the horizon's radiance, `scattered(s) @ horizon`, by the cosine s of the angle to the sun, shape
    (4, 3)."""

    down: Doubles
    """Radiance of a uniform sky with the same irradiance on level ground, shape (3,)."""

    clouds: Doubles
    """Radiance of a thin cloud in full shade, shape (3,)."""

    ground: Doubles
    """Mean radiance of the ground, which lights clouds from below, shape (3,)."""


def sky_of(light: Light, clear: Doubles, sun: Doubles, /) -> Sky:
    """Return the sky of a scene's light: the radiance `clear` of `clear_air`, or the scene's own colours, with clouds.

    `sun` is the radiance of a white leaf in full sun; it lights the clouds.
    """
    map_ = _with_own_colours(clear * (SUN * SKY_BRIGHTENED * min(light.strength, 1.0)) + _night(light), light)
    clouds = clouds_of(light.clouds)
    up, clear_down = radians(sun_at(light)[1]), _irradiance(map_)  # clouds are white: they take on the sky's own colour
    shaded = in_shade(sun, sin(up), clear_down, clouds)
    grey, gaps = sent_down(sun, sin(up), shaded, clouds), 1.0 - clouds.hidden
    ground = from_below(sun, sin(up), clear_down * gaps + grey, clouds)
    grey = grey + ground * (clouds.hidden - clouds.scattered)
    map_ = _clouded(map_, grey, clouds)
    basis = scattered(np.cos(_AZIMUTH) * cos(up))
    horizon = _horizon(map_[0], basis)
    map_ = map_ * (1.0 - _LOW) + basis @ horizon * _LOW
    return Sky(map_, horizon, _desaturated(clear_down) * gaps + grey, shaded, ground)


def _night(light: Light, /) -> Doubles:
    """Return the radiance of the night sky, laid out as `Sky.map`; by day it is the same everywhere.

    The lower, the thicker is the layer that glows, and the air before it (Garstang, Night-Sky Brightness at
    Observatories and Sites, 1989). Its irradiance is that of `NIGHT` all over the sky.
    """
    part = np.interp(-sun_at(light)[1], NIGHT_FALLS, (0.0, 1.0))
    thicker = 1.0 / np.sqrt(1.0 - 0.96 * (1.0 - _SINE**2))[:, None, None]
    glow = (0.4 + 0.6 * thicker) * transmitted_from_zenith(light.turbidity) ** (thicker - 1.0)
    glow = np.broadcast_to(glow, (ROWS, COLUMNS, 3))
    return np.asarray(NIGHT * (1.0 + part * (glow / (glow * _WEIGHTS).sum(axis=(0, 1)) - 1.0)))


def scattered(cosine: Doubles, /) -> Doubles:
    """Return the basis functions of scattering by the cosine of the angle to the sun (n,), shape (n, 4).

    1, s and s^2 stand for molecules and multiple scattering, the fourth for the haze's forward scattering.
    """
    return np.stack([np.ones_like(cosine), cosine, cosine * cosine, (PEAK - cosine) ** -1.5], axis=1)


def _horizon(colors: Doubles, basis: Doubles, /) -> Doubles:
    """Return the least-squares coefficients (4, 3) of basis functions (n, 4) for colours (n, 3), by relative error.

    With absolute errors, the bright part around the sun would tint the dark part.
    """
    relative = 1.0 / np.maximum(colors, FIT_LEAST)
    fits = [
        np.linalg.lstsq(basis * relative[:, [k]], colors[:, k] * relative[:, k], rcond=FIT_LEAST)[0] for k in range(3)
    ]
    return np.stack(fits, axis=1)


@lru_cache(maxsize=16)
def clear_air(elevation: float, turbidity: float, /) -> Doubles:
    """Return the radiance of a clear sky for a solar irradiance of 1, laid out as `Sky.map`.

    `elevation` is the sun's [degrees]. The array is cached: do not write to it.
    """
    *_, last = clear_air_in_pieces(elevation, turbidity)
    assert last is not None
    return last


def clear_air_in_pieces(elevation: float, turbidity: float, /) -> Iterator[Doubles | None]:
    """Compute `clear_air` in `PIECES` pieces of about equal cost; yield None after each, after the last the result."""
    up = radians(elevation)
    sun, multiple, rows = np.array([0.0, sin(up), -cos(up)]), [], []
    for heights in np.array_split(HEIGHTS, MULTIPLE_PIECES):
        multiple.append(multiple_scattering(sun, turbidity, heights=heights))
        yield None
    table = np.concatenate(multiple)
    for sines in np.array_split(_SINE, MAP_PIECES):
        apart = sines[:, None] * sin(up) + np.sqrt(1.0 - sines**2)[:, None] * (np.cos(_AZIMUTH) * cos(up))
        rows.append(sky_radiance(sines, apart, sin(up), turbidity, multiple=table))
        yield np.concatenate(rows) if len(rows) == MAP_PIECES else None


def _with_own_colours(clear: Doubles, light: Light, /) -> Doubles:
    """Return the sky map with the scene's colours for zenith and horizon, where it gives any; otherwise `clear`."""
    if light.zenith is None and light.horizon is None:
        return clear
    zenith = clear[-1].mean(axis=0) if light.zenith is None else shown_as(srgb(light.zenith))
    horizon = clear[0].mean(axis=0) if light.horizon is None else shown_as(srgb(light.horizon))
    low = ((1.0 - _SINE) ** 4)[:, None]
    return np.broadcast_to((zenith * (1.0 - low) + horizon * low)[:, None], clear.shape)


def _clouded(sky: Doubles, grey: Doubles, clouds: Clouds, /) -> Doubles:
    """Return the sky map veiled by clouds of mean radiance `grey`: the lower, the more clouds stand in the haze.

    Where they fade into it, an overcast's map stands for the clouds themselves; above, it is what gaps show.
    """
    if clouds.hidden == 0.0:
        return sky
    faded = clouds.hidden**4 * np.clip(2.0 - _SINE / FADE[1], 0.0, 1.0)
    part = clouds.hidden * (VEIL + (1.0 - VEIL) * np.maximum((1.0 - _SINE) ** 4, faded))[:, None, None]
    return np.asarray(sky * (1.0 - part) + grey / clouds.hidden * part)


def _irradiance(sky: Doubles, /) -> Doubles:
    """Return a sky map's mean weighted by the sine of elevation, as for level ground, shape (3,)."""
    return np.asarray((sky * _WEIGHTS).sum(axis=(0, 1)))


def _desaturated(sent: Doubles, /) -> Doubles:
    """Return a clear sky's irradiance on grass (3,), desaturated as far as `DESATURATION` says."""
    return np.asarray(sent + DESATURATION * (luminance(sent) - sent))
