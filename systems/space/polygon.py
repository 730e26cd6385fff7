"""Lines and polygons on the ground."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Mask

Places = NDArray[np.floating]


def in_polygon(place: Places, corners: Places, /) -> Mask:
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


def signed_distances(place: Places, corners: Places, /) -> NDArray[Any]:
    """Return distances of places (n, 2) from a closed polygon's outline, negative inside, shape (n,)."""
    away = line_distances(place, np.concatenate([corners, corners[:1]]))
    return np.asarray(np.where(in_polygon(place, corners), -away, away))


def line_distances(place: Places, line: Places, /, *, near: Iterable[int] | None = None) -> NDArray[Any]:
    """Return distances of places (n, 2) from the nearest of a polyline's segments (m, 2), shape (n,).

    `near` gives the numbers of the segments to look at, by default all.
    """
    least = np.full(len(place), np.inf, place.dtype)
    right, ahead = np.ascontiguousarray(place.T)
    for number in range(len(line) - 1) if near is None else near:
        x, z, (dx, dz) = right - line[number, 0], ahead - line[number, 1], line[number + 1] - line[number]
        along = (x * dx + z * dz) / place.dtype.type(max(float(dx * dx + dz * dz), 1e-12))
        np.clip(along, 0.0, 1.0, out=along)
        x -= along * dx
        z -= along * dz
        np.minimum(least, x * x + z * z, out=least)
    return np.asarray(np.sqrt(least))
