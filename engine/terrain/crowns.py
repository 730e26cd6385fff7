"""Crowns over the grass: its density falls in the shade of trees."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats

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
        self.discs: Doubles = NO_DISCS
        """Each crown's trunk (x, z) [m], radius of its shade [m] and optical depth at the trunk, shape (n, 4)."""
        self._lasting = 0
        """Number of leading ones that last."""
        self._corner, self._cell = np.zeros(2), CELL
        self._shape = 0, 0
        self._first: NDArray[np.intp] = np.zeros(1, np.intp)
        self._listed: NDArray[np.intp] = np.zeros(0, np.intp)

    def stand(self, discs: Doubles, fading: Doubles = NO_DISCS, /) -> Doubles:
        """Replace all crowns by `discs` (n, 4), as in the field, and those that fade; return what differs, (m, 4)."""
        lasting, others = self.discs[: self._lasting], self.discs[self._lasting :]
        both = np.concatenate([*_without_same_ends(lasting, discs), others, fading])
        _, back, count = np.unique(both, axis=0, return_inverse=True, return_counts=True)
        self.discs, self._lasting = np.concatenate([discs, fading]), len(discs)
        if len(self.discs):
            self._sort()
        return np.asarray(both[count[back.reshape(-1)] == 1])

    def _sort(self) -> None:
        """Sort crowns by the cells that they cover; a crown is listed in each of its cells."""
        reach = self.discs[:, 2:3]
        low, high = self.discs[:, :2] - reach, self.discs[:, :2] + reach
        self._corner = low.min(axis=0)
        self._cell = max(CELL, float((high.max(axis=0) - self._corner).max()) / MOST_CELLS)
        first, last = (((ends - self._corner) / self._cell).astype(np.intp) for ends in (low, high))
        columns, rows = (last.max(axis=0) + 1).tolist()
        self._shape = columns, rows
        cells = last - first + 1
        count = cells.prod(axis=1)
        number = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        crown = np.repeat(np.arange(len(count)), count)
        column, row = first[crown, 0] + number % cells[crown, 0], first[crown, 1] + number // cells[crown, 0]
        cell = row * columns + column
        self._listed = crown[np.argsort(cell, kind="stable")]
        self._first = np.append(0, np.cumsum(np.bincount(cell, minlength=columns * rows)))

    def left_at(self, place: Floats, /) -> Floats | None:
        """Return density at ground positions (n, 2) [m] as a fraction of that in the open, (n,); None if all are 1."""
        if not len(self.discs):
            return None
        at = np.floor((place - self._corner) / self._cell).astype(np.intp)
        columns, rows = self._shape
        within = ((at >= 0) & (at < (columns, rows))).all(axis=1)
        cell = np.where(within, at[:, 1] * columns + at[:, 0], 0)
        count = np.where(within, self._first[cell + 1] - self._first[cell], 0)
        if not count.any():
            return None
        below = np.repeat(np.arange(len(place)), count)
        number = np.arange(len(below)) - np.repeat(np.cumsum(count) - count, count)
        disc = self.discs[self._listed[self._first[cell[below]] + number]]
        distance = ((place[below] - disc[:, :2]) ** 2).sum(axis=1) / disc[:, 2] ** 2
        depth = np.bincount(below, disc[:, 3] * np.maximum(1.0 - distance, 0.0) ** 2, minlength=len(place))
        return np.asarray(SHADE_KEEPS + (1.0 - SHADE_KEEPS) * np.exp(-depth), np.float32)


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
