"""The view cone, and distances as patches count them (paper, section 2.2, figure 5)."""

from math import atan2, cos, isclose, pi, sin
from operator import mul

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...engine.camera import View

Rows = list[list[float]]
"""The rows of a matrix."""

WALKER = 2.0
"""Height of eyes that the reaches of representations are made for [m]."""

HIGH = 0.7
"""What a metre of height above a walker's eyes counts, of one along the ground."""

HALF_DIAGONAL = 0.7072
"""Distance from the middle of a square to its corners, as a part of its side."""

BESIDE = 0.05
"""How far outside the picture straight up and down still count as seen, in halves of the picture."""


def view_cone(seen: View, /) -> tuple[float, float]:
    """Return the azimuths (middle, half width) [rad] of everything that is seen, as if from above.

    They are those of the picture's corners, however the camera is turned, banked or shifted. Where straight up or
    straight down is in the picture, and where there is no perspective, it is all round: then the half width is pi.
    """
    # Plain numbers: for so few of them, arrays take many times as long.
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


def _is_near(one: float, other: float) -> bool:
    return isclose(one, other, rel_tol=1e-5, abs_tol=1e-8)


def _azimuth(x: float, y: float, axes: Rows) -> float:
    """Return the azimuth [rad] of what is seen at (x, y, -1) from the eye."""
    right, _, back = (x * a + y * b - c for a, b, c in zip(*axes, strict=True))
    return atan2(right, -back)


def _shows_pole(projection: Rows, up: list[float]) -> bool:
    """Return whether straight up or down, given as seen from the eye, is in the picture or just beside it."""
    pole = up if up[2] < 0.0 else [-part for part in up]
    across = (sum(map(mul, row[:3], pole)) for row in projection[:2])
    return all(abs(each) / max(-pole[2], 1e-9) < 1.0 + BESIDE for each in across)


def inside_cone(
    place: Floats | Doubles, /, *, apex: tuple[float, float], cone: tuple[float, float], radius: float
) -> NDArray[np.bool_]:
    """Return whether discs of `radius` [m] around ground positions (n, 2) touch the view cone, shape (n,)."""
    return np.asarray(beyond_cone(place[:, 0], place[:, 1], apex=apex, cone=cone) <= radius)


def beyond_cone(
    x: Floats | Doubles, z: Floats | Doubles, /, *, apex: tuple[float, float], cone: tuple[float, float]
) -> Floats | Doubles:
    """Return how large discs around ground positions have to be to touch the view cone [m]: inside it 0 or less.

    `x` and `z` [m] are of one shape, that of what is returned, or make it together: those of the columns of a square
    and, as a column, those of its lines.
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
    """Return the patches' distance (paper, section 2.2): 0 for the viewer's, 1 for its eight neighbours, ..."""
    aside, ahead = cells_apart(cell, centre)
    return np.maximum(aside, ahead)


def cells_apart(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return how many cells (..., 2) are away along x, and along z, each of shape (...)."""
    return np.abs(cell[..., 0] - centre[0]), np.abs(cell[..., 1] - centre[1])


def seen_from(
    distance: NDArray[np.generic], height: NDArray[np.float32], eye: float, /, *, patch: float
) -> NDArray[np.float32]:
    """Return how far away [patch sides] patches are to an eye at some height [m], shape (n,).

    `distance` is how far they are along the ground [patch sides], and `height` their ground's [m], both (n,). Of the
    way up from a walker's eyes only `HIGH` counts: from above grass does not hide other grass, so finer representations
    are told from coarser ones for longer.
    """
    up = np.maximum(np.float32(eye - WALKER) - height, np.float32(0.0)) * np.float32(HIGH / patch)
    away = distance.astype(np.float32)
    return np.asarray(np.sqrt(away * away + up * up))


def nearness(cell: NDArray[np.int32], centre: NDArray[np.int32], /) -> NDArray[np.int32]:
    """Return a number of each cell (n, 2) that rises from far to near for whoever is in `centre`, shape (n,).

    A ray leaves square rings from the inside out, and within a ring it moves away from the axis; so rings from the
    outside in, and each from its corners to its axes, never draw a patch over one before it (paper, section 2.2). It is
    0 for the viewer's own cell, and for one at the discrete distance d more than -(d + 1) * (d + 1).
    """
    aside, ahead = cells_apart(cell, centre)
    ring = np.maximum(aside, ahead)
    return -(ring * ring + np.minimum(aside, ahead))
