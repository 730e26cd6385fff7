"""Changing a terrain's heights at run time, and saving and restoring the changes."""

from collections.abc import Iterable, Iterator, Sequence
from reprlib import repr as shortened

import numpy as np
from numpy.typing import ArrayLike

from ...components.arrays import Floats, Ints, Mask
from ..handed import as_floats
from .blocks import APART, SQUARE, Blocks
from .load import HIGHEST
from .record import Terrain
from .rectangle import Rectangle
from .stream import paste

_ON = 0.01
"""Greatest distance of a corner from its sample [cells]: coordinates are rounded."""

LIE = len(range(0, SQUARE, APART)) ** 2
"""Number of samples that tell where a changed square of a ground that streams lay."""

Squares = tuple[Ints, Floats, Mask]
"""Row and column of each square of samples, shape (n, 2); heights [m] and holes of all squares in turn, each (m,)."""


def set_heights(terrain: Terrain, corner: ArrayLike, heights: ArrayLike, /) -> None:
    """Replace heights (rows, columns) [m] of a terrain, the first of them at the sample at `corner` (x, z) [m].

    NaN makes a hole, under which the old height stays. Raises ValueError for invalid heights, and for a corner that is
    not at a sample of the terrain.
    """
    new = _checked(heights)
    part = _part(terrain, corner, new.shape)
    if terrain.blocks is not None:
        _put(terrain.blocks, terrain, part, new)
        return
    _keep(terrain, part)
    holes = np.isnan(new)
    terrain.put(part, np.where(holes, terrain.heights[part.slices], new), holes)


def _put(blocks: Blocks, terrain: Terrain, part: Rectangle, new: Floats) -> None:
    """Replace heights of a ground that streams; samples of `part` are counted from the origin."""
    for square in _squares_of(part):
        (top, left), (heights, holes) = (SQUARE * at for at in square), blocks.square(square)
        blocks.lie(square)
        within = part.moved(-top, -left).within(SQUARE, SQUARE)
        assert within is not None
        replacing = new[within.moved(top - part.row, left - part.column).slices]
        holes[within.slices] = np.isnan(replacing)
        heights[within.slices] = np.where(np.isnan(replacing), heights[within.slices], replacing)
        blocks.put(square, (heights, holes))
        paste(blocks, terrain, square)


def _squares_of(part: Rectangle) -> list[tuple[int, int]]:
    rows, columns = (range(some.start // SQUARE, (some.stop - 1) // SQUARE + 1) for some in part.slices)
    return [(row, column) for row in rows for column in columns]


def _checked(heights: ArrayLike) -> Floats:
    due = "heights are numbers [m] in rows and columns, or NaN where there is no ground"
    new = as_floats(heights, due, holes=True)
    if new.ndim != 2 or not new.size:
        raise ValueError(f"{due}, not an array of shape {new.shape}")
    low, high = np.fmin.reduce(new, axis=None), np.fmax.reduce(new, axis=None)
    if max(-low, high) > HIGHEST:
        raise ValueError(f"heights lie within {HIGHEST:g} m, and these go from {low:.6g} to {high:.6g} m")
    return new


def _part(terrain: Terrain, corner: ArrayLike, shape: tuple[int, ...]) -> Rectangle:
    """Return the part of a terrain that begins at `corner` (x, z) [m] and has this shape; raises ValueError."""
    place = as_floats(corner, "the corner of heights is a place (x, z)").astype(np.float64)
    if place.shape != (2,):
        raise ValueError(f"the corner of heights is a place (x, z), not {shortened(corner)}")
    (left, far), (width, depth), (rows, columns) = terrain.origin, terrain.size, terrain.heights.shape
    low = 0
    if terrain.blocks is not None:
        low, rows, columns = -terrain.blocks.most, terrain.blocks.most + 1, terrain.blocks.most + 1
        left, far, (width, depth) = 0.0, 0.0, terrain.whole
    at = (place - (left, far)) / terrain.cell
    column, row = (int(number) for number in np.round(at))
    if row < low or column < low or row + shape[0] > rows or column + shape[1] > columns:
        left, far = -width / 2, -depth / 2
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
    return Rectangle(row, column, *shape)


def _keep(terrain: Terrain, part: Rectangle) -> None:
    """Store the loaded heights and holes of all squares that overlap a part, unless they are stored already."""
    for square in _squares_of(part):
        if square not in terrain.changes.loaded:
            within = _within(terrain, square)
            terrain.changes.loaded[square] = terrain.heights[within.slices].copy(), terrain.holes_in(within)


def _within(terrain: Terrain, square: tuple[int, int]) -> Rectangle:
    """Return the part of a terrain that a square covers; squares at the edge are cut off."""
    row, column = (SQUARE * number for number in square)
    rows, columns = (min(SQUARE, count - at) for at, count in zip((row, column), terrain.heights.shape, strict=True))
    return Rectangle(row, column, rows, columns)


def as_loaded(terrain: Terrain, /) -> Iterator[tuple[Floats, Mask]]:
    """Yield heights and holes as loaded, in strips of `SQUARE` rows; of a ground that streams, three squares alone."""
    if terrain.blocks is not None:
        for square in ((0, 0), (-60, 40), (50, -70)):
            yield terrain.blocks.original_square(square)
        return
    touched: dict[int, list[tuple[int, tuple[Floats, Mask]]]] = {}
    for (number, column), before in terrain.changes.loaded.items():
        touched.setdefault(number, []).append((column * SQUARE, before))
    for number, row in enumerate(range(0, len(terrain.heights), SQUARE)):
        heights = terrain.heights[row : row + SQUARE]
        holes = terrain.holes_in(Rectangle(row, 0, *heights.shape))
        if number in touched:
            heights = heights.copy()
            for column, before in touched[number]:
                heights[:, column : column + SQUARE], holes[:, column : column + SQUARE] = before
        yield heights, holes


def changed_squares(terrain: Terrain, /) -> Squares:
    """Return the present heights and holes of the squares that have been changed."""
    squares = sorted(terrain.changes.loaded if terrain.blocks is None else terrain.blocks.changed)
    if terrain.blocks is None:
        parts = [_within(terrain, each) for each in squares]
        heights = [terrain.heights[part.slices].ravel() for part in parts]
        holes = [terrain.holes_in(part).ravel() for part in parts]
    else:
        now = [terrain.blocks.changed[each] for each in squares]
        heights, holes = [each.ravel() for each, _ in now], [each.ravel() for _, each in now]
    where = np.array(squares, np.int32).reshape(-1, 2)
    return where, np.concatenate([np.zeros(0, np.float32), *heights]), np.concatenate([np.zeros(0, np.bool_), *holes])


def changed_lies(terrain: Terrain, /) -> Floats:
    """Return samples of the changed squares of a ground that streams, as the function has it, (n, 16); of others none.

    They are in the order of `changed_squares`.
    """
    squares = [] if terrain.blocks is None else sorted(terrain.blocks.changed)
    return lies_at(terrain, squares)


def lies_at(terrain: Terrain, squares: Iterable[Sequence[int]], /) -> Floats:
    """Return samples of squares of a ground that streams, as its function has it [m], (n, 16)."""
    blocks = terrain.blocks
    found = [] if blocks is None else [blocks.lie((row, column)) for row, column in squares]
    return np.array(found, np.float32).reshape(-1, LIE)


def parts_of(terrain: Terrain, where: Ints, /) -> list[Rectangle]:
    """Return the parts of a terrain that does not stream which squares (n, 2) cover, by row and column."""
    return [_within(terrain, (row, column)) for row, column in where.tolist()]


def loaded_heights(terrain: Terrain, where: Ints, /) -> tuple[Floats, Mask]:
    """Return heights and holes of squares (n, 2) as they were loaded, in turn, each (m,); not of a streaming ground."""
    found = [
        terrain.changes.loaded.get((row, column), (terrain.heights[part.slices], terrain.holes_in(part)))
        for (row, column), part in zip(where.tolist(), parts_of(terrain, where), strict=True)
    ]
    heights, holes = ([each[which].ravel() for each in found] for which in (0, 1))
    return np.concatenate([np.zeros(0, np.float32), *heights]), np.concatenate([np.zeros(0, np.bool_), *holes])


def must_be_squares(terrain: Terrain, squares: Squares, /) -> None:
    """Raise ValueError for squares that cannot be `changed_squares` of a terrain."""
    where, heights, holes = squares
    streams = terrain.blocks is not None
    counts = np.ceil(np.divide(terrain.heights.shape if terrain.blocks is None else terrain.blocks.most, SQUARE))
    if ((where < -counts * streams) | (where >= counts)).any() or len({*map(tuple, where.tolist())}) != len(where):
        raise ValueError("a changed square of ground is off the terrain or comes twice")
    parts = parts_of(terrain, where)
    if streams:
        parts = [Rectangle(0, 0, SQUARE, SQUARE)] * len(where)
    due = sum(part.rows * part.columns for part in parts)
    if due != len(heights) or due != len(holes) or not (np.abs(heights) <= HIGHEST).all():
        raise ValueError("changed heights of the ground are too few, too many or too far from 0")


def _restore_blocks(blocks: Blocks, terrain: Terrain, squares: Squares) -> None:
    where, heights, holes = squares
    numbers = [(row, column) for row, column in where.tolist()]
    for square in {*blocks.changed}.difference(numbers):
        blocks.put(square, None)
        paste(blocks, terrain, square)
    for number, square in enumerate(numbers):
        own, shape = slice(number * SQUARE**2, (number + 1) * SQUARE**2), (SQUARE, SQUARE)
        blocks.put(square, (heights[own].reshape(shape).copy(), holes[own].reshape(shape).copy()))
        paste(blocks, terrain, square)


def restore_squares(terrain: Terrain, squares: Squares, lies: Floats | None = None, /) -> None:
    """Set these squares, and all other squares as they were loaded; `lies` are what `changed_lies` returned."""
    where, heights, holes = squares
    kept, at = {(row, column) for row, column in where.tolist()}, 0
    if terrain.blocks is not None:
        _restore_blocks(terrain.blocks, terrain, squares)
        if lies is not None and len(lies) == len(where):
            terrain.blocks.lies.update(zip(map(tuple, where.tolist()), lies, strict=True))
        return
    for square in [each for each in terrain.changes.loaded if each not in kept]:
        terrain.put(_within(terrain, square), *terrain.changes.loaded.pop(square))
    for row, column in where.tolist():
        part = _within(terrain, (row, column))
        _keep(terrain, part)
        end, shape = at + part.rows * part.columns, (part.rows, part.columns)
        terrain.put(part, heights[at:end].reshape(shape), holes[at:end].reshape(shape))
        at = end
