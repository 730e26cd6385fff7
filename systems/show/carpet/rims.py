"""Rims of cliffs, and the distance of the ground from the nearest: its mesh is finer there."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Mask
from ....engine.terrain.record import Terrain
from ....engine.terrain.rectangle import Rectangle

SHARP = 0.4
"""Smallest decrease of the slope at a rim, from one cell of the terrain to the next [m/m]."""

MOST = 256
"""Largest number of squares along a side of the terrain; rims are known by square."""

NOWHERE = 1e6
"""Distance of a terrain without rims from the nearest rim [m]."""

NEARER = 0.3
"""Weight of the distance from the eye in `mesh_distance`; the distance from the rim has weight 1."""

GLSL = {"NEARER": NEARER}


class Rims:
    """Distances from the rims of a terrain; its changes are followed.

    Once the terrain has become another window of its ground, these are still the rims of the old one.
    """

    def __init__(self, terrain: Terrain) -> None:
        self.terrain, self._changes = terrain, terrain.changes.count
        self._first, self._low = terrain.first, np.array(terrain.origin)
        rows, columns = terrain.heights.shape
        step = -(-max(rows, columns) // MOST)
        self._step = step
        """Cells of the terrain along a side of a square."""
        self._has_rim: Mask = np.zeros((-(-rows // step), -(-columns // step)), np.bool_)
        self.distance: Floats = np.full(self._has_rim.shape, NOWHERE, np.float32)
        """Lower bound of the distance of each square's middle from the nearest rim [m], row 0 at the far edge (-z)."""
        self.any = False
        """Whether the terrain has rims."""
        self.version = 0
        """Number of changes of `distance`."""
        self._update(Rectangle(0, 0, rows, columns))

    def attach(self, terrain: Terrain, /) -> None:
        """Follow the changes of a terrain that has just taken over the heights these were computed from."""
        self.terrain, self._changes = terrain, terrain.changes.count

    def begin_at(self, origin: Floats, /) -> bool:
        """Return whether these are the rims of a window that begins at a place (x, z) [m]."""
        return self._first is None or bool((np.abs(self._low - origin) < 0.5 * self.terrain.cell).all())

    def follow(self) -> None:
        """Update the squares whose heights have changed."""
        changes = self.terrain.changes
        if self._changes == changes.count or self._first != self.terrain.first:
            return
        parts = changes.since(self._changes)
        whole = Rectangle(0, 0, *self.terrain.heights.shape)
        for part in [whole] if parts is None else parts:
            if within := part.within(whole.rows, whole.columns):
                self._update(within)
        self._changes = changes.count

    def _update(self, part: Rectangle) -> None:
        """Search the squares whose rims the heights of a part may have changed."""
        step = self._step
        rows, columns = (slice(max(span.start - 1, 0) // step, span.stop // step + 1) for span in part.slices)
        found = self._find(rows, columns)
        known = self._has_rim[rows, columns]
        added, gone = np.argwhere(found & ~known) + np.array([rows.start, columns.start]), (known & ~found).any()
        if not (gone or len(added)):
            return
        self._has_rim[rows, columns] = found
        if gone:
            self.distance, added = np.full(self._has_rim.shape, NOWHERE, np.float32), np.argwhere(self._has_rim)
        if len(added):
            distance = _distance_from(added, self._has_rim.shape, self._step * self.terrain.cell)
            self.distance = np.minimum(self.distance, distance)
        self.any = bool(self._has_rim.any())
        self.version += 1

    def _find(self, rows: slice, columns: slice) -> Mask:
        """Return which of these rows and columns of squares have a rim."""
        step, (count, across) = self._step, self._has_rim[rows, columns].shape
        top, left = rows.start * step, columns.start * step
        above, before = max(top - 1, 0), max(left - 1, 0)
        window = self.terrain.heights[above : top + count * step + 1, before : left + across * step + 1]
        row, column = np.nonzero(_rim_cells(window, self.terrain.cell))
        row, column = row + above - top, column + before - left
        inside = (row >= 0) & (column >= 0) & (row < count * step) & (column < across * step)
        found = np.zeros((count, across), np.bool_)
        found[row[inside] // step, column[inside] // step] = True
        return found

    def mesh_distance(self, places: Doubles, eye: Doubles, /) -> Doubles:
        """Return the distance that sets the mesh at places (n, 2) near rims, shape (n,) [m].

        It is a weighted mean of the distances from the eye (2,) and from the nearest rim.
        """
        low = self._low
        inside = np.clip(places, low, low + self.terrain.size)
        rows, columns = self.distance.shape
        side = np.divide(self.terrain.size, (columns, rows))
        column, row = np.minimum((inside - low) / side, (columns - 1, rows - 1)).astype(np.intp).T
        away = np.linalg.norm(places - eye, axis=1)
        from_rim = np.maximum(self.distance[row, column] - side.max(), np.linalg.norm(places - inside, axis=1))
        return np.asarray((NEARER * away + from_rim) / (1.0 + NEARER), np.float64)


def _rim_cells(heights: Floats, cell: float) -> Mask:
    """Return at which samples (rows, columns) the slope falls off by more than `SHARP`; `cell` is their spacing [m]."""
    found = np.zeros(heights.shape, np.bool_)
    inner = np.s_[1:-1], np.s_[:, 1:-1]
    for axis in (0, 1):
        if heights.shape[axis] > 2:
            found[inner[axis]] |= np.diff(heights, n=2, axis=axis) < np.float32(-SHARP * cell)
    return found


def _distance_from(chosen: NDArray[np.intp], shape: tuple[int, ...], side: float) -> Floats:
    """Return a lower bound of the distance [m] of squares (rows, columns) of a side [m] from the nearest chosen one.

    `chosen` (n, 2) has rows and columns.
    """
    rows, columns = (np.arange(count, dtype=np.float32) for count in shape)
    chosen_rows = np.unique(chosen[:, 0])
    chosen_columns = [chosen[chosen[:, 0] == row, 1] for row in chosen_rows]
    across = np.stack([np.abs(columns[:, None] - own).min(axis=1) for own in chosen_columns]) ** 2
    square = np.stack([(across + ((row - chosen_rows) ** 2)[:, None]).min(axis=0) for row in rows])
    return np.asarray(np.maximum(np.sqrt(square) - 2.0, 0.0) * side, np.float32)
