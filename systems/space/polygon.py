"""Polygons on the ground."""

import numpy as np

from ...components.arrays import Doubles, Floats, Mask


def in_polygon(place: Doubles | Floats, corners: Doubles | Floats, /) -> Mask:
    """Return which places (..., 2) lie inside a closed polygon by the even-odd rule, shape (...).

    The corners (n, 2) may go either way round, and the polygon may be concave.
    """
    x, z = (np.ascontiguousarray(place[..., axis]) for axis in (0, 1))
    inside = np.zeros(x.shape, np.bool_)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if a[1] == b[1]:
            continue
        edge = b - a
        spans = (a[1] > z) != (b[1] > z)
        side = (x - a[0]) * edge[1] - edge[0] * (z - a[1])
        inside ^= spans & ((side < 0.0) == (edge[1] > 0.0))
    return inside
