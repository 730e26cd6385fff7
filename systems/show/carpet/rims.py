"""Rims of cliffs: how far the ground is from the next one, so that its mesh is finer there."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Mask
from ....engine.terrain.part import Part
from ....engine.terrain.record import Terrain

SHARP = 0.4
"""By how much the slope falls off at a rim, from a cell of the terrain to the next [m/m]."""

MOST = 256
"""Squares along a side of the terrain at most in which rims are told apart."""

NOWHERE = 1e6
"""How far off a rim is where there is none [m]."""

NEARER = 0.3
"""What a metre from the eye counts at a rim, for how fine the mesh is there."""

GLSL = {"NEARER": NEARER}


class Rims:
    """How far places are from the next rim of a terrain, whatever it was before: changes are followed.

    Where the terrain becomes another window of its ground, they are those of the one that it was.
    """

    def __init__(self, terrain: Terrain) -> None:
        self.terrain, self._changes = terrain, terrain.changes.count
        self._first, self._low = terrain.first, np.array(terrain.origin)
        rows, columns = terrain.heights.shape
        each = -(-max(rows, columns) // MOST)
        self._each = each
        self._known: Mask = np.zeros((-(-rows // each), -(-columns // each)), np.bool_)
        self.far: Floats = np.full(self._known.shape, NOWHERE, np.float32)
        """How far the middle of each square is from the next one at least [m], row 0 at the far edge (-z)."""
        self.any = False
        """Whether there are any."""
        self.version = 0
        """A number that is another one whenever that has changed."""
        self._look(Part(0, 0, rows, columns))

    def belong(self, terrain: Terrain, /) -> None:
        """Be those of a terrain that has just become what they were made out of."""
        self.terrain, self._changes = terrain, terrain.changes.count

    def lie_over(self, origin: Floats, /) -> bool:
        """Return whether they are those of a window that begins at a place (x, z) [m]."""
        return self._first is None or bool((np.abs(self._low - origin) < 0.5 * self.terrain.cell).all())

    def follow(self) -> None:
        """Look where heights have changed."""
        changes = self.terrain.changes
        if self._changes == changes.count or self._first != self.terrain.first:
            return
        parts = changes.since(self._changes)
        whole = Part(0, 0, *self.terrain.heights.shape)
        for part in [whole] if parts is None else parts:
            if within := part.within(whole.rows, whole.columns):
                self._look(within)
        self._changes = changes.count

    def _look(self, part: Part) -> None:
        """Look again at the squares in which a part may have made or taken rims."""
        each = self._each
        rows, columns = (slice(max(some.start - 1, 0) // each, some.stop // each + 1) for some in part.slices)
        there = self._in(rows, columns)
        known = self._known[rows, columns]
        come, gone = np.argwhere(there & ~known) + np.array([rows.start, columns.start]), (known & ~there).any()
        if not (gone or len(come)):
            return
        self._known[rows, columns] = there
        if gone:
            self.far, come = np.full(self._known.shape, NOWHERE, np.float32), np.argwhere(self._known)
        if len(come):
            self.far = np.minimum(self.far, _far_from(come, self._known.shape, self._each * self.terrain.cell))
        self.any = bool(self._known.any())
        self.version += 1

    def _in(self, rows: slice, columns: slice) -> Mask:
        """Return which squares of some rows and columns of them have a rim in them."""
        each, (count, across) = self._each, self._known[rows, columns].shape
        top, left = rows.start * each, columns.start * each
        above, before = max(top - 1, 0), max(left - 1, 0)
        window = self.terrain.heights[above : top + count * each + 1, before : left + across * each + 1]
        row, column = np.nonzero(_sharp(window, self.terrain.cell))
        row, column = row + above - top, column + before - left
        inside = (row >= 0) & (column >= 0) & (row < count * each) & (column < across * each)
        found = np.zeros((count, across), np.bool_)
        found[row[inside] // each, column[inside] // each] = True
        return found

    def near_to(self, places: Doubles, eye: Doubles, /) -> Doubles:
        """Return how far off places (n, 2) count as, seen from an eye (2,), for the mesh of rims (n,) [m]."""
        low = self._low
        inside = np.clip(places, low, low + self.terrain.size)
        rows, columns = self.far.shape
        side = np.divide(self.terrain.size, (columns, rows))
        column, row = np.minimum((inside - low) / side, (columns - 1, rows - 1)).astype(np.intp).T
        away = np.linalg.norm(places - eye, axis=1)
        far = np.maximum(self.far[row, column] - side.max(), np.linalg.norm(places - inside, axis=1))
        return np.asarray((NEARER * away + far) / (1.0 + NEARER), np.float64)


def _sharp(heights: Floats, cell: float) -> Mask:
    found = np.zeros(heights.shape, np.bool_)
    inner = np.s_[1:-1], np.s_[:, 1:-1]
    for axis in (0, 1):
        if heights.shape[axis] > 2:
            found[inner[axis]] |= np.diff(heights, n=2, axis=axis) < np.float32(-SHARP * cell)
    return found


def _far_from(squares: NDArray[np.intp], shape: tuple[int, ...], side: float) -> Floats:
    """Return how far squares (rows, columns) of a side [m] are from the nearest of some (n, 2) at least."""
    rows, columns = (np.arange(count, dtype=np.float32) for count in shape)
    theirs = np.unique(squares[:, 0])
    own = [squares[squares[:, 0] == row, 1] for row in theirs]
    across = np.stack([np.abs(columns[:, None] - each).min(axis=1) for each in own]) ** 2
    square = np.stack([(across + ((row - theirs) ** 2)[:, None]).min(axis=0) for row in rows])
    return np.asarray(np.maximum(np.sqrt(square) - 2.0, 0.0) * side, np.float32)
