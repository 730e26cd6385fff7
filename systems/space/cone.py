"""The view cone, and distances in patches (paper, section 2.2, figure 5)."""

from math import atan2, cos, isclose, pi, sin
from operator import mul

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...engine.camera import View

Rows = list[list[float]]
"""The rows of a matrix."""

WALKER = 2.0
"""Height of a walker's eyes, which the reaches of representations are made for [m]."""

HEIGHT_WEIGHT = 0.7
"""Weight of a metre of height above a walker's eyes in distances, relative to a metre along the ground."""

HALF_DIAGONAL = 0.7072
"""Distance from the middle of a square to its corners, as a part of its side."""

MARGIN = 0.05
"""Margin outside the picture within which straight up and straight down still count as seen [half pictures]."""


def view_cone(seen: View, /) -> tuple[float, float]:
    """Return the range of azimuths of everything in the picture: its middle and its half width [rad].

    It spans the picture's corners, however the camera is turned, banked or shifted. The half width is pi, all round,
    where straight up or straight down is in the picture, and where there is no perspective.
    """
    # Plain numbers: numpy takes many times as long for so few.
    projection, axes = seen.projection.tolist(), seen.view[:3, :3].tolist()
    perspective = all(map(_is_near, projection[3], (0.0, 0.0, -1.0, 0.0)))
    if not perspective or _shows_pole(projection, [axis[1] for axis in axes]):
        return 0.0, pi
    (a, b, right, _), (c, d, up, _) = projection[:2]
    area = a * d - b * c
    if area == 0.0:
        return 0.0, pi
    corners = [(x + right, y + up) for x in (-1.0, 1.0) for y in (-1.0, 1.0)]
    azimuth = [_azimuth((d * x - b * y) / area, (a * y - c * x) / area, axes) for x, y in corners]
    apart = [(each - azimuth[0] + pi) % (2 * pi) - pi for each in azimuth]
    return azimuth[0] + (max(apart) + min(apart)) / 2, (max(apart) - min(apart)) / 2


def _is_near(a: float, b: float) -> bool:
    return isclose(a, b, rel_tol=1e-5, abs_tol=1e-8)


def _azimuth(x: float, y: float, axes: Rows) -> float:
    """Return the azimuth [rad] of the direction (x, y, -1) in the eye's frame."""
    right, _, back = (x * a + y * b - c for a, b, c in zip(*axes, strict=True))
    return atan2(right, -back)


def _shows_pole(projection: Rows, up: list[float]) -> bool:
    """Return whether straight up or down is in the picture or its margin; `up` is in the eye's frame."""
    pole = up if up[2] < 0.0 else [-part for part in up]
    across = (sum(map(mul, row[:3], pole)) for row in projection[:2])
    return all(abs(each) / max(-pole[2], 1e-9) < 1.0 + MARGIN for each in across)


def inside_cone(
    place: Floats | Doubles, /, *, apex: tuple[float, float], cone: tuple[float, float], radius: float
) -> NDArray[np.bool_]:
    """Return whether discs of `radius` [m] around ground positions (n, 2) touch the view cone, shape (n,)."""
    return np.asarray(outside_cone(place[:, 0], place[:, 1], apex=apex, cone=cone) <= radius)


def outside_cone(
    x: Floats | Doubles, z: Floats | Doubles, /, *, apex: tuple[float, float], cone: tuple[float, float]
) -> Floats | Doubles:
    """Return the distance of ground positions from the view cone [m], 0 or less inside it.

    Behind the apex it is a lower bound: the larger of the distances from the apex's plane and the cone's sides.
    The shapes of `x` and `z` [m] are broadcast together: they may be (columns,) and (lines, 1) of a square.
    """
    middle, half = cone
    if half >= pi:
        return np.full(np.broadcast_shapes(x.shape, z.shape), -np.inf, np.float32)
    sine, cosine = np.float32(sin(middle)), np.float32(cos(middle))
    x, z = x - np.float32(apex[0]), z - np.float32(apex[1])
    along, across = x * sine - z * cosine, np.abs(x * cosine + z * sine)
    across *= np.float32(cos(half))
    across -= along * np.float32(sin(half))
    return np.maximum(across, -along)


def discrete_distance(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> NDArray[np.int32]:
    """Return the discrete distance of cells: 0 for `centre`, 1 for its eight neighbours, ... (paper, section 2.2)."""
    aside, ahead = cells_apart(cell, centre)
    return np.maximum(aside, ahead)


def cells_apart(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return the distances of cells (..., 2) from `centre` along x and along z [cells], each of shape (...)."""
    return np.abs(cell[..., 0] - centre[0]), np.abs(cell[..., 1] - centre[1])


def seen_from(
    distance: NDArray[np.generic], height: NDArray[np.float32], eye: float, /, *, patch: float
) -> NDArray[np.float32]:
    """Return the distance of patches from an eye at a height `eye` [m], shape (n,) [patch sides].

    `distance` is the distance along the ground [patch sides] and `height` the ground's height there [m], both (n,).
    Height above a walker's eyes counts less, by `HEIGHT_WEIGHT`: from above, grass does not hide other grass, so finer
    representations differ visibly from coarser ones up to a larger distance.
    """
    up = np.maximum(np.float32(eye - WALKER) - height, np.float32(0.0)) * np.float32(HEIGHT_WEIGHT / patch)
    away = distance.astype(np.float32)
    return np.asarray(np.sqrt(away * away + up * up))


def nearness(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> NDArray[np.int32]:
    """Return a sort key for each cell (n, 2) that rises from far to near as seen from `centre`, shape (n,).

    A ray leaves square rings from the inside out, and within a ring it moves away from the axis. So drawing rings from
    the outside in, and each from its corners to its axes, never draws a patch over one before it (paper, section 2.2).
    The key is 0 for `centre`, and above -(d + 1) * (d + 1) at the discrete distance d.
    """
    aside, ahead = cells_apart(cell, centre)
    ring = np.maximum(aside, ahead)
    return -(ring * ring + np.minimum(aside, ahead))


def distance_in_order(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> NDArray[np.float64]:
    """Return the distances of cells (..., 2) from `centre` by which `nearness` orders them, (...) [patch sides].

    Of two things on a ray from the viewer's cell, the one on the farther cell is never the nearer by this distance, as
    the viewer walks from cell to cell.
    """
    return np.asarray(np.sqrt(-nearness(cell, centre).astype(np.float64)))
