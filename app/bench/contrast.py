"""Contrast: whether a picture has the grain of grass, which no mean over it tells, and which blur takes away."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...systems.light.color import luminance
from ...systems.reference import Truth
from ..studio.encode import Picture

TILE, LINES = 40, 720
"""Pixels along a side of a tile, in a picture of so many lines; in others it is as much of the picture."""

LEAST = 1.5
"""Deviation in the reference below which a tile has no grain to compare with [steps of 255]."""

APART = 2.0**1.5 - 1.0
"""What a truth's `doubt` is, squared, of the noise in its picture, where shapes with edges are sampled on a lattice.

Errors of a lattice fall as the number of its samples to the power of 3/4, so that by halves the variance is 2^1.5 times
as large; what the halves share is the mean. Where blades are much thinner than samples are apart the noise is more than
that: never more of it is taken off than there is. With 16 samples a pixel, beside 144, it is 0.6 to 0.9 of it.
"""

WORST = 5.0
"""The percentile of tiles that is told of, from the flattest."""


def tile_side(lines: int, /) -> int:
    """Return how many pixels a tile's side has in a picture of so many lines, 4 at least."""
    return max(4, round(TILE * lines / LINES))


def luma(picture: NDArray[np.generic], /) -> Doubles:
    """Return the luma of sRGB colours (..., 3), in display space and steps of 255, shape (...)."""
    return luminance(picture.astype(np.float64))


def tiled(values: NDArray[np.generic], side: int, /) -> NDArray[np.generic]:
    """Return an array (height, width) by tiles, shape (rows, columns, side * side); what is left over is dropped."""
    rows, columns = values.shape[0] // side, values.shape[1] // side
    blocks = values[: rows * side, : columns * side].reshape(rows, side, columns, side)
    return blocks.swapaxes(1, 2).reshape(rows, columns, side * side)


def relative_contrast(picture: Picture, truth: Truth, grass: NDArray[np.bool_], /) -> Doubles:
    """Return the standard deviation of luma over the truth's, for each tile that is all grass, shape (tiles,).

    The picture is sRGB bytes (height, width, 3); `grass` (height, width) says where it shows any. The truth's is that
    of endlessly many samples: what its picture deviates by for having few is taken off. Where blades are a tenth of a
    pixel, that is two fifths of the variance. Tiles where the truth is flat are left out.
    """
    side = tile_side(len(picture))
    drawn, seen = (tiled(luma(each), side).std(axis=-1) for each in (picture, truth.picture))
    noise = np.square(tiled(luma(truth.doubt), side)).mean(axis=-1) / APART
    true = np.sqrt(np.maximum(np.square(seen) - noise, 0.0))
    told = tiled(grass, side).all(axis=-1) & (true >= LEAST)
    return np.asarray(drawn[told] / true[told])


def contrast(picture: Picture, truth: Truth, grass: NDArray[np.bool_], /) -> float | None:
    """Return the `WORST` percentile of `relative_contrast`, or None where no tile is all grass."""
    tiles = relative_contrast(picture, truth, grass)
    return float(np.percentile(tiles, WORST)) if tiles.size else None
