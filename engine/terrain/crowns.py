"""Crowns over the grass: less of it grows where trees take its light."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats

SHADE_KEEPS = 0.15
"""How densely grass grows that gets no light at all, of what it does in the open: some bears shade."""

CELL = 8.0
"""Side of the cells by which crowns are found, at least [m]."""

MOST_CELLS = 1024
"""Such cells along x and z at most."""

GLSL = {"SHADE_KEEPS": SHADE_KEEPS}


class Crowns:
    """Where trees stand over the grass, and how much of it grows below them.

    Grass grows as densely as it gets light (Monteith, Climate and the Efficiency of Crop Production, 1977), which falls
    with the leaves above it by Beer's law; so it is found below trees (Jameson, The Relationship of Tree Overstory and
    Herbaceous Understory Vegetation, 1967), with some that is left in the deepest shade.
    """

    def __init__(self) -> None:
        self.discs: Doubles = np.zeros((0, 4))
        """Of each the trunk (x, z), how far it shades [m], and how many leaves light meets there, shape (n, 4)."""
        self._corner, self._cell = np.zeros(2), CELL
        self._shape = 0, 0
        self._first: NDArray[np.intp] = np.zeros(1, np.intp)
        self._of: NDArray[np.intp] = np.zeros(0, np.intp)

    def stand(self, discs: Doubles, /) -> Doubles:
        """Let these be all, as `discs` has them; return those that came or went, (m, 4)."""
        both = np.concatenate([self.discs, discs])
        _, back, count = np.unique(both, axis=0, return_inverse=True, return_counts=True)
        self.discs = discs
        if len(discs):
            self._sort()
        return np.asarray(both[count[back.reshape(-1)] == 1])

    def _sort(self) -> None:
        """Find the crowns over each cell."""
        reach = self.discs[:, 2:3]
        low, high = self.discs[:, :2] - reach, self.discs[:, :2] + reach
        self._corner = low.min(axis=0)
        self._cell = max(CELL, float((high.max(axis=0) - self._corner).max()) / MOST_CELLS)
        first, last = (((ends - self._corner) / self._cell).astype(np.intp) for ends in (low, high))
        columns, rows = (last.max(axis=0) + 1).tolist()
        self._shape = columns, rows
        wide = last - first + 1
        count = wide.prod(axis=1)
        number = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        of = np.repeat(np.arange(len(count)), count)
        column, row = first[of, 0] + number % wide[of, 0], first[of, 1] + number // wide[of, 0]
        cell = row * columns + column
        self._of = of[np.argsort(cell, kind="stable")]
        self._first = np.append(0, np.cumsum(np.bincount(cell, minlength=columns * rows)))

    def left_at(self, place: Floats, /) -> Floats | None:
        """Return how much grass grows at ground positions (n, 2) [m], of that in the open, shape (n,); None: all."""
        if not len(self.discs):
            return None
        at = np.floor((place - self._corner) / self._cell).astype(np.intp)
        columns, rows = self._shape
        within = ((at >= 0) & (at < (columns, rows))).all(axis=1)
        cell = np.where(within, at[:, 1] * columns + at[:, 0], 0)
        count = np.where(within, self._first[cell + 1] - self._first[cell], 0)
        if not count.any():
            return None
        which = np.repeat(np.arange(len(place)), count)
        number = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
        disc = self.discs[self._of[self._first[cell[which]] + number]]
        apart = ((place[which] - disc[:, :2]) ** 2).sum(axis=1) / disc[:, 2] ** 2
        met = np.bincount(which, disc[:, 3] * np.maximum(1.0 - apart, 0.0) ** 2, minlength=len(place))
        return np.asarray(SHADE_KEEPS + (1.0 - SHADE_KEEPS) * np.exp(-met), np.float32)
