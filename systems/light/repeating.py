"""What repeats over the terrain: a thin layer of clouds that drifts with the wind, and what lies on the ground."""

from collections.abc import Sequence
from functools import lru_cache
from math import cos, radians, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.wind import WindPrimitive
from ...engine.gl.mipmaps import mipmapped_image
from ..grow.raster import rasterise
from ..wind.mean import MeanWind

SIDE = 512
"""Texels along a side."""

STRAWS = 2600
"""How many straws lie on a square of ground, 1.8 m wide."""

LITTER_ONE = 64
"""The texel of ground that is as bright as the mean."""


_REMEMBERED = 4
"""Seeds whose maps are remembered, less than a megabyte each: a scene read again has the seed that it had."""

CLOUDS_SIDE = 900.0
"""Side of the square that repeats [m], as `lib/light.glsl` has it."""

FASTER = 1.5
"""How much faster clouds go than the waves of the breeze."""


def drifted(winds: Sequence[WindPrimitive], time: float, /) -> tuple[float, float]:
    """Return how far clouds have drifted with the first breeze at a time [s], along x and z, in sides from 0 to 1."""
    for breeze in (wind for wind in winds if isinstance(wind, MeanWind)):
        heading, way = radians(breeze.direction), FASTER * breeze.speed * time / CLOUDS_SIDE
        return sin(heading) * way % 1.0, -cos(heading) * way % 1.0
    return 0.0, 0.0


def cloud_map(*, seed: int) -> NDArray[np.uint8]:
    """Return how dense clouds are over a square that repeats, shape (SIDE, SIDE): even from none to all, by rank.

    So of a map with values of [0, 1] just the part is above 1 - c that a scene wants to be in cloud.
    """
    random = np.random.default_rng([seed, 0x636C6F75])
    wave = np.fft.fftfreq(SIDE, 1.0 / SIDE)
    size = np.hypot(wave[:, None], wave[None])
    amplitude = np.where(size > 0.0, np.maximum(size, 2.5) ** -1.9, 0.0) * np.exp(-((size / 70.0) ** 2))
    spectrum = amplitude * np.exp(2j * np.pi * random.random((SIDE, SIDE)))
    field = np.fft.ifft2(spectrum).real
    rank = np.empty(field.size)
    rank[np.argsort(field, axis=None, kind="stable")] = np.arange(field.size) / field.size
    return np.asarray(np.floor(rank * 256.0), np.uint8).reshape(SIDE, SIDE)


def litter_map(*, seed: int) -> NDArray[np.uint8]:
    """Return what lies on the ground over a square that repeats: straws across one another, shape (SIDE, SIDE).

    A texel is the radiance there, of the mean, in units of 1 / `LITTER_ONE`.
    """
    random = np.random.default_rng([seed, 0x6C697474])
    middle, turn = random.random((STRAWS, 2)) * SIDE, random.uniform(0.0, 2.0 * np.pi, STRAWS)
    along = np.stack([np.cos(turn), np.sin(turn)], axis=1) * random.uniform(10.0, 38.0, (STRAWS, 1))
    aside = np.stack([-np.sin(turn), np.cos(turn)], axis=1) * random.uniform(0.9, 2.2, (STRAWS, 1))
    bright = random.uniform(0.35, 1.0, STRAWS) ** 2
    ends = [middle - along - aside, middle - along + aside, middle + along - aside, middle + along + aside]
    corners = np.stack([ends[number] for number in (0, 1, 2, 1, 3, 2)], axis=1).reshape(-1, 3, 2)
    front = np.repeat(random.random(STRAWS), 2)[:, None].repeat(3, axis=1)
    seen = rasterise(corners, front, shape=(SIDE, SIDE), wrap=True)
    lit = np.full(SIDE * SIDE, 0.12)
    lit[seen.sample] = (bright * (0.35 + 0.65 * random.random(STRAWS)))[seen.triangle // 2]
    return np.asarray(np.clip(np.rint(lit / lit.mean() * LITTER_ONE), 0, 255), np.uint8).reshape(SIDE, SIDE)


def repeating_texture(ctx: moderngl.Context, *, seed: int) -> moderngl.Texture:
    """Return `repeating_levels` as a texture that repeats."""
    return mipmapped_image(ctx, repeating_levels(seed=seed))


@lru_cache(maxsize=_REMEMBERED)
def repeating_levels(*, seed: int) -> tuple[NDArray[np.uint8], ...]:
    """Return `cloud_map` and `litter_map` as two channels, shapes (SIDE, SIDE, 2) and its halves down to one texel.

    The coarser are means of the finest: drivers that round up at each level would make ground brighter far off.
    """
    texels = np.stack([cloud_map(seed=seed), litter_map(seed=seed)], axis=-1)
    made, mean = [texels], texels.astype(np.float64)
    while len(mean) > 1:
        mean = 0.25 * (mean[::2, ::2] + mean[1::2, ::2] + mean[::2, 1::2] + mean[1::2, 1::2])
        made.append(np.rint(mean).astype(np.uint8))
    return tuple(made)
