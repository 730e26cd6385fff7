"""The cloud map as the sky's shaders read it: broad density, its slopes along x and z, and fine density."""

from functools import lru_cache

import moderngl
import numpy as np
from numpy.typing import NDArray

from .repeating import CACHED_SEEDS, SIDE, repeating_levels

STEEPEST = 24.0
"""Largest slope that a texel can hold, along an axis [1 / side]."""

FINE_FROM = 16.0
"""Wave number from which density is fine [1 / side]: twice that of the broadest heaps. It fades with height, as small
heaps are low: it frays bases and makes scraps of cloud, but no towers."""

FINEST = 0.5
"""Largest fine density that a texel can hold."""

GLSL = {"HEAPS_STEEPEST": STEEPEST, "HEAPS_FINE": 2.0 * FINEST}


@lru_cache(maxsize=CACHED_SEEDS)
def heap_texels(*, seed: int) -> NDArray[np.uint8]:
    """Return a scene's cloud map as four channels, (SIDE, SIDE, 4).

    They are broad density, its slopes along x and z, and fine density: the rest of the map's density.
    """
    density = repeating_levels(seed=seed)[0][..., 0] / 255.0
    wave = np.fft.fftfreq(SIDE, 1.0 / SIDE)
    spectrum = np.fft.fft2(density) * np.exp(-((np.hypot(wave[:, None], wave) / FINE_FROM) ** 2))
    broad = np.clip(np.fft.ifft2(spectrum).real, 0.0, 1.0)
    slopes = (np.fft.ifft2(2j * np.pi * along * spectrum).real / STEEPEST for along in (wave[None], wave[:, None]))
    signed = (0.5 + 0.5 * np.clip(each, -1.0, 1.0) for each in (*slopes, (density - broad) / FINEST))
    return np.rint(255.0 * np.stack([broad, *signed], axis=-1)).astype(np.uint8)


def heaps_texture(ctx: moderngl.Context, *, seed: int) -> moderngl.Texture:
    """Return `heap_texels` as a repeating texture."""
    texture = ctx.texture((SIDE, SIDE), 4, heap_texels(seed=seed))
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
