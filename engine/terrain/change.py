"""Changing a terrain's heights while a prairie lives, and bringing them back as they were loaded."""

from collections.abc import Iterator
from reprlib import repr as shortened

import numpy as np
from numpy.typing import ArrayLike

from ...components.arrays import Floats, Ints
from ..handed import as_floats
from .load import HIGHEST
from .part import Part
from .record import Terrain

SQUARE = 16
"""Samples along a side of the squares that changes are kept by."""

_ON = 0.01
"""How far off its sample a corner may be [cells]: coordinates are rounded."""

Squares = tuple[Ints, Floats]
"""Rows and columns of squares of samples, shape (n, 2); and their heights, one square after another, shape (m,)."""


def set_heights(terrain: Terrain, corner: ArrayLike, heights: ArrayLike, /) -> None:
    """Put other heights (rows, columns) [m] into a terrain, the first of them at the sample at `corner` (x, z) [m].

    Raises ValueError for heights that are none, and for what does not lie on the terrain's samples.
    """
    new = _checked(heights)
    part = _part(terrain, corner, new.shape)
    _keep(terrain, part)
    terrain.put(part, new)


def _checked(heights: ArrayLike) -> Floats:
    due = "heights are finite numbers [m] in rows and columns"
    new = as_floats(heights, due)
    if new.ndim != 2 or not new.size:
        raise ValueError(f"{due}, not an array of shape {new.shape}")
    if np.abs(new).max() > HIGHEST:
        raise ValueError(f"heights lie within {HIGHEST:g} m, and these go from {new.min():.6g} to {new.max():.6g} m")
    return new


def _part(terrain: Terrain, corner: ArrayLike, shape: tuple[int, ...]) -> Part:
    """Return the part of a terrain that begins at `corner` (x, z) [m]."""
    place = as_floats(corner, "the corner of heights is a place (x, z)").astype(np.float64)
    if place.shape != (2,):
        raise ValueError(f"the corner of heights is a place (x, z), not {shortened(corner)}")
    at = (place - terrain.origin) / terrain.cell
    column, row = (int(number) for number in np.round(at))
    (left, far), (width, depth), (rows, columns) = terrain.origin, terrain.size, terrain.heights.shape
    if row < 0 or column < 0 or row + shape[0] > rows or column + shape[1] > columns:
        raise ValueError(
            f"{shape[0]} by {shape[1]} heights from ({place[0]:g}, {place[1]:g}) on do not all lie on the terrain, "
            f"which goes from ({left:g}, {far:g}) to ({left + width:g}, {far + depth:g}), a sample every "
            f"{terrain.cell:g} m"
        )
    if np.abs(at - (column, row)).max() > _ON:
        x, z = left + column * terrain.cell, far + row * terrain.cell
        raise ValueError(
            f"heights begin at a sample of the terrain, and ({place[0]:g}, {place[1]:g}) is none: samples stand every "
            f"{terrain.cell:g} m, the nearest at ({x:.9g}, {z:.9g})"
        )
    return Part(row, column, *shape)


def _keep(terrain: Terrain, part: Part) -> None:
    """Keep the heights as they were loaded of the squares that a part reaches."""
    rows, columns = (range(some.start // SQUARE, (some.stop - 1) // SQUARE + 1) for some in part.slices)
    for square in ((row, column) for row in rows for column in columns):
        if square not in terrain.changes.loaded:
            terrain.changes.loaded[square] = terrain.heights[_within(terrain, square).slices].copy()


def _within(terrain: Terrain, square: tuple[int, int]) -> Part:
    """Return the part that a square covers: those at the edge are narrower."""
    row, column = (SQUARE * number for number in square)
    rows, columns = (min(SQUARE, count - at) for at, count in zip((row, column), terrain.heights.shape, strict=True))
    return Part(row, column, rows, columns)


def as_loaded(terrain: Terrain, /) -> Iterator[Floats]:
    """Yield the heights as they were loaded, some rows at a time."""
    touched: dict[int, list[tuple[int, Floats]]] = {}
    for (number, column), before in terrain.changes.loaded.items():
        touched.setdefault(number, []).append((column * SQUARE, before))
    for number, row in enumerate(range(0, len(terrain.heights), SQUARE)):
        heights = terrain.heights[row : row + SQUARE]
        if number in touched:
            heights = heights.copy()
            for column, before in touched[number]:
                heights[:, column : column + SQUARE] = before
        yield heights


def changed_squares(terrain: Terrain, /) -> Squares:
    """Return the squares that have been changed, as they are now."""
    squares = sorted(terrain.changes.loaded)
    heights = [terrain.heights[_within(terrain, each).slices].ravel() for each in squares]
    return np.array(squares, np.int32).reshape(-1, 2), np.concatenate([np.zeros(0, np.float32), *heights])


def must_be_squares(terrain: Terrain, squares: Squares, /) -> None:
    """Raise ValueError for squares that cannot be `changed_squares` of a terrain."""
    where, heights = squares
    counts = np.ceil(np.divide(terrain.heights.shape, SQUARE))
    if ((where < 0) | (where >= counts)).any() or len({*map(tuple, where.tolist())}) != len(where):
        raise ValueError("ground has changed that is not there")
    parts = [_within(terrain, (row, column)) for row, column in where.tolist()]
    if sum(part.rows * part.columns for part in parts) != len(heights) or not (np.abs(heights) <= HIGHEST).all():
        raise ValueError("ground has come to no height")


def restore_squares(terrain: Terrain, squares: Squares, /) -> None:
    """Let these squares be as they are given, and all else as it was loaded."""
    where, heights = squares
    kept, at = {(row, column) for row, column in where.tolist()}, 0
    for square in [each for each in terrain.changes.loaded if each not in kept]:
        terrain.put(_within(terrain, square), terrain.changes.loaded.pop(square))
    for row, column in where.tolist():
        part = _within(terrain, (row, column))
        _keep(terrain, part)
        end = at + part.rows * part.columns
        terrain.put(part, heights[at:end].reshape(part.rows, part.columns))
        at = end
