"""Clouds: a thin layer that drifts with the wind, as a texture that repeats."""

import moderngl
import numpy as np
from numpy.typing import NDArray

SIDE = 256
"""Texels along a side."""


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


def cloud_texture(ctx: moderngl.Context, *, seed: int) -> moderngl.Texture:
    """Return `cloud_map` as a texture."""
    texture = ctx.texture((SIDE, SIDE), 1, cloud_map(seed=seed).tobytes(), alignment=1)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    return texture
