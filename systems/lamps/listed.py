"""Grid over the ground with a list of lamps or shades for each cell, so that shaders look at few of them."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Doubles, Floats, Rows
from ...engine.pair import cells_between

SIDE = 64
"""Largest number of cells along a side of the grid."""

MOST_ENTRIES = 2**15
"""Largest number of entries in all lists together: cells grow until they fit."""

SMALLEST = 1.0
"""Smallest side of a cell [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """A grid of square cells, row by row, with the lists of things that reach each."""

    corner: tuple[float, float]
    """Corner of the first cell (x, z) [m]."""

    cell: float
    """Side of a cell [m]."""

    side: int
    """Number of cells along a side of the grid."""

    first: Rows
    """Start of each cell's list in `things`, shape (side * side,)."""

    count: Rows
    """Length of each cell's list, shape (side * side,)."""

    things: Rows
    """All lists, concatenated: indices of things."""


def grid_of(low: Floats | Doubles, high: Floats | Doubles, reach: Floats | Doubles, /) -> Grid:
    """Sort things into the cells of a grid.

    A thing reaches all places within `reach` (n,) [m] of its rectangle, which has the corners `low` and `high` (n, 2)
    [m].
    """
    lowest, highest, far = low.astype(np.float64), high.astype(np.float64), reach.astype(np.float64)[:, None]
    corner = (lowest - far).min(axis=0)
    extent = float(((highest + far).max(axis=0) - corner).max())
    cell = max(extent / SIDE, SMALLEST)
    while np.sum(np.prod((highest - lowest + 2.0 * far) / cell + 2.0, axis=1)) > MOST_ENTRIES and cell < extent:
        cell *= 1.25
    side = max(int(np.ceil(extent / cell)), 1)
    things, cells = _reached_cells(lowest - corner, highest - corner, far, cell, side)
    count = np.bincount(cells, minlength=side * side)
    order = np.argsort(cells, kind="stable")
    return Grid((float(corner[0]), float(corner[1])), cell, side, np.cumsum(count) - count, count, things[order])


def _reached_cells(low: Doubles, high: Doubles, reach: Doubles, cell: float, side: int) -> tuple[Rows, Rows]:
    """Return all pairs of a thing and a cell it reaches, (m,) and (m,); positions count from the grid's corner."""
    first = np.clip(np.floor((low - reach) / cell).astype(np.int32), 0, side - 1)
    last = np.clip(np.floor((high + reach) / cell).astype(np.int32), 0, side - 1)
    thing, column, row = cells_between(first, last)
    place = np.stack([column, row], axis=1)
    distance = np.maximum(np.maximum(place * cell - high[thing], low[thing] - (place + 1) * cell), 0.0)
    reached = np.square(distance).sum(axis=1) < np.square(reach[thing, 0])
    return thing[reached], (row * side + column)[reached]
