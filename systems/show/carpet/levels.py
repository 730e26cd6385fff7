"""Mip levels of the carpet's images: means over what a pixel covers of level ground."""

import math

import numpy as np

from ....components.arrays import Bytes
from ....engine.gl.mipmaps import levels

_ALONG = (1, 2)
"""Axes of images (directions, rows, columns, 4) along the view, of the first direction and of the second, and so on."""


def seen_levels(images: Bytes, slope: float, /) -> list[Bytes]:
    """Return all mip levels of a slope's images (4, r, r, 4), finest first, as pixels average them.

    `images` are those of a row of `Carpet.texels`, which repeat beyond their edges. A pixel that is as wide as a texel
    covers so many texels along the view as a distance on level ground is longer than it is high in the picture. Each
    level is a mean over these. Without it, a pixel would show a few of the leaves that it covers, and others in the
    next frame: far hillsides would twinkle while one walks.
    """
    covered = math.sqrt(1.0 + slope**-2.0)
    return [_seen(level, covered) for level in levels(images)]


def _seen(level: Bytes, covered: float) -> Bytes:
    seen = np.empty_like(level)
    for first, axis in enumerate(_ALONG):
        seen[first::2] = averaged(level[first::2], axis, covered)
    return seen


def averaged(images: Bytes, axis: int, length: float, /) -> Bytes:
    """Return images averaged along an axis over a `length` about each texel [texels], at most over all of them.

    `images` (images, r, r, 4) repeat beyond their edges.
    """
    side = images.shape[axis]
    length = min(length, float(side))
    part, whole = math.modf(0.5 * (length - 1.0))
    outer = int(whole) + 1  # reach of the window's outermost texels, which count in part
    turned = np.moveaxis(images, axis, 0).astype(np.int32)
    repeated = np.concatenate([turned[-outer:], turned, turned[:outer]])
    sums = np.concatenate([np.zeros_like(turned[:1]), np.cumsum(repeated, axis=0, dtype=np.int32)])
    wide = sums[2 * outer + 1 :] - sums[:side]
    narrow = sums[2 * outer : -1] - sums[1 : side + 1]
    mean = (narrow + np.float32(part) * (wide - narrow)) * np.float32(1.0 / length)
    return np.moveaxis(np.rint(mean).astype(np.uint8), 0, axis)
