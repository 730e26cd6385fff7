"""The map of how high grass is left to stand, and what is cut on it."""

from functools import partial
from math import inf, isnan

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.pose import Pose
from ...engine.handed import NUMBERS
from ...engine.terrain.part import Part
from ...engine.terrain.plots import CELL, CELLS, Plots, ends_of
from ...engine.terrain.record import Terrain
from .area import LEAST, Area, Change, must_be_area, stroke

_MOST_TOPS = 100_000
"""Patches whose highest grass is remembered at most."""


class Mown:
    """How high grass stands at most, over a terrain, in cells of 0.2 m."""

    def __init__(self, terrain: Terrain) -> None:
        self.plots = Plots(terrain.whole, np.dtype(np.float32))
        """Up to which height blades are left [m], infinite where nothing is cut."""
        self._tops: dict[tuple[int, int], float] = {}
        self._patch, self._seen = 0.0, 0

    @property
    def strokes(self) -> int:
        """A number that is another one after all that has changed anything; 0 while all is as it grew."""
        return self.plots.count

    def cut(self, area: Area, height: float, pose: Pose) -> None:
        """Let nothing stand higher than `height` [m] under a footprint or a road.

        Raises TypeError for what is no footprint, height or pose, ValueError for a negative height and for a pose that
        is not finite.
        """
        _check("cut", area, height, pose)
        self._stroke(area, pose, partial(_limited, limit=np.minimum, height=np.float32(height)))

    def grow(self, area: Area, height: float, pose: Pose) -> None:
        """Let what was cut under a footprint or a road stand up to `height` [m] again; raises the errors of `cut`."""
        _check("grown", area, height, pose)
        if self.plots.any:
            self._stroke(area, pose, partial(_limited, limit=np.maximum, height=np.float32(height)))

    def tops(self, cells: NDArray[np.int32], *, patch: float) -> Floats:
        """Return up to which height the highest grass is left on patches of a side [m], shape (n,).

        `cells` (n, 2) are theirs. Those of the map count whose middles are on the patch.
        """
        found = np.full(len(cells), np.inf, np.float32)
        if not self.plots.any:
            return found
        self._follow(patch)
        first, last = (np.ceil((cells + end) * (patch / CELL) - 0.5).astype(np.int64) for end in (0, 1))
        cut = np.flatnonzero(self._is_on(first) & self._is_on(last - 1))
        tops = self._tops
        for number in cut.tolist():
            cell = int(cells[number, 0]), int(cells[number, 1])
            if cell not in tops:
                tops[cell] = self._top(first[number], last[number])
            found[number] = tops[cell]
        return found

    def at(self, place: Floats) -> Floats:
        """Return up to which height grass is left at ground positions (n, 2) [m], shape (n,); infinite where uncut."""
        left = np.full(len(place), np.inf, np.float32)
        on = self.plots.on(place)
        left[on.which] = self.plots.nearest(on)
        return left

    def change(self, terrain: Terrain) -> None:
        """Take over another terrain: what was cut at a place stays cut there."""
        before, after = self.plots, Plots(terrain.whole, np.dtype(np.float32))
        if before.half == after.half:
            return
        after.count = before.count
        if before.any:
            after.resume(*before.saved())
        self.plots, self._tops = after, {}

    def _stroke(self, area: Area, pose: Pose, change: Change) -> None:
        stroke(self.plots, area, pose, change, _uncut, beyond=0.0, least=LEAST * CELL)

    def _is_on(self, cell: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return whether cells of the map (n, 2) are on plots that are there, shape (n,)."""
        plot = cell // CELLS + self.plots.half
        rows, columns = self.plots.index.shape
        within = np.all((plot >= 0) & (plot < (columns, rows)), axis=1)
        column, row = np.where(within[:, None], plot, 0).T
        return np.asarray(within & (self.plots.index[row, column] >= 0))

    def _top(self, first: NDArray[np.int64], last: NDArray[np.int64]) -> float:
        low, high = ((cell * CELL + inward).astype(np.float32) for cell, inward in ((first, 1e-3), (last, -1e-3)))
        return max((inf if left is None else float(left.max()) for left in self.plots.within(low, high)), default=inf)

    def _follow(self, patch: float) -> None:
        """Forget what is no longer so of patches of a side [m]."""
        if patch == self._patch and self._seen == self.strokes:
            return
        changed = self.plots.since(self._seen) if patch == self._patch else None
        self._patch, self._seen = patch, self.strokes
        if changed is None or len(self._tops) > _MOST_TOPS:
            self._tops.clear()
            return
        for part in changed:
            low, high = (np.floor(end / patch).astype(int).tolist() for end in ends_of(part))
            for i in range(low[0], high[0] + 1):
                for j in range(low[1], high[1] + 1):
                    self._tops.pop((i, j), None)


def _uncut(part: Part) -> Floats:
    return np.full((part.rows, part.columns), np.inf, np.float32)


def _limited(before: Floats, away: Floats, *, limit: np.ufunc, height: np.float32) -> Floats:
    return np.where(away <= 0.0, limit(before, height), before)


def _check(done: str, area: object, height: object, pose: object) -> None:
    must_be_area(area, pose, done)
    if isinstance(height, bool) or not isinstance(height, NUMBERS):
        raise TypeError(f"grass is {done} to a height in metres, not to {height!r}")
    if isnan(height) or height < 0.0:
        raise ValueError(f"grass is {done} to 0 m or more, not to {height}")
