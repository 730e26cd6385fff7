"""Changing a terrain's heights while a prairie lives, and bringing them back as they were loaded."""

from collections.abc import Iterator
from reprlib import repr as shortened

import numpy as np
from numpy.typing import ArrayLike

from ...components.arrays import Floats, Ints, Mask
from ..handed import as_floats
from .load import HIGHEST
from .part import Part
from .record import Terrain

SQUARE = 16
"""Samples along a side of the squares that changes are kept by."""

_ON = 0.01
"""How far off its sample a corner may be [cells]: coordinates are rounded."""

Squares = tuple[Ints, Floats, Mask]
"""Rows and columns of squares of samples, shape (n, 2); their heights, one square after another, shape (m,); and where
there are holes, likewise."""


def set_heights(terrain: Terrain, corner: ArrayLike, heights: ArrayLike, /) -> None:
    """Put other heights (rows, columns) [m] into a terrain, the first of them at the sample at `corner` (x, z) [m].

    Where they are NaN there is a hole from now on, and the ground around it stays as it was. Raises ValueError for
    heights that are none, and for what does not lie on the terrain's samples.
    """
    new = _checked(heights)
    part = _part(terrain, corner, new.shape)
    _keep(terrain, part)
    holes = np.isnan(new)
    terrain.put(part, np.where(holes, terrain.heights[part.slices], new), holes)


def _checked(heights: ArrayLike) -> Floats:
    due = "heights are numbers [m] in rows and columns, or NaN where there is no ground"
    new = as_floats(heights, due, holes=True)
    if new.ndim != 2 or not new.size:
        raise ValueError(f"{due}, not an array of shape {new.shape}")
    low, high = np.fmin.reduce(new, axis=None), np.fmax.reduce(new, axis=None)
    if max(-low, high) > HIGHEST:
        raise ValueError(f"heights lie within {HIGHEST:g} m, and these go from {low:.6g} to {high:.6g} m")
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
    """Keep heights and holes as they were loaded of the squares that a part reaches."""
    rows, columns = (range(some.start // SQUARE, (some.stop - 1) // SQUARE + 1) for some in part.slices)
    for square in ((row, column) for row in rows for column in columns):
        if square not in terrain.changes.loaded:
            within = _within(terrain, square)
            terrain.changes.loaded[square] = terrain.heights[within.slices].copy(), terrain.holes_in(within)


def _within(terrain: Terrain, square: tuple[int, int]) -> Part:
    """Return the part that a square covers: those at the edge are narrower."""
    row, column = (SQUARE * number for number in square)
    rows, columns = (min(SQUARE, count - at) for at, count in zip((row, column), terrain.heights.shape, strict=True))
    return Part(row, column, rows, columns)


def as_loaded(terrain: Terrain, /) -> Iterator[tuple[Floats, Mask]]:
    """Yield heights and holes as they were loaded, some rows at a time."""
    touched: dict[int, list[tuple[int, tuple[Floats, Mask]]]] = {}
    for (number, column), before in terrain.changes.loaded.items():
        touched.setdefault(number, []).append((column * SQUARE, before))
    for number, row in enumerate(range(0, len(terrain.heights), SQUARE)):
        heights = terrain.heights[row : row + SQUARE]
        holes = terrain.holes_in(Part(row, 0, *heights.shape))
        if number in touched:
            heights = heights.copy()
            for column, before in touched[number]:
                heights[:, column : column + SQUARE], holes[:, column : column + SQUARE] = before
        yield heights, holes


def changed_squares(terrain: Terrain, /) -> Squares:
    """Return the squares that have been changed, as they are now."""
    squares = sorted(terrain.changes.loaded)
    parts = [_within(terrain, each) for each in squares]
    heights = [terrain.heights[part.slices].ravel() for part in parts]
    holes = [terrain.holes_in(part).ravel() for part in parts]
    where = np.array(squares, np.int32).reshape(-1, 2)
    return where, np.concatenate([np.zeros(0, np.float32), *heights]), np.concatenate([np.zeros(0, np.bool_), *holes])


def must_be_squares(terrain: Terrain, squares: Squares, /) -> None:
    """Raise ValueError for squares that cannot be `changed_squares` of a terrain."""
    where, heights, holes = squares
    counts = np.ceil(np.divide(terrain.heights.shape, SQUARE))
    if ((where < 0) | (where >= counts)).any() or len({*map(tuple, where.tolist())}) != len(where):
        raise ValueError("ground has changed that is not there")
    parts = [_within(terrain, (row, column)) for row, column in where.tolist()]
    due = sum(part.rows * part.columns for part in parts)
    if due != len(heights) or due != len(holes) or not (np.abs(heights) <= HIGHEST).all():
        raise ValueError("ground has come to no height")


def restore_squares(terrain: Terrain, squares: Squares, /) -> None:
    """Let these squares be as they are given, and all else as it was loaded."""
    where, heights, holes = squares
    kept, at = {(row, column) for row, column in where.tolist()}, 0
    for square in [each for each in terrain.changes.loaded if each not in kept]:
        terrain.put(_within(terrain, square), *terrain.changes.loaded.pop(square))
    for row, column in where.tolist():
        part = _within(terrain, (row, column))
        _keep(terrain, part)
        end, shape = at + part.rows * part.columns, (part.rows, part.columns)
        terrain.put(part, heights[at:end].reshape(shape), holes[at:end].reshape(shape))
        at = end
