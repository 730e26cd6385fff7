"""Polygons on the ground."""

import numpy as np

from ...components.arrays import Doubles, Floats, Mask


def in_polygon(place: Doubles | Floats, corners: Doubles | Floats, /) -> Mask:
    """Return which places (..., 2) a closed polygon holds, shape (...): a ray from them crosses its edges an odd time.

    Its corners are (n, 2), in either direction round; it may be concave.
    """
    holds = np.zeros(place.shape[:-1], np.bool_)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge, to = b - a, place - a
        crosses = (a[1] > place[..., 1]) != (b[1] > place[..., 1])
        before = to[..., 0] * edge[1] - edge[0] * to[..., 1]
        holds ^= crosses & ((before < 0.0) == (edge[1] > 0.0))
    return holds
