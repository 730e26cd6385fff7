"""The map of how high grass is left to stand, and what is cut on it."""

from math import isnan
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Mask
from ...components.footprint import Footprint
from ...components.pose import Pose
from ...engine.terrain.record import Terrain
from ..space.polygon import in_polygon

Number = TypeVar("Number", np.float32, np.int64)

CELL = 0.2
"""Side of a cell of the map, if the terrain is small enough [m]."""

MOST_CELLS = 2048
"""Cells along a side of the map at most: of a terrain of more than 400 m they are larger."""

LEAST = 0.75
"""A footprint counts as at least so wide, in cells: half the diagonal of one, and a little."""


class Mown:
    """How high grass stands at most, over a terrain; there is no map until something is cut."""

    def __init__(self, terrain: Terrain) -> None:
        self._lay(terrain)

    def _lay(self, terrain: Terrain) -> None:
        width, depth = terrain.size
        self.origin: tuple[float, float] = terrain.origin
        self.shape = (_cells(depth), _cells(width))
        """Rows and columns of the map."""
        self.cell = width / self.shape[1], depth / self.shape[0]
        """Sides of a cell along x and z [m]."""
        self.heights: Floats | None = None
        """Up to which height blades are left [m], row 0 at the far edge; infinite where nothing is cut."""
        self.changed: NDArray[np.int64] = np.zeros(self.shape[0], np.int64)
        """The number of the stroke that changed each row last, shape (rows,)."""
        self._tops: _Tops | None = None

    @property
    def strokes(self) -> int:
        """The number of the last stroke that changed anything; 0 while all is as it grew."""
        return int(self.changed.max())

    def cut(self, footprint: Footprint, height: float, pose: Pose) -> None:
        """Let nothing stand higher than `height` [m] under a footprint.

        Raises TypeError for what is no footprint, height or pose, ValueError for a negative height and for a pose that
        is not finite.
        """
        self._stroke("cut", footprint, height, pose)

    def grow(self, footprint: Footprint, height: float, pose: Pose) -> None:
        """Let what was cut under a footprint stand up to `height` [m] again; raises the errors of `cut`."""
        self._stroke("grown", footprint, height, pose)

    def tops(self, cells: NDArray[np.int32], *, patch: float) -> Floats:
        """Return up to which height the highest grass is left on patches of a side [m], shape (n,).

        `cells` (n, 2) are theirs; grass is not cut beyond the terrain.
        """
        if self.heights is None:
            return np.full(len(cells), np.inf, np.float32)
        if self._tops is None or self._tops.patch != patch:
            self._tops = _Tops(self, patch)
        return self._tops.of(self, cells)

    def at(self, place: Floats) -> Floats:
        """Return up to which height grass is left at ground positions (n, 2) [m], shape (n,); infinite where uncut."""
        left = np.full(len(place), np.inf, np.float32)
        if self.heights is not None:
            cell = np.floor((place.astype(np.float64) - self.origin) / self.cell).astype(np.int64)
            on = ((cell >= 0) & (cell < self.shape[::-1])).all(axis=1)
            left[on] = self.heights[cell[on, 1], cell[on, 0]]
        return left

    def resume(self, heights: Floats | None) -> None:
        """Let just this be cut, of the map's shape [m]; None is nothing."""
        if heights is None and self.heights is None:
            return
        strokes, self.heights = self.strokes, np.full(self.shape, np.inf, np.float32) if heights is None else heights
        self.changed[:] = strokes + 1

    def change(self, terrain: Terrain) -> None:
        """Take over another terrain: what was cut at a place stays cut there."""
        if (terrain.origin, (_cells(terrain.size[1]), _cells(terrain.size[0]))) == (self.origin, self.shape):
            return
        before, origin, cell, strokes = self.heights, self.origin, self.cell, self.strokes
        self._lay(terrain)
        if before is None:
            return
        x, z = self._middles(0, self.shape[1], 0), self._middles(0, self.shape[0], 1)
        row, column = np.floor((z - origin[1]) / cell[1]), np.floor((x - origin[0]) / cell[0])
        row, column = row.astype(np.int64), column.astype(np.int64)
        here = np.ix_((row >= 0) & (row < before.shape[0]), (column >= 0) & (column < before.shape[1]))
        self.heights = np.full(self.shape, np.inf, np.float32)
        self.heights[here] = before[np.ix_(row[here[0].ravel()], column[here[1].ravel()])]
        self.changed[:] = strokes + 1

    def _stroke(self, done: str, footprint: Footprint, height: float, pose: Pose) -> None:
        _check(done, footprint, height, pose)
        if self.heights is None and done == "grown":
            return
        rows, columns = self._around(footprint, pose)
        if rows.start >= rows.stop or columns.start >= columns.stop:
            return
        if self.heights is None:
            self.heights = np.full(self.shape, np.inf, np.float32)
        x, z = self._middles(columns.start, columns.stop, 0), self._middles(rows.start, rows.stop, 1)
        place = np.stack(np.meshgrid(x, z), axis=-1).reshape(-1, 2)
        under = inside(footprint, pose, place, least=LEAST * max(self.cell)).reshape(len(z), len(x))
        before = self.heights[rows, columns]
        asked = np.float32(height)
        after = np.where(under, np.minimum(before, asked) if done == "cut" else np.maximum(before, asked), before)
        touched = (after != before).any(axis=1)
        self.heights[rows, columns] = after
        self.changed[rows][touched] = self.strokes + 1

    def _around(self, footprint: Footprint, pose: Pose) -> tuple[slice, slice]:
        """Return the rows and columns whose cells a footprint may reach."""
        round_one = footprint.radius + footprint.length / 2
        reach = max((float(np.hypot(*corner)) for corner in footprint.corners), default=round_one)
        reach += LEAST * max(self.cell)
        found = []
        for axis, count in ((1, self.shape[0]), (0, self.shape[1])):
            middle = ((pose.x, pose.z)[axis] - self.origin[axis]) / self.cell[axis]
            far = reach / self.cell[axis]
            low, high = (int(np.clip(end, 0, count)) for end in (np.floor(middle - far), np.ceil(middle + far)))
            found.append(slice(low, high))
        return found[0], found[1]

    def _middles(self, first: int, last: int, axis: int) -> Floats:
        """Return where the middles of some cells are along an axis [m]."""
        return np.asarray(self.origin[axis] + (np.arange(first, last) + 0.5) * self.cell[axis], np.float32)


class _Tops:
    """The highest grass that is left on each patch of the terrain, made out anew where strokes have changed it."""

    def __init__(self, mown: Mown, patch: float) -> None:
        self.patch = patch
        first_x, self._columns = _cells_of_patches(mown.origin[0], mown.cell[0], mown.shape[1], patch)
        first_z, self._rows = _cells_of_patches(mown.origin[1], mown.cell[1], mown.shape[0], patch)
        self._first = first_x, first_z
        self._highest = np.full((len(self._rows), len(self._columns)), np.inf, np.float32)
        self._strokes = 0

    def of(self, mown: Mown, cells: NDArray[np.int32]) -> Floats:
        """Return the highest of patches (n, 2), shape (n,)."""
        if mown.heights is not None and mown.strokes != self._strokes:
            stale = _greatest(mown.changed, self._rows) > self._strokes
            for row in np.flatnonzero(stale).tolist():
                highest = mown.heights[slice(*self._rows[row])].max(axis=0)
                self._highest[row] = _greatest(highest, self._columns)
            self._strokes = mown.strokes
        at = cells - self._first
        on = ((at >= 0) & (at < self._highest.shape[::-1])).all(axis=1)
        found = np.full(len(cells), np.inf, np.float32)
        found[on] = self._highest[at[on, 1], at[on, 0]]
        return found


def _cells_of_patches(origin: float, cell: float, count: int, patch: float) -> tuple[int, NDArray[np.intp]]:
    """Return the number of the first patch along an axis, and from which cell to before which each has, (patches, 2).

    Those are the cells whose middles are on the patch; where cells are larger than patches, the one that it is in.
    """
    first = int(np.floor(origin / patch))
    border = (np.arange(first, int(np.ceil((origin + count * cell) / patch)) + 1) * patch - origin) / cell
    within = np.floor(0.5 * (border[:-1] + border[1:]))
    from_, to = np.minimum(np.ceil(border[:-1] - 0.5), within), np.maximum(np.ceil(border[1:] - 0.5), within + 1.0)
    ends = np.stack([np.clip(from_, 0, count - 1), np.clip(to, 1, count)], axis=1)
    return first, ends.astype(np.intp)


def _greatest(values: NDArray[Number], ends: NDArray[np.intp]) -> NDArray[Number]:
    """Return the greatest of the values (n,) from each first end to before the second, (m, 2), shape (m,)."""
    padded = np.append(values, values[-1:])  # an end may be the end of all
    return np.asarray(np.maximum.reduceat(padded, ends.ravel())[::2])


def inside(footprint: Footprint, pose: Pose, place: Floats, /, *, least: float = 0.0) -> Mask:
    """Return which ground positions (n, 2) [m] lie under a footprint, shape (n,); a round one is `least` [m] wide."""
    own = pose.inside(place)
    if footprint.corners:
        return in_polygon(own, np.array(footprint.corners, np.float32))
    half = np.float32(footprint.length / 2)
    off = np.hypot(own[:, 0], own[:, 1] - np.clip(own[:, 1], -half, half))
    return np.asarray(off <= max(footprint.radius, least))


def _check(done: str, footprint: object, height: object, pose: object) -> None:
    if not isinstance(footprint, Footprint):
        raise TypeError(f"grass is {done} under a Footprint, not under {footprint!r}")
    if not isinstance(pose, Pose):
        raise TypeError(f"a footprint lies at a Pose, not at {pose!r}")
    if not np.isfinite([pose.x, pose.z, pose.yaw]).all():
        raise ValueError(f"a footprint lies at a pose of finite numbers, not at {pose!r}")
    if isinstance(height, bool) or not isinstance(height, float | int | np.floating | np.integer):
        raise TypeError(f"grass is {done} to a height in metres, not to {height!r}")
    if isnan(height) or height < 0.0:
        raise ValueError(f"grass is {done} to 0 m or more, not to {height}")


def _cells(side: float) -> int:
    return int(np.clip(np.ceil(side / CELL - 1e-6), 1, MOST_CELLS))
