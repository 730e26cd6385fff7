"""Holes of a terrain, and squares of ground that have something uneven."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Mask
from ....engine.terrain.part import Part
from ....engine.terrain.record import Terrain

MOST_BLOCKS = 1024
"""Blocks along a side of a map at most."""


class Blocks:
    """Which blocks of a terrain have an edge, summed up, so that squares of any size are asked alike."""

    def __init__(self, uneven: Mask, corner: Floats | Doubles, side: Floats | Doubles) -> None:
        """Take blocks (rows, columns), the first of them at a corner (x, z), with sides along x and z [m]."""
        self._corner, self._side = np.asarray(corner, np.float64), np.asarray(side, np.float64)
        self._sums: NDArray[np.int32] = np.zeros(np.add(uneven.shape, 1), np.int32)
        self._sums[1:, 1:] = uneven.cumsum(axis=0, dtype=np.int32).cumsum(axis=1, dtype=np.int32)

    def touch(self, squares: Doubles) -> Mask:
        """Return which squares (n, 3) touch a block with an edge, shape (n,)."""
        rows, columns = self._sums.shape
        low = (squares[:, :2] - self._corner) / self._side
        high = np.ceil(low + squares[:, 2:3] / self._side).astype(np.int64)
        low = np.floor(low).astype(np.int64)
        (left, top), (right, bottom) = (np.clip(each, 0, (columns - 1, rows - 1)).T for each in (low, high))
        sums = self._sums
        return np.asarray(sums[bottom, right] - sums[top, right] - sums[bottom, left] + sums[top, left] > 0)


class Holes:
    """The edges of a terrain's holes: all that is drawn near one knows of it."""

    def __init__(self, terrain: Terrain) -> None:
        self._open = np.zeros((0, 0), np.bool_)
        self._blocks: Blocks | None = None
        self._terrain, self._first, self._changes = terrain, terrain.first, terrain.changes.count
        if terrain.holes is not None:
            self._look(terrain, terrain.holes, None)

    def are_of(self, terrain: Terrain, /) -> bool:
        """Return whether they are those of a terrain, as the window that it is now."""
        return self._terrain is terrain and self._first == terrain.first

    def belong(self, terrain: Terrain, /) -> None:
        """Be those of a terrain that has just become what they were made out of."""
        self._terrain, self._changes = terrain, terrain.changes.count

    def touch(self, squares: Doubles) -> Mask:
        """Return which squares (n, 3) touch a block of the terrain with a hole in it, shape (n,)."""
        terrain = self._terrain
        if terrain.holes is not None and self._changes != terrain.changes.count:
            self._look(terrain, terrain.holes, terrain.changes.since(self._changes))
        self._changes = terrain.changes.count
        return np.zeros(len(squares), np.bool_) if self._blocks is None else self._blocks.touch(squares)

    def _look(self, terrain: Terrain, holes: Mask, changed: list[Part] | None) -> None:
        rows, columns = holes.shape
        each = -(-max(rows, columns) // MOST_BLOCKS)
        if changed is None or not self._open.size:
            changed = [Part(0, 0, rows, columns)]
            self._open = np.zeros((-(-rows // each), -(-columns // each)), np.bool_)
        for part in changed:
            first, last = part.row // each, (part.row + part.rows - 1) // each + 1
            left, right = part.column // each, (part.column + part.columns - 1) // each + 1
            within = holes[first * each : last * each, left * each : right * each]
            starts = [np.arange(0, count, each) for count in within.shape]
            found = np.logical_or.reduceat(np.logical_or.reduceat(within, starts[0], axis=0), starts[1], axis=1)
            self._open[first:last, left:right] = found
        if not self._open.any():
            self._blocks = None
            return
        side = each * terrain.cell  # a hole goes on half a cell beyond its samples
        self._blocks = Blocks(_widened(self._open), np.array(terrain.origin), np.array([side, side]))


def _widened(mask: Mask) -> Mask:
    """Return a mask with what is beside it, before and behind it."""
    wide = mask.copy()
    for axis in (0, 1):
        low, high = (np.s_[:-1], np.s_[1:]) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
        before = wide.copy()
        wide[low] |= before[high]
        wide[high] |= before[low]
    return wide
