"""Which lamps shine on which cells of the ground: so a place need look at few of them."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Doubles, Floats, Rows

SIDE = 64
"""Cells along a side of the square that lamps shine on, at most."""

ROOM = 2**15
"""Numbers of lamps that the lists have room for: where more would be in them, cells are larger."""

SMALLEST = 1.0
"""Side of a cell at least [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Listed:
    """Square cells of the ground, row by row, and the lamps that shine on each."""

    corner: tuple[float, float]
    """Of the first cell (x, z) [m]."""

    cell: float
    """Side of a cell [m]."""

    side: int
    """Cells along a side of the whole."""

    first: Rows
    """Where each cell's list begins, (side * side,)."""

    count: Rows
    """How long it is, (side * side,)."""

    lamps: Rows
    """The lists, one after another: numbers of lamps."""


def listed(place: Floats, reach: Floats, /) -> Listed:
    """Return the cells that lamps shine on which stand over places (n, 2) [m] and reach so far (n,) [m]."""
    middle, far = place.astype(np.float64), reach.astype(np.float64)
    low = (middle - far[:, None]).min(axis=0)
    extent = float(((middle + far[:, None]).max(axis=0) - low).max())
    cell = max(extent / SIDE, SMALLEST)
    while np.sum((2.0 * far / cell + 2.0) ** 2) > ROOM and cell < extent:
        cell *= 1.25
    side = max(int(np.ceil(extent / cell)), 1)
    lamps, cells = _meeting(middle - low, far, cell, side)
    count = np.bincount(cells, minlength=side * side)
    order = np.argsort(cells, kind="stable")
    return Listed((float(low[0]), float(low[1])), cell, side, np.cumsum(count) - count, count, lamps[order])


def _meeting(middle: Doubles, reach: Doubles, cell: float, side: int) -> tuple[Rows, Rows]:
    """Return each lamp and each cell that it shines on, (m,) and (m,); `middle` is from the first cell's corner."""
    first = np.clip(np.floor((middle - reach[:, None]) / cell).astype(np.int64), 0, side - 1)
    last = np.clip(np.floor((middle + reach[:, None]) / cell).astype(np.int64), 0, side - 1)
    wide, deep = (last - first + 1).T
    lamp = np.repeat(np.arange(len(reach)), wide * deep)
    number = np.arange(len(lamp)) - np.repeat(np.cumsum(wide * deep) - wide * deep, wide * deep)
    at = first[lamp] + np.stack([number % wide[lamp], number // wide[lamp]], axis=1)
    near = np.clip(middle[lamp], at * cell, (at + 1) * cell)
    meets = np.square(near - middle[lamp]).sum(axis=1) < np.square(reach[lamp])
    return lamp[meets], (at[:, 1] * side + at[:, 0])[meets]
