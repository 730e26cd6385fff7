"""Contrast: whether a picture has the grain of grass, which means do not measure, and which blur removes."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...systems.light.color import luminance
from ...systems.reference import Truth
from ..studio.encode import Picture

TILE, LINES = 40, 720
"""Side of a tile [pixels] in a picture of `LINES` lines; it scales with the number of lines."""

LEAST = 1.5
"""Standard deviation in the reference below which a tile has no grain to compare with [steps of 255]."""

DOUBT_VARIANCE = 2.0**1.5 - 1.0
"""Ratio of a truth's squared `doubt` to the noise variance of its picture, for edges sampled on a lattice.

The error of a lattice falls with the power 3/4 of its number of samples. So the variance of a half is 2^1.5 times that
of the whole, and the mean of both halves is common to them. Where blades are much thinner than the samples' spacing the
noise is larger: never more is subtracted than there is. Measured at 16 against 144 samples a pixel: 0.6 to 0.9 of it.
"""

WORST = 5.0
"""Percentile of the tiles' contrast that is reported, from the flattest."""


def tile_side(lines: int, /) -> int:
    """Return the side of a tile [pixels] in a picture of this number of lines, 4 at least."""
    return max(4, round(TILE * lines / LINES))


def luma(picture: NDArray[np.generic], /) -> Doubles:
    """Return the luma of sRGB colours (..., 3), in display space [steps of 255], shape (...)."""
    return luminance(picture.astype(np.float64))


def tiled(values: NDArray[np.generic], side: int, /) -> NDArray[np.generic]:
    """Cut an array (height, width) into tiles, shape (rows, columns, side * side); the remainder is dropped."""
    rows, columns = values.shape[0] // side, values.shape[1] // side
    blocks = values[: rows * side, : columns * side].reshape(rows, side, columns, side)
    return blocks.swapaxes(1, 2).reshape(rows, columns, side * side)


def relative_contrast(picture: Picture, truth: Truth, grass: NDArray[np.bool_], /) -> Doubles:
    """Return the standard deviation of luma relative to the truth's, for each tile that is all grass, shape (tiles,).

    The picture is sRGB bytes (height, width, 3); `grass` (height, width) is the mask of its grass. The sampling noise
    of the truth is subtracted from its variance. Where blades are a tenth of a pixel wide, that is two fifths of the
    variance. Tiles in which the truth is flat are left out.
    """
    side = tile_side(len(picture))
    drawn, seen = (tiled(luma(each), side).std(axis=-1) for each in (picture, truth.picture))
    noise = np.square(tiled(luma(truth.doubt), side)).mean(axis=-1) / DOUBT_VARIANCE
    true = np.sqrt(np.maximum(np.square(seen) - noise, 0.0))
    compared = tiled(grass, side).all(axis=-1) & (true >= LEAST)
    return np.asarray(drawn[compared] / true[compared])


def contrast(picture: Picture, truth: Truth, grass: NDArray[np.bool_], /) -> float | None:
    """Return the percentile `WORST` of `relative_contrast`, or None where no tile is all grass."""
    tiles = relative_contrast(picture, truth, grass)
    return float(np.percentile(tiles, WORST)) if tiles.size else None
