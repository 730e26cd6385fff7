"""Marks: the coloured triangles and lines of an overlay."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.arrays import Floats
from ...engine.terrain.record import Terrain
from ...engine.terrain.sample import height_at

SHAPE = np.dtype([("place", "3f4"), ("color", "4f4")])
"""One corner of a triangle: position, and display colour with opacity."""

LINE = np.dtype([("a", "3f4"), ("b", "3f4"), ("color", "4f4"), ("width", "f4")])
"""A line: its ends, display colour with opacity, and width [pixels of a picture 540 high]."""

LIFT = 0.05
"""Height of marks above the ground [m]."""

HIDDEN = 0.12
"""Factor on the opacity of marks behind hills."""

CLEARANCE = 0.3
"""Height above the line of sight from which on a hill hides what is behind it [m]."""

SIGHTINGS = 20
"""Number of samples along a line of sight at which it is compared with the ground."""


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """Triangles with lines over them."""

    shapes: NDArray[np.void]
    """Records of `SHAPE`, three for each triangle, shape (3 n,)."""

    lines: NDArray[np.void]
    """Records of `LINE`, shape (m,)."""


def filled(corners: Floats, color: ArrayLike, /) -> Marks:
    """Return filled triangles (n, 3, 3); the colour is one for all (4,), per triangle (n, 1, 4) or corner (n, 3, 4)."""
    shapes = np.zeros((len(corners), 3), SHAPE)
    shapes["place"], shapes["color"] = corners, color
    return Marks(shapes.reshape(-1), np.zeros(0, LINE))


def stroked(a: Floats, b: Floats, color: ArrayLike, /, *, width: float) -> Marks:
    """Return lines between ends (n, 3); the colour is one for all (4,), or per line (n, 4)."""
    lines = np.zeros(len(a), LINE)
    lines["a"], lines["b"], lines["color"], lines["width"] = a, b, color, width
    return Marks(np.zeros(0, SHAPE), lines)


def together(*marks: Marks) -> Marks:
    """Concatenate marks: all triangles, then all lines."""
    shapes = [np.zeros(0, SHAPE), *(mark.shapes for mark in marks)]
    return Marks(np.concatenate(shapes), np.concatenate([np.zeros(0, LINE), *(mark.lines for mark in marks)]))


def split(quads: Floats, /) -> Floats:
    """Split quads (n, 4, k), with corners in order around, into two triangles each, shape (2 n, 3, k)."""
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3, quads.shape[-1])


def on_ground(terrain: Terrain, place: Floats, /) -> Floats:
    """Return points `LIFT` above ground positions (x, z) (..., 2) [m], shape (..., 3)."""
    flat = np.ascontiguousarray(place.reshape(-1, 2), np.float32)
    height = height_at(terrain, flat) + np.float32(LIFT)
    return np.stack([flat[:, 0], height, flat[:, 1]], axis=1).reshape(*place.shape[:-1], 3)


def behind_hills(terrain: Terrain, eye: tuple[float, float, float], place: Floats, /) -> NDArray[np.bool_]:
    """Return whether a hill hides each point (n, 3) [m] from the eye, shape (n,)."""
    if float(np.ptp(terrain.heights)) < CLEARANCE or not len(place):
        return np.zeros(len(place), np.bool_)
    along = np.linspace(0.0, 1.0, SIGHTINGS + 2, dtype=np.float32)[1:-1, None, None]
    ray = np.asarray(eye, np.float32) * (1.0 - along) + place * along
    ground = height_at(terrain, np.ascontiguousarray(ray[..., ::2].reshape(-1, 2))).reshape(ray.shape[:2])
    return np.asarray((ground > ray[..., 1] + np.float32(CLEARANCE)).any(axis=0))


def veiled(marks: Marks, terrain: Terrain, eye: tuple[float, float, float], /) -> Marks:
    """Return marks with a lower opacity behind hills."""
    shapes, lines = marks.shapes.copy().reshape(-1, 3), marks.lines.copy()
    shapes["color"][behind_hills(terrain, eye, shapes["place"].mean(axis=1)), :, 3] *= HIDDEN
    lines["color"][behind_hills(terrain, eye, (lines["a"] + lines["b"]) / 2), 3] *= HIDDEN
    return Marks(shapes.reshape(-1), lines)
