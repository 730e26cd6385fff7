"""Crowns over the grass: its density falls in the shade of trees."""

import numpy as np

from ...components.arrays import Doubles, Floats
from ..pair import cells_between, numbered

SHADE_KEEPS = 0.15
"""Density of grass without any light, as a fraction of its density in the open: some grass bears shade."""

CELL = 8.0
"""Least side of a cell of the grid by which crowns are looked up [m]."""

MOST_CELLS = 1024
"""Greatest number of these cells along x and z."""

NO_DISCS = np.zeros((0, 4))

GLSL = {"SHADE_KEEPS": SHADE_KEEPS}


class Crowns:
    """The crowns of trees over the grass, and the density of grass below them.

    Density is proportional to light (Monteith, Climate and the Efficiency of Crop Production, 1977). Light falls with
    the leaves above by Beer's law, as measured below trees (Jameson, The Relationship of Tree Overstory and Herbaceous
    Understory Vegetation, 1967). Some grass is left in the deepest shade.
    """

    def __init__(self) -> None:
        self._lasting = self._fading = _Grid(NO_DISCS)

    @property
    def discs(self) -> Doubles:
        """Each crown's trunk (x, z) [m], radius of its shade [m] and optical depth at the trunk, shape (n, 4)."""
        return np.concatenate([self._lasting.discs, self._fading.discs])

    def __len__(self) -> int:
        return len(self._lasting.discs) + len(self._fading.discs)

    def stand(self, discs: Doubles, fading: Doubles = NO_DISCS, /) -> Doubles:
        """Replace all crowns by `discs` (n, 4), as in the field, and those that fade; return what differs, (m, 4)."""
        before, now = _without_same_ends(self._lasting.discs, discs)
        both = np.concatenate([before, now, self._fading.discs, fading])
        if len(before) or len(now):  # most often only those that fade differ, which are few
            self._lasting = _Grid(discs)
        self._fading = _Grid(fading)
        _, back, count = np.unique(both, axis=0, return_inverse=True, return_counts=True)
        return np.asarray(both[count[back.reshape(-1)] == 1])

    def left_at(self, place: Floats, /) -> Floats | None:
        """Return density at ground positions (n, 2) [m] as a fraction of that in the open, (n,); None if all are 1."""
        depths = [depth for grid in (self._lasting, self._fading) if (depth := grid.depth_at(place)) is not None]
        if not depths:
            return None
        return np.asarray(SHADE_KEEPS + (1.0 - SHADE_KEEPS) * np.exp(-np.sum(depths, axis=0)), np.float32)


class _Grid:
    """Discs, sorted by the cells of a grid that they cover; a disc is listed in each of its cells."""

    def __init__(self, discs: Doubles) -> None:
        self.discs = discs
        if not len(discs):
            return
        middle, reach = np.ascontiguousarray(discs.T[:2]), discs[:, 2]
        low, high = middle - reach, middle + reach
        corner = low.min(axis=1)
        cell = max(CELL, float((high.max(axis=1) - corner).max()) / MOST_CELLS)
        first, last = (((ends - corner[:, None]) / cell).astype(np.int32) for ends in (low, high))
        columns, rows = (last.max(axis=1) + 1).tolist()
        disc, column, row = cells_between(first.T, last.T)
        order = np.argsort(column.astype(np.int16), kind="stable")  # 16 bits are sorted by radix, much faster
        order = order[np.argsort(row[order].astype(np.int16), kind="stable")]
        self._corner, self._cell, self._shape = corner, cell, (columns, rows)
        self._listed = disc[order]
        self._first = np.append(0, np.cumsum(np.bincount(row * columns + column, minlength=columns * rows)))

    def depth_at(self, place: Floats) -> Doubles | None:
        """Return the sum of the discs' optical depths at ground positions (n, 2) [m], (n,); None far from all."""
        if not len(self.discs):
            return None
        at = np.floor((place - self._corner) / self._cell).astype(np.intp)
        columns, rows = self._shape
        within = ((at >= 0) & (at < (columns, rows))).all(axis=1)
        cell = np.where(within, at[:, 1] * columns + at[:, 0], 0)
        count = np.where(within, self._first[cell + 1] - self._first[cell], 0)
        if not count.any():
            return None
        below, number = numbered(count)
        disc = self.discs[self._listed[self._first[cell[below]] + number]]
        distance = ((place[below] - disc[:, :2]) ** 2).sum(axis=1) / disc[:, 2] ** 2
        return np.asarray(
            np.bincount(below, disc[:, 3] * np.maximum(1.0 - distance, 0.0) ** 2, minlength=len(place)), np.float64
        )


def _without_same_ends(before: Doubles, now: Doubles) -> tuple[Doubles, Doubles]:
    """Return the rows of both from the first difference to the last: few where little has changed."""
    first = _same(before, now)
    before, now = before[first:], now[first:]
    last = _same(before[::-1], now[::-1])
    return before[: len(before) - last], now[: len(now) - last]


def _same(a: Doubles, b: Doubles) -> int:
    """Return the number of rows at the start that are the same."""
    count = min(len(a), len(b))
    differ = np.flatnonzero((a[:count] != b[:count]).any(axis=1))
    return int(differ[0]) if len(differ) else count
