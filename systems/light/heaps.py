"""The cloud map as the sky's shaders read it: density, and its slopes along x and z."""

from functools import lru_cache

import moderngl
import numpy as np
from numpy.typing import NDArray

from .repeating import CACHED_SEEDS, SIDE, repeating_levels

STEEPEST = 24.0
"""Largest slope that a texel can hold, along an axis [1 / side]."""

SLOPE_CUT = 40.0
"""Cut-off wave number of the slopes [1 / side]: it removes the steps of the map's 256 values."""

GLSL = {"HEAPS_STEEPEST": STEEPEST}


@lru_cache(maxsize=CACHED_SEEDS)
def heap_texels(*, seed: int) -> NDArray[np.uint8]:
    """Return the density of a scene's cloud map and its slopes along x and z as three channels, (SIDE, SIDE, 3)."""
    density = repeating_levels(seed=seed)[0][..., 0] / 255.0
    wave = np.fft.fftfreq(SIDE, 1.0 / SIDE)
    spectrum = np.fft.fft2(density) * np.exp(-((np.hypot(wave[:, None], wave) / SLOPE_CUT) ** 2)) * 2j * np.pi
    slopes = (np.fft.ifft2(spectrum * along).real for along in (wave[None], wave[:, None]))
    texels = np.stack([density, *(0.5 + 0.5 * np.clip(each / STEEPEST, -1.0, 1.0) for each in slopes)], axis=-1)
    return np.rint(255.0 * texels).astype(np.uint8)


def heaps_texture(ctx: moderngl.Context, *, seed: int) -> moderngl.Texture:
    """Return `heap_texels` as a repeating texture."""
    texture = ctx.texture((SIDE, SIDE), 3, heap_texels(seed=seed), alignment=1)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
