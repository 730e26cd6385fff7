"""Holes of a terrain, and a fast test of which rectangles of ground touch an edge."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Mask
from ....engine.terrain.record import Terrain
from ....engine.terrain.rectangle import Rectangle

MOST_BLOCKS = 1024
"""Largest number of blocks along a side of a map."""


class Rectangles(NamedTuple):
    """Rectangles of ground, by their bounds [m]: arrays of shapes that broadcast."""

    low_x: Doubles
    high_x: Doubles
    low_z: Doubles
    high_z: Doubles


class Blocks:
    """Blocks of a terrain with an edge, as a summed-area table: a test takes as long for rectangles of any size."""

    def __init__(self, uneven: Mask, corner: Floats | Doubles, side: Floats | Doubles) -> None:
        """Take blocks (rows, columns) of sides (x, z) [m]; `corner` (x, z) is that of block (0, 0)."""
        self._corner, self._side = np.asarray(corner, np.float64), np.asarray(side, np.float64)
        self._sums: NDArray[np.int32] = np.zeros(np.add(uneven.shape, 1), np.int32)
        self._sums[1:, 1:] = uneven.cumsum(axis=0, dtype=np.int32).cumsum(axis=1, dtype=np.int32)

    def touch(self, rectangles: Rectangles) -> Mask:
        """Return which rectangles touch a block with an edge, in their common shape."""
        rows, columns = self._sums.shape
        left, right, top, bottom = (
            np.clip(rounded((bound - self._corner[axis]) / self._side[axis]).astype(np.intp), 0, count - 1)
            for bound, rounded, axis, count in zip(
                rectangles, (np.floor, np.ceil) * 2, (0, 0, 1, 1), (columns, columns, rows, rows), strict=True
            )
        )
        sums, top, bottom = self._sums.reshape(-1), columns * top, columns * bottom
        inside = sums.take(bottom + right) - sums.take(top + right) - sums.take(bottom + left) + sums.take(top + left)
        return np.asarray(inside > 0)


class Holes:
    """The holes of a terrain, as blocks that contain or adjoin one; changes of the terrain are followed."""

    def __init__(self, terrain: Terrain) -> None:
        self._open = np.zeros((0, 0), np.bool_)
        self._blocks: Blocks | None = None
        self._terrain, self._first, self._changes = terrain, terrain.first, terrain.changes.count
        if terrain.holes is not None:
            self._update(terrain, terrain.holes, None)

    def match(self, terrain: Terrain, /) -> bool:
        """Return whether these are the holes of a terrain in its present window."""
        return self._terrain is terrain and self._first == terrain.first

    def attach(self, terrain: Terrain, /) -> None:
        """Follow the changes of a terrain that has just taken over the heights these were computed from."""
        self._terrain, self._changes = terrain, terrain.changes.count

    def touch(self, rectangles: Rectangles) -> Mask:
        """Return which rectangles touch a block with a hole, or one beside it, in their common shape."""
        terrain = self._terrain
        if terrain.holes is not None and self._changes != terrain.changes.count:
            self._update(terrain, terrain.holes, terrain.changes.since(self._changes))
        self._changes = terrain.changes.count
        return np.zeros((), np.bool_) if self._blocks is None else self._blocks.touch(rectangles)

    def _update(self, terrain: Terrain, holes: Mask, changed: list[Rectangle] | None) -> None:
        rows, columns = holes.shape
        samples = -(-max(rows, columns) // MOST_BLOCKS)
        if changed is None or not self._open.size:
            changed = [Rectangle(0, 0, rows, columns)]
            self._open = np.zeros((-(-rows // samples), -(-columns // samples)), np.bool_)
        for part in changed:
            first, last = part.row // samples, (part.row + part.rows - 1) // samples + 1
            left, right = part.column // samples, (part.column + part.columns - 1) // samples + 1
            within = holes[first * samples : last * samples, left * samples : right * samples]
            starts = [np.arange(0, count, samples) for count in within.shape]
            found = np.logical_or.reduceat(np.logical_or.reduceat(within, starts[0], axis=0), starts[1], axis=1)
            self._open[first:last, left:right] = found
        if not self._open.any():
            self._blocks = None
            return
        side = samples * terrain.cell  # dilated, as a hole reaches half a cell beyond its samples
        self._blocks = Blocks(_dilated(self._open), np.array(terrain.origin), np.array([side, side]))


def _dilated(mask: Mask) -> Mask:
    """Return a mask grown by one block on all sides, diagonals included."""
    wide = mask.copy()
    for axis in (0, 1):
        low, high = (np.s_[:-1], np.s_[1:]) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
        before = wide.copy()
        wide[low] |= before[high]
        wide[high] |= before[low]
    return wide
