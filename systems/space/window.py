"""Cells of ground positions, and the square window of cells around a viewer, which wraps round."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.arrays import Floats, Ints, Mask
from ...engine.handed import FARTHEST, as_floats


def as_places(xz: ArrayLike, /) -> Floats:
    """Return ground positions (x, z) [m] as an array of shape (n, 2); raises ValueError for anything else.

    An empty list gives shape (0, 2). Coordinates are clamped to `FARTHEST`.
    """
    due = "ground positions are finite (x, z) pairs, one in each row"
    places = as_floats(xz, due)
    if places.shape[-1:] != (2,) and places.shape != (0,):
        raise ValueError(f"{due}, not an array of shape {places.shape}")
    return np.ascontiguousarray(places.reshape(-1, 2).clip(-FARTHEST, FARTHEST))


def cell_of(place: NDArray[np.floating], /, *, patch: float) -> Ints:
    """Return the cells (i, j) of ground positions (x, z), both of shape (..., 2)."""
    return np.floor(np.asarray(place, np.float64) / patch).astype(np.int32)


def between(cell: Ints, first: Ints, last: Ints, /) -> Mask:
    """Return which cells (n, 2) lie in the rectangle from the cell `first` to the cell `last`, shape (n,)."""
    i, j = cell.T
    return np.asarray((i >= first[0]) & (i <= last[0]) & (j >= first[1]) & (j <= last[1]))


def window_rows(cell: Ints, /, *, side: int) -> NDArray[np.int64]:
    """Return the row of each cell (n, 2) in a window of `side` by `side` that wraps round, shape (n,)."""
    i, j = cell.T
    rows: NDArray[np.int64] = (j % side * side + i % side).astype(np.int64)
    return rows


def window_cells(centre: Ints, /, *, side: int) -> Ints:
    """Return the cell at each row of a window around `centre`, shape (side * side, 2)."""
    low = np.asarray(centre, np.int64) - side // 2
    line = np.arange(side, dtype=np.int64)
    i, j = (corner + np.mod(line - corner, side) for corner in low)
    cells = np.empty((side, side, 2), np.int32)
    cells[..., 0], cells[..., 1] = i, j[:, None]
    return cells.reshape(-1, 2)
