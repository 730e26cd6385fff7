"""The sky: its colours on a small map, what it sends down, and the colour of the haze before what is far away."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from math import cos, pi, radians, sin

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.light import Light
from .air import FORWARD, HEIGHTS, from_all_sides, seen_in_rows
from .clouds import Clouds, clouds_of, in_shade
from .color import luminance, shown_as, srgb
from .sun import sun_at

COLUMNS, ROWS = 33, 32
"""Size of the map of the sky: from the sun's azimuth to the opposite one, and from the horizon to the zenith."""

SUN = 5.0
"""Irradiance of the sun before the air, where a white leaf that sends on all of it is as bright as 5 / pi."""

BRIGHTER = 2.0
"""How much brighter the sky is shown than it is beside the sun, as photographs are exposed that show both."""

PALER = 0.45
"""How much paler the sky's light is taken than it is, as eyes do and films that are balanced for shade."""

LEAST = 1e-6
"""What counts as nothing: of radiance, and of the largest where ways to scatter are one, as under a sun overhead."""

VEIL = 0.35
"""How much of the clouds' light the air between them has overhead, of what they hide."""

MEETS = 0.05
"""Sine of the elevation up to which the sky passes into the haze of the horizon."""

AROUND_PIECES, MAP_PIECES = 10, 22
"""Pieces of the work on what comes from all sides, and on the map."""

PIECES = AROUND_PIECES + MAP_PIECES
"""Pieces of the work on a sky."""

PEAK = (1.0 + FORWARD**2) / (2.0 * FORWARD)
"""By how much light that haze scatters goes forwards: as (PEAK - s)^-1.5, by the cosine s of the angle to the sun."""

GLSL = {"PEAK": PEAK}

NIGHT = np.array([0.0030, 0.0052, 0.0120])
"""Radiance of the sky at night, by stars and by a moon that is not seen."""

_HEIGHT = (np.arange(ROWS) / (ROWS - 1.0)) ** 2
_AZIMUTH = np.linspace(0.0, pi, COLUMNS)
_LOW = np.clip(1.0 - _HEIGHT / MEETS, 0.0, 1.0)[:, None, None]


def _weight() -> Doubles:
    """Return how much of the hemisphere's light comes from where on the map, shape (ROWS, COLUMNS, 1)."""
    across = np.ones(COLUMNS)
    across[[0, -1]] = 0.5
    weight = np.gradient(_HEIGHT**2)[:, None] * across
    return np.asarray((weight / weight.sum())[:, :, None])


_WEIGHT = _weight()


@dataclass(frozen=True, slots=True, eq=False)
class Sky:
    """The colours of a sky, linear radiance."""

    map: Doubles
    """By elevation, in even steps of its sine's square root, and by azimuth from the sun, in even steps from 0 to pi,
    shape (ROWS, COLUMNS, 3)."""

    horizon: Doubles
    """Colour of the horizon by the cosine s of the angle to the sun: what `scattered` gives is times these, (4, 3)."""

    down: Doubles
    """What it sends to level ground, as the radiance of an even sky that sends as much, shape (3,)."""

    clouds: Doubles
    """Of a cloud's underside in full shade, shape (3,)."""


def sky_of(light: Light, clear: Doubles, sun: Doubles, /) -> Sky:
    """Return the sky of a scene's light under clear air of `clear_air`, or one between the colours that it gives.

    `sun` is the radiance of a white leaf in full sun, by which its clouds are lit.
    """
    map_, clouds = _given(clear * (SUN * BRIGHTER * min(light.strength, 1.0)) + NIGHT, light), clouds_of(light.clouds)
    high, clear = radians(sun_at(light)[1]), _sent_down(map_)
    shaded = in_shade(sun, sin(high), clear)
    grey = sun * clouds.sunlit + shaded * clouds.shaded
    map_ = _clouded(map_, grey, clouds)
    ways = scattered(np.cos(_AZIMUTH) * cos(high))
    horizon = _horizon(map_[0], ways)
    map_ = map_ * (1.0 - _LOW) + ways @ horizon * _LOW
    return Sky(map_, horizon, clear * (1.0 - clouds.hides) + grey, shaded)


def scattered(cosine: Doubles, /) -> Doubles:
    """Return how much light goes each way that air scatters it, by the cosine of the angle to the sun (n,): (n, 4).

    Evenly and by the square of the cosine, as molecules do and what is scattered again; and forwards, as haze does.
    """
    return np.stack([np.ones_like(cosine), cosine, cosine * cosine, (PEAK - cosine) ** -1.5], axis=1)


def _horizon(colors: Doubles, ways: Doubles, /) -> Doubles:
    """Return how much of each of the ways (n, 4) makes up colours (n, 3) best, by what each is off: (4, 3).

    What is dark beside the sun counts as much as what is bright there: else it would come out as a colour of its own.
    """
    off = 1.0 / np.maximum(colors, LEAST)
    fits = [np.linalg.lstsq(ways * off[:, [k]], colors[:, k] * off[:, k], rcond=LEAST)[0] for k in range(3)]
    return np.stack(fits, axis=1)


@lru_cache(maxsize=16)
def clear_air(elevation: float, turbidity: float, /) -> Doubles:
    """Return the radiance of clear air by elevation and azimuth from the sun, as `Sky.map`, for sunlight of 1.

    `elevation` is the sun's [degrees]; nobody may write to it.
    """
    for done in clear_air_in_pieces(elevation, turbidity):
        if done is not None:
            return done
    raise AssertionError("a sky has a last piece")


def clear_air_in_pieces(elevation: float, turbidity: float, /) -> Iterator[Doubles | None]:
    """Yield once for each of `PIECES` pieces of work of about the same length; the last is what `clear_air` returns."""
    up = radians(elevation)
    sun, around, rows = np.array([0.0, sin(up), -cos(up)]), [], []
    for some in np.array_split(HEIGHTS, AROUND_PIECES):
        around.append(from_all_sides(sun, turbidity, heights=some))
        yield None
    table = np.concatenate(around)
    for height in np.array_split(_HEIGHT, MAP_PIECES):
        apart = height[:, None] * sin(up) + np.sqrt(1.0 - height**2)[:, None] * (np.cos(_AZIMUTH) * cos(up))
        rows.append(seen_in_rows(height, apart, sin(up), turbidity, around=table))
        yield np.concatenate(rows) if len(rows) == MAP_PIECES else None


def _given(clear: Doubles, light: Light, /) -> Doubles:
    """Return the sky between the colours that a scene gives for zenith and horizon; without them it is clear air's."""
    if light.zenith is None and light.horizon is None:
        return clear
    zenith = clear[-1].mean(axis=0) if light.zenith is None else shown_as(srgb(light.zenith))
    horizon = clear[0].mean(axis=0) if light.horizon is None else shown_as(srgb(light.horizon))
    low = ((1.0 - _HEIGHT) ** 4)[:, None]
    return np.broadcast_to((zenith * (1.0 - low) + horizon * low)[:, None], clear.shape)


def _clouded(sky: Doubles, grey: Doubles, clouds: Clouds, /) -> Doubles:
    """Return what is seen between clouds: the lower, the more is it the clouds themselves, far off in the haze."""
    if clouds.hides == 0.0:
        return sky
    part = clouds.hides * (VEIL + (1.0 - VEIL) * np.maximum((1.0 - _HEIGHT) ** 4, clouds.hides**4))[:, None, None]
    return np.asarray(sky * (1.0 - part) + grey / clouds.hides * part)


def _sent_down(sky: Doubles, /) -> Doubles:
    """Return the mean over the hemisphere, weighted by the sine of the elevation, and paler: the ground is level."""
    sent = (sky * _WEIGHT).sum(axis=(0, 1))
    return np.asarray(sent + PALER * (luminance(sent) - sent))
