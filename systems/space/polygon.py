"""Polygons on the ground."""

import numpy as np

from ...components.arrays import Doubles, Floats, Mask


def in_polygon(place: Doubles | Floats, corners: Doubles | Floats, /) -> Mask:
    """Return which places (..., 2) a closed polygon holds, shape (...): a ray from them crosses its edges an odd time.

    Its corners are (n, 2), in either direction round; it may be concave.
    """
    x, z = (np.ascontiguousarray(place[..., axis]) for axis in (0, 1))
    holds = np.zeros(x.shape, np.bool_)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if a[1] == b[1]:
            continue
        edge = b - a
        crosses = (a[1] > z) != (b[1] > z)
        before = (x - a[0]) * edge[1] - edge[0] * (z - a[1])
        holds ^= crosses & ((before < 0.0) == (edge[1] > 0.0))
    return holds
