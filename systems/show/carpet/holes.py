"""Holes of a terrain, and stretches of ground that have something uneven."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Mask
from ....engine.terrain.part import Part
from ....engine.terrain.record import Terrain

MOST_BLOCKS = 1024
"""Blocks along a side of a map at most."""


class Stretches(NamedTuple):
    """Rectangles of ground, by where they begin and end [m]: arrays of shapes that go together."""

    low_x: Doubles
    high_x: Doubles
    low_z: Doubles
    high_z: Doubles


class Blocks:
    """Which blocks of a terrain have an edge, summed up, so that stretches of any size are asked alike."""

    def __init__(self, uneven: Mask, corner: Floats | Doubles, side: Floats | Doubles) -> None:
        """Take blocks (rows, columns), the first of them at a corner (x, z), with sides along x and z [m]."""
        self._corner, self._side = np.asarray(corner, np.float64), np.asarray(side, np.float64)
        self._sums: NDArray[np.int32] = np.zeros(np.add(uneven.shape, 1), np.int32)
        self._sums[1:, 1:] = uneven.cumsum(axis=0, dtype=np.int32).cumsum(axis=1, dtype=np.int32)

    def touch(self, stretches: Stretches) -> Mask:
        """Return which stretches touch a block with an edge, of the shape that they have together."""
        rows, columns = self._sums.shape
        left, right, top, bottom = (
            np.clip(to((each - self._corner[axis]) / self._side[axis]).astype(np.intp), 0, count - 1)
            for each, to, axis, count in zip(
                stretches, (np.floor, np.ceil) * 2, (0, 0, 1, 1), (columns, columns, rows, rows), strict=True
            )
        )
        sums, top, bottom = self._sums.reshape(-1), columns * top, columns * bottom
        inside = sums.take(bottom + right) - sums.take(top + right) - sums.take(bottom + left) + sums.take(top + left)
        return np.asarray(inside > 0)


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

    def touch(self, stretches: Stretches) -> Mask:
        """Return which stretches touch a block with a hole in it, of the shape that they have together."""
        terrain = self._terrain
        if terrain.holes is not None and self._changes != terrain.changes.count:
            self._look(terrain, terrain.holes, terrain.changes.since(self._changes))
        self._changes = terrain.changes.count
        return np.zeros((), np.bool_) if self._blocks is None else self._blocks.touch(stretches)

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
