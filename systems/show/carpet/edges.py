"""Edges of grass: where it ends, or its height changes, more sharply than the mesh of the ground can show."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Mask
from ....engine.handed import FARTHEST
from ....engine.terrain.plots import CELLS, SIDE, Plots, Values
from ...mow.mown import Mown
from ...space.ground import EDGE_STEP, EDGE_WIDTH, Ground
from .found import Found
from .holes import MOST_BLOCKS, Blocks, Holes, Rectangles

HEIGHT_STEP = 0.05
"""Smallest step in the height of cut grass that is an edge [m]."""


PARTS = 4
"""Parts along a side of a plot: a part is the smallest square known to have an edge."""

PART_CELLS = CELLS // PARTS
"""Cells along a side of a part."""


class Edges:
    """The edges of the grass on a terrain, updated when the grass or the terrain has changed."""

    def __init__(self) -> None:
        self._maps: Values | None = None
        self._painted: Blocks | None = None
        self._holes: Holes | None = None
        self._sown, self._cut = _PlotEdges(EDGE_STEP * 255.0), _PlotEdges(HEIGHT_STEP)

    def touch(self, ground: Ground, mown: Mown | None, tallest: float, rectangles: Rectangles, /) -> Mask:
        """Return which rectangles of ground touch an edge, in their common shape.

        `tallest` is an upper bound of the height of all grass [m].
        """
        density = ground.density
        if self._maps is not density.maps:
            self._maps = density.maps
            self._painted = _painted_edges(density.maps, ground)
        if self._holes is None or not self._holes.match(ground.terrain):
            self._holes = Found.of(ground.terrain).holes
        found = np.zeros(np.broadcast_shapes(*(bound.shape for bound in rectangles)), np.bool_)
        if self._painted is not None:
            found |= self._painted.touch(rectangles)
        found |= self._holes.touch(rectangles)
        found |= self._sown.touch(density.sown, rectangles)
        if mown is not None:
            found |= self._cut.touch(mown.plots, rectangles, most=tallest)
        return found


def _painted_edges(maps: Values, ground: Ground) -> Blocks | None:
    """Return the edges of the painted densities (kinds, rows, columns), None if there are none."""
    shape, size = np.array(maps.shape[1:]), np.array(ground.terrain.size)[::-1]
    within = ground.patch * EDGE_WIDTH
    step = EDGE_STEP / min(1.0, within * float((shape / size).max()))
    down, across = np.maximum(np.ceil(np.maximum(within * shape / size, shape / MOST_BLOCKS)), 1).astype(int).tolist()
    uneven = [_uneven_blocks(values, down, across, step) for values in maps if np.ptp(values) > step]
    if not any(blocks.any() for blocks in uneven):
        return None
    side = (size / shape * (down, across))[::-1]
    return Blocks(np.logical_or.reduce(uneven), np.array(ground.terrain.origin), side)


def _uneven_blocks(values: Floats, down: int, across: int, step: float) -> Mask:
    """Return which blocks of `down` by `across` samples have a step above `step`, inside or towards the next block."""
    high, low = (
        _block_extremes(extreme, _block_extremes(extreme, values, 0, down), 1, across)
        for extreme in (np.maximum, np.minimum)
    )
    uneven = np.asarray(high - low > step)
    for axis in (0, 1):  # interpolation towards the next block's first sample goes on inside that block
        uneven[(slice(None),) * axis + (slice(1, None),)] |= np.diff(uneven.astype(np.int8), axis=axis) < 0
    return uneven


def _block_extremes(extreme: np.ufunc, values: Floats, axis: int, samples: int) -> Floats:
    """Return the maximum or minimum of each block of samples along an axis, with the next block's first sample."""
    count = values.shape[axis]
    starts = np.arange(0, count, samples)
    found = extreme.reduceat(values, starts, axis=axis)
    return np.asarray(extreme(found, values.take(np.minimum(starts + samples, count - 1), axis=axis)))


class _PlotEdges:
    """The edges of a map that is kept by plots, known by part: inside a part or between it and its neighbour."""

    def __init__(self, step: float) -> None:
        self._step = step
        self._made_of: tuple[Plots | None, int, float] = None, -1, 0.0
        self._read = np.zeros(0, np.int64)
        """Number of the write up to which each page has been read, shape (pages,)."""
        self._uneven = np.zeros((0, PARTS, PARTS), np.bool_)
        """Whether each part has an edge inside, shape (pages, PARTS, PARTS)."""
        self._level: Floats = np.zeros((0, PARTS, PARTS, 1), np.float32)
        """Values of the first cell of each part, and of all others if it is even, shape (pages, PARTS, PARTS, m)."""
        self._blocks: Blocks | None = None

    def touch(self, plots: Plots, rectangles: Rectangles, *, most: float = np.inf) -> Mask:
        """Return which rectangles touch an uneven part of a plot, in their common shape.

        Values above `most` count as `most`, and so does ground without a plot.
        """
        if self._made_of != (plots, plots.count, most):
            if self._made_of[::2] != (plots, most):
                self._read = np.zeros(0, np.int64)
            self._blocks = None
            if plots.any:
                self._read_pages(plots, most)
                self._blocks = self._uneven_blocks(plots, most)
            self._made_of = plots, plots.count, most
        return np.zeros((), np.bool_) if self._blocks is None else self._blocks.touch(rectangles)

    def _read_pages(self, plots: Plots, most: float) -> None:
        """Read the pages that have been written since they were read last."""
        known, count = len(self._read), len(plots.written)
        stale = np.flatnonzero(plots.written != np.append(self._read, np.full(count - known, -1)))
        pages = plots.pages[stale]
        cells = pages if pages.ndim > 3 else pages[..., None]
        uneven = np.zeros((count, PARTS, PARTS), np.bool_)
        level = np.empty((*uneven.shape, cells.shape[-1]), np.float32)
        if known:
            uneven[:known], level[:known] = self._uneven, self._level
        firsts = cells[:, ::PART_CELLS, ::PART_CELLS]
        values = np.stack([_part_extremes(np.minimum, cells), _part_extremes(np.maximum, cells), firsts])
        low, high, level[stale] = np.minimum(values.astype(np.float32), np.float32(min(most, FARTHEST)))
        uneven[stale] = (high - low > self._step).any(axis=-1)
        self._uneven, self._level, self._read = uneven, level, plots.written.copy()

    def _uneven_blocks(self, plots: Plots, most: float) -> Blocks | None:
        """Return the parts of the ground that have an edge, inside or towards an adjacent one; None without plots."""
        top, left, bottom, right = plots.ends
        if bottom < top:
            return None
        page = np.full((bottom - top + 3, right - left + 3), -1, np.int32)  # with a frame of ground without plots
        page[1:-1, 1:-1] = plots.index[top : bottom + 1, left : right + 1]
        # Page -1 is the one added last, of ground without a plot.
        no_edge = np.zeros((1, PARTS, PARTS), np.bool_)
        no_plot = np.full((1, *self._level.shape[1:]), most if most < np.inf else np.nan, np.float32)
        inside = _laid_out(np.append(self._uneven, no_edge, axis=0)[page])
        levels = _laid_out(np.append(self._level, no_plot, axis=0)[page])
        has_page = np.repeat(np.repeat(page >= 0, PARTS, axis=0), PARTS, axis=1)
        corner = (np.array([left, top]) - 1 - plots.half) * SIDE
        return Blocks(_with_steps_between(inside, has_page, levels, self._step), corner, np.full(2, SIDE / PARTS))


def _part_extremes(extreme: np.ufunc, cells: Values) -> Values:
    """Return the maximum or minimum of each part, (n, PARTS, PARTS, m), of the cells of pages (n, CELLS, CELLS, m).

    A part includes the adjacent cells of its neighbours, as values are interpolated between both.
    """
    for axis in (1, 2):
        before = (slice(None),) * axis
        parts = cells.reshape(*cells.shape[:axis], PARTS, PART_CELLS, *cells.shape[axis + 1 :])
        found = extreme.reduce(parts, axis=axis + 1)
        for part, adjacent in (
            (np.s_[1:], np.s_[PART_CELLS - 1 : -1 : PART_CELLS]),
            (np.s_[:-1], np.s_[PART_CELLS::PART_CELLS]),
        ):
            found[(*before, part)] = extreme(found[(*before, part)], cells[(*before, adjacent)])
        cells = found
    return cells


def _laid_out(parts: NDArray[Any]) -> NDArray[Any]:
    """Return the parts of plots (rows, columns, PARTS, PARTS, ...) as one map (PARTS * rows, PARTS * columns, ...)."""
    rows, columns = parts.shape[:2]
    return parts.swapaxes(1, 2).reshape(PARTS * rows, PARTS * columns, *parts.shape[4:])


def _with_steps_between(uneven: Mask, has_page: Mask, levels: Floats, step: float) -> Mask:
    """Return which parts (rows, columns) have an edge, inside or towards an adjacent part.

    `uneven` has the parts with an edge inside, `has_page` those on plots with a page, and `levels` (rows, columns, m)
    the values of all even ones.
    """
    found = uneven.copy()
    for axis in (0, 1):
        low, high = (np.s_[:-1], np.s_[1:]) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
        steps = ~(np.abs(levels[low] - levels[high]) <= step).all(axis=-1)
        differs = steps & (has_page[low] | has_page[high]) & ~uneven[low] & ~uneven[high]
        found[low] |= differs
        found[high] |= differs
    return found
