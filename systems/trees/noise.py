"""Tileable noise for the furrows and spots of bark."""

from functools import lru_cache

import numpy as np

from ...components.arrays import Bytes
from ...engine.gl.mipmaps import levels

NOISE_CELLS = 64
"""Cells of one value each, along a side of the tile."""

FINER = 4
"""Texels along a side of a cell."""

SEED = 7

GLSL = {"NOISE_CELLS": float(NOISE_CELLS), "NOISE_FINER": float(FINER)}


@lru_cache(maxsize=1)
def bark_noise() -> list[Bytes]:
    """Return all mip levels, a layer (1, rows, columns) each: values of cells, smoothly interpolated."""
    values = np.random.default_rng(SEED).uniform(0.0, 255.0, (NOISE_CELLS, NOISE_CELLS))
    position = (np.arange(NOISE_CELLS * FINER) + 0.5) / FINER
    low = position.astype(np.intp)
    part = position - low
    part = part * part * (3.0 - 2.0 * part)
    for _ in range(2):
        ahead = np.roll(values, -1, axis=0)
        values = (values[low] + part[:, None] * (ahead[low] - values[low])).T
    return levels(np.round(values).astype(np.uint8)[None])
