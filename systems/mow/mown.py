"""The map of cut heights."""

from functools import partial
from math import inf
from reprlib import repr as shortened

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.pose import Pose
from ...engine.handed import FARTHEST, NUMBER_TYPES
from ...engine.terrain.plots import CELL, CELLS, Plots, ends_of
from ...engine.terrain.record import Terrain
from ...engine.terrain.rectangle import Rectangle
from .area import LEAST_RADIUS, Area, Change, must_be_area, stroke

_MOST_CACHED = 100_000
"""Number of patches in the cache of largest cut heights at which it is cleared."""


class Mown:
    """Map over a terrain of the heights to which grass is cut, in cells of 0.2 m."""

    def __init__(self, terrain: Terrain) -> None:
        self.plots = Plots(terrain.whole, np.dtype(np.float32))
        """Heights to which blades are cut [m], infinite where nothing is cut."""
        self._cached_tops: dict[tuple[int, int], float] = {}
        self._patch, self._seen_strokes = 0.0, 0

    @property
    def strokes(self) -> int:
        """Count of changes; 0 while nothing has been cut."""
        return self.plots.count

    def cut(self, area: Area, height: float, pose: Pose) -> None:
        """Cut grass to `height` [m] under a footprint or a road.

        Raise TypeError for no footprint, height or pose, ValueError for a negative height or a pose that is not finite.
        """
        _must_be_valid("cut", area, height, pose)
        self._stroke(area, pose, partial(_limit_within, limit=np.minimum, height=_single(height)))

    def grow(self, area: Area, height: float, pose: Pose) -> None:
        """Let cut grass under a footprint or a road stand up to `height` [m] again; raise the errors of `cut`."""
        _must_be_valid("grown", area, height, pose)
        if self.plots.any:
            self._stroke(area, pose, partial(_limit_within, limit=np.maximum, height=_single(height)))

    def tops(self, cells: NDArray[np.int32], *, patch: float) -> Floats:
        """Return the largest cut height on each patch, shape (n,) [m]; infinite where any of it is uncut.

        `cells` (n, 2) are the patches', `patch` is their side [m]. A patch has the map's cells whose middles are on it.
        """
        heights = np.full(len(cells), np.inf, np.float32)
        if not self.plots.any:
            return heights
        self._drop_changed(patch)
        first, last = (np.ceil((cells + end) * (patch / CELL) - 0.5).astype(np.int64) for end in (0, 1))
        cut = np.flatnonzero(self._has_plot(first) & self._has_plot(last - 1))
        tops = self._cached_tops
        for number in cut.tolist():
            cell = int(cells[number, 0]), int(cells[number, 1])
            if cell not in tops:
                tops[cell] = self._top_in(first[number], last[number])
            heights[number] = tops[cell]
        return heights

    def at(self, place: Floats) -> Floats:
        """Return the cut heights at ground positions (n, 2) [m], shape (n,); infinite where uncut."""
        heights = np.full(len(place), np.inf, np.float32)
        sampled = self.plots.on(place)
        heights[sampled.which] = self.plots.nearest(sampled)
        return heights

    def change(self, terrain: Terrain) -> None:
        """Take over another terrain; what is cut at a place stays cut."""
        before, after = self.plots, Plots(terrain.whole, np.dtype(np.float32))
        if before.half == after.half:
            return
        after.count = before.count
        if before.any:
            after.resume(*before.saved())
        self.plots, self._cached_tops = after, {}

    def _stroke(self, area: Area, pose: Pose, change: Change) -> None:
        """Change the cells whose middles are in an area, whose radius is at least `LEAST_RADIUS` cells."""
        stroke(self.plots, area, pose, change, _uncut, beyond=0.0, least=LEAST_RADIUS * CELL)

    def _has_plot(self, cell: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return whether cells of the map (n, 2) are on plots that exist, shape (n,)."""
        plot = cell // CELLS + self.plots.half
        rows, columns = self.plots.index.shape
        within = np.all((plot >= 0) & (plot < (columns, rows)), axis=1)
        column, row = np.where(within[:, None], plot, 0).T
        return np.asarray(within & (self.plots.index[row, column] >= 0))

    def _top_in(self, first: NDArray[np.int64], last: NDArray[np.int64]) -> float:
        """Return the largest cut height in cells of the map from `first` up to, without, `last` [m]."""
        low, high = ((cell * CELL + inward).astype(np.float32) for cell, inward in ((first, 1e-3), (last, -1e-3)))
        return max((inf if left is None else float(left.max()) for left in self.plots.within(low, high)), default=inf)

    def _drop_changed(self, patch: float) -> None:
        """Drop cached heights of changed patches of a side [m]."""
        if patch == self._patch and self._seen_strokes == self.strokes:
            return
        changed = self.plots.since(self._seen_strokes) if patch == self._patch else None
        self._patch, self._seen_strokes = patch, self.strokes
        if changed is None or len(self._cached_tops) > _MOST_CACHED:
            self._cached_tops.clear()
            return
        for part in changed:
            low, high = (np.floor(end / patch).astype(int).tolist() for end in ends_of(part))
            for i in range(low[0], high[0] + 1):
                for j in range(low[1], high[1] + 1):
                    self._cached_tops.pop((i, j), None)


def _uncut(part: Rectangle) -> Floats:
    return np.full((part.rows, part.columns), np.inf, np.float32)


def _limit_within(before: Floats, distances: Floats, *, limit: np.ufunc, height: np.float32) -> Floats:
    """Return heights with a lower or upper limit applied at distances up to 0."""
    return np.where(distances <= 0.0, limit(before, height), before)


def _single(height: float) -> np.float32:
    """Return a height in single precision, infinite for one that no grass reaches."""
    return np.float32(height if height < FARTHEST else inf)


def _must_be_valid(done: str, area: object, height: object, pose: object) -> None:
    """Raise the errors of `Mown.cut`; `done` is the verb's participle."""
    must_be_area(area, pose, done)
    if isinstance(height, bool) or not isinstance(height, NUMBER_TYPES):
        raise TypeError(f"grass is {done} to a height in metres, not to {shortened(height)}")
    if not height >= 0.0:
        raise ValueError(f"grass is {done} to 0 m or more, not to {height}")
