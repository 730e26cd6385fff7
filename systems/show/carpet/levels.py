"""Mip levels of the carpet's images: means over what a pixel covers of level ground."""

import math

import numpy as np

from ....components.arrays import Bytes
from ....engine.gl.mipmaps import levels

FINEST = 0.5
"""Typical size of a pixel that reads the finest level [texels]: smaller ones than at the other levels read it, too."""


def seen_levels(images: Bytes, slope: float, /) -> list[Bytes]:
    """Return all mip levels of a slope's images (4, r, r, 4), finest first, as pixels average them.

    `images` are those of a row of `Carpet.texels`, which repeat beyond their edges. A pixel that is as wide as a texel
    covers so many texels along the view as a distance on level ground is longer than it is high in the picture. Each
    level is a mean over these. Without it, a pixel would show a few of the leaves that it covers, and others in the
    next frame: far hillsides would twinkle while one walks.
    """
    covered = math.sqrt(1.0 + slope**-2.0)
    return [_seen(level, covered * (1.0 if number else FINEST)) for number, level in enumerate(levels(images))]


def _seen(level: Bytes, covered: float) -> Bytes:
    along_z, along_x = np.moveaxis(level[::2], 1, 0), np.moveaxis(level[1::2], 2, 0)
    mean, seen = averaged(np.concatenate([along_z, along_x], axis=1), covered), np.empty_like(level)
    seen[::2], seen[1::2] = np.moveaxis(mean[:, :2], 0, 1), np.moveaxis(mean[:, 2:], 0, 2)
    return seen


def averaged(rows: Bytes, length: float, /) -> Bytes:
    """Return rows (r, ...), which repeat, averaged about each over a `length`, at most over all [rows]."""
    length = min(max(length, 1.0), float(len(rows)))
    part, whole = math.modf(0.5 * (length - 1.0))
    last = 2 * (int(whole) + 1)  # index in a window of its last row, which counts in part, as the first does
    large_enough = np.min_scalar_type(255 * (last + 1))
    repeated = np.concatenate([rows[-(last // 2) :], rows, rows[: last // 2]]).astype(large_enough)
    inner = repeated[1:last].sum(axis=0, dtype=large_enough)
    of_inner, of_ends, mean = np.float32(1.0 / length), np.float32(part / length), np.empty_like(rows)
    for first in range(len(rows)):  # a running sum is three times as fast as differences of a cumulative one
        ends = repeated[first] + repeated[first + last]
        mean[first] = inner * of_inner + ends * of_ends + np.float32(0.5)
        inner = inner + repeated[first + last] - repeated[first + 1]
    return mean
