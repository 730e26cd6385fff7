"""What reaches which cells of the ground, lamps and shades: so a place need look at few of them."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Doubles, Floats, Rows

SIDE = 64
"""Cells along a side of the square that they reach, at most."""

ROOM = 2**15
"""Numbers of things that the lists have room for: where more would be in them, cells are larger."""

SMALLEST = 1.0
"""Side of a cell at least [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Listed:
    """Square cells of the ground, row by row, and what reaches each."""

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

    things: Rows
    """The lists, one after another: numbers of things."""


def listed(low: Floats | Doubles, high: Floats | Doubles, reach: Floats | Doubles, /) -> Listed:
    """Return the cells that things reach.

    They lie over rectangles from corners (n, 2) to corners (n, 2) [m], and reach so far beyond (n,) [m].
    """
    lowest, highest, far = low.astype(np.float64), high.astype(np.float64), reach.astype(np.float64)[:, None]
    corner = (lowest - far).min(axis=0)
    extent = float(((highest + far).max(axis=0) - corner).max())
    cell = max(extent / SIDE, SMALLEST)
    while np.sum(np.prod((highest - lowest + 2.0 * far) / cell + 2.0, axis=1)) > ROOM and cell < extent:
        cell *= 1.25
    side = max(int(np.ceil(extent / cell)), 1)
    things, cells = _meeting(lowest - corner, highest - corner, far, cell, side)
    count = np.bincount(cells, minlength=side * side)
    order = np.argsort(cells, kind="stable")
    return Listed((float(corner[0]), float(corner[1])), cell, side, np.cumsum(count) - count, count, things[order])


def _meeting(low: Doubles, high: Doubles, reach: Doubles, cell: float, side: int) -> tuple[Rows, Rows]:
    """Return each thing and each cell that it reaches, (m,) and (m,); places are from the first cell's corner."""
    first = np.clip(np.floor((low - reach) / cell).astype(np.int64), 0, side - 1)
    last = np.clip(np.floor((high + reach) / cell).astype(np.int64), 0, side - 1)
    wide, deep = (last - first + 1).T
    thing = np.repeat(np.arange(len(reach)), wide * deep)
    number = np.arange(len(thing)) - np.repeat(np.cumsum(wide * deep) - wide * deep, wide * deep)
    at = first[thing] + np.stack([number % wide[thing], number // wide[thing]], axis=1)
    apart = np.maximum(np.maximum(at * cell - high[thing], low[thing] - (at + 1) * cell), 0.0)
    meets = np.square(apart).sum(axis=1) < np.square(reach[thing, 0])
    return thing[meets], (at[:, 1] * side + at[:, 0])[meets]
