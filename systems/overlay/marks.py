"""Marks: coloured triangles and lines, which is all that an overlay is made of."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.arrays import Floats
from ...engine.terrain.record import Terrain
from ...engine.terrain.sample import height_at

SHAPE = np.dtype([("place", "3f4"), ("color", "4f4")])
"""One corner of a triangle: place, and display colour with opacity."""

LINE = np.dtype([("a", "3f4"), ("b", "3f4"), ("color", "4f4"), ("width", "f4")])
"""A line: its ends, display colour with opacity, and width [pixels of a picture 540 high]."""

LIFT = 0.05
"""How high over the ground marks lie [m]."""

HIDDEN = 0.12
"""Opacity of what a hill hides, as a part of its own."""

CLEARANCE = 0.3
"""How far a hill must rise over the line of sight to hide what is behind it [m]."""

SIGHTINGS = 20
"""Places along a line of sight at which it is compared with the ground."""


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """Triangles with lines over them."""

    shapes: NDArray[np.void]
    """Records of `SHAPE`, three for each triangle, shape (3 n,)."""

    lines: NDArray[np.void]
    """Records of `LINE`, shape (m,)."""


def filled(corners: Floats, color: ArrayLike, /) -> Marks:
    """Return triangles (n, 3, 3) of one colour (4,), of one each (n, 1, 4), or of one at each corner (n, 3, 4)."""
    shapes = np.zeros((len(corners), 3), SHAPE)
    shapes["place"], shapes["color"] = corners, color
    return Marks(shapes.reshape(-1), np.zeros(0, LINE))


def stroked(a: Floats, b: Floats, color: ArrayLike, /, *, width: float) -> Marks:
    """Return lines between ends (n, 3), of one colour (4,) or of one each (n, 4)."""
    lines = np.zeros(len(a), LINE)
    lines["a"], lines["b"], lines["color"], lines["width"] = a, b, color, width
    return Marks(np.zeros(0, SHAPE), lines)


def together(*marks: Marks) -> Marks:
    """Return all the marks as one: every triangle, then every line, in this order."""
    shapes = [np.zeros(0, SHAPE), *(mark.shapes for mark in marks)]
    return Marks(np.concatenate(shapes), np.concatenate([np.zeros(0, LINE), *(mark.lines for mark in marks)]))


def split(quads: Floats, /) -> Floats:
    """Return two triangles for each quad (n, 4, k), whose corners go round: shape (2 n, 3, k)."""
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3, quads.shape[-1])


def on_ground(terrain: Terrain, place: Floats, /) -> Floats:
    """Return points just over ground positions (x, z) (..., 2) [m], shape (..., 3)."""
    flat = np.ascontiguousarray(place.reshape(-1, 2), np.float32)
    height = height_at(terrain, flat) + np.float32(LIFT)
    return np.stack([flat[:, 0], height, flat[:, 1]], axis=1).reshape(*place.shape[:-1], 3)


def behind_hills(terrain: Terrain, eye: tuple[float, float, float], place: Floats, /) -> NDArray[np.bool_]:
    """Return which points (n, 3) [m] a hill hides from the eye, shape (n,)."""
    if float(np.ptp(terrain.heights)) < CLEARANCE or not len(place):
        return np.zeros(len(place), np.bool_)
    along = np.linspace(0.0, 1.0, SIGHTINGS + 2, dtype=np.float32)[1:-1, None, None]
    ray = np.asarray(eye, np.float32) * (1.0 - along) + place * along
    ground = height_at(terrain, np.ascontiguousarray(ray[..., ::2].reshape(-1, 2))).reshape(ray.shape[:2])
    return np.asarray((ground > ray[..., 1] + np.float32(CLEARANCE)).any(axis=0))


def veiled(marks: Marks, terrain: Terrain, eye: tuple[float, float, float], /) -> Marks:
    """Return the marks, those behind hills fainter."""
    shapes, lines = marks.shapes.copy().reshape(-1, 3), marks.lines.copy()
    shapes["color"][behind_hills(terrain, eye, shapes["place"].mean(axis=1)), :, 3] *= HIDDEN
    lines["color"][behind_hills(terrain, eye, (lines["a"] + lines["b"]) / 2), 3] *= HIDDEN
    return Marks(shapes.reshape(-1), lines)
