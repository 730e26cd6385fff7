"""The map of clouds as the sky reads it: how dense they are, and how that rises along x and z."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from .repeating import SIDE, repeating_levels

STEEPEST = 24.0
"""The steepest that a texel can tell of, along an axis: a map that rises by 1 on that part of a side."""

SMOOTH = 40.0
"""Waves on a side from which on nothing counts of how the map rises: its steps are finer than those."""

GLSL = {"HEAPS_STEEPEST": STEEPEST}


def heap_texels(*, seed: int) -> NDArray[np.uint8]:
    """Return the map of clouds of a scene, and how it rises along x and z, as three channels: (SIDE, SIDE, 3)."""
    dense = repeating_levels(seed=seed)[0][..., 0] / 255.0
    wave = np.fft.fftfreq(SIDE, 1.0 / SIDE)
    spectrum = np.fft.fft2(dense) * np.exp(-((np.hypot(wave[:, None], wave) / SMOOTH) ** 2)) * 2j * np.pi
    rises = (np.fft.ifft2(spectrum * along).real for along in (wave[None], wave[:, None]))
    told = np.stack([dense, *(0.5 + 0.5 * np.clip(each / STEEPEST, -1.0, 1.0) for each in rises)], axis=-1)
    return np.rint(255.0 * told).astype(np.uint8)


def heaps_texture(ctx: moderngl.Context, *, seed: int) -> moderngl.Texture:
    """Return `heap_texels` as a texture that repeats."""
    texture = ctx.texture((SIDE, SIDE), 3, heap_texels(seed=seed), alignment=1)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
