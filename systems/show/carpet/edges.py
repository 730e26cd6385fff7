"""Where grass does not stand evenly: where it ends, or has been cut, more sharply than the mesh of the ground shows."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Mask
from ....engine.handed import FARTHEST
from ....engine.terrain.plots import CELLS, SIDE, Plots, Values
from ...mow.mown import Mown
from ...space.ground import STEP, WITHIN, Ground
from .found import Found
from .holes import MOST_BLOCKS, Blocks, Holes, Stretches

STEP_OF_HEIGHT = 0.05
"""By how much the height changes at least that grass is cut to where there is an edge [m]."""


PARTS = 4
"""Parts along a side of a plot in which edges are told apart."""

PART = CELLS // PARTS
"""Cells along a side of one."""


class Edges:
    """Where there are edges in the grass of a terrain; made out anew where that has changed."""

    def __init__(self) -> None:
        self._maps: Values | None = None
        self._painted: Blocks | None = None
        self._holes: Holes | None = None
        self._sown, self._cut = _OnPlots(STEP * 255.0), _OnPlots(STEP_OF_HEIGHT)

    def at(self, ground: Ground, mown: Mown | None, tallest: float, stretches: Stretches, /) -> Mask:
        """Return in which stretches of ground there are any, of the shape that they have together.

        `tallest` is the height that no grass comes to [m].
        """
        density = ground.density
        if self._maps is not density.maps:
            self._maps = density.maps
            self._painted = _painted_edges(density.maps, ground)
        if self._holes is None or not self._holes.are_of(ground.terrain):
            self._holes = Found.of(ground.terrain).holes
        found = np.zeros(np.broadcast_shapes(*(each.shape for each in stretches)), np.bool_)
        if self._painted is not None:
            found |= self._painted.touch(stretches)
        found |= self._holes.touch(stretches)
        found |= self._sown.touch(density.sown, stretches)
        if mown is not None:
            found |= self._cut.touch(mown.plots, stretches, most=tallest)
        return found


def _painted_edges(maps: Values, ground: Ground) -> Blocks | None:
    """Return where any kind's density, as painted (kinds, rows, columns), has edges; None is nowhere."""
    shape, size = np.array(maps.shape[1:]), np.array(ground.terrain.size)[::-1]
    within = ground.patch * WITHIN
    step = STEP / min(1.0, within * float((shape / size).max()))
    down, across = np.maximum(np.ceil(np.maximum(within * shape / size, shape / MOST_BLOCKS)), 1).astype(int).tolist()
    uneven = [_uneven_blocks(values, down, across, step) for values in maps if np.ptp(values) > step]
    if not any(each.any() for each in uneven):
        return None
    side = (size / shape * (down, across))[::-1]
    return Blocks(np.logical_or.reduce(uneven), np.array(ground.terrain.origin), side)


def _uneven_blocks(values: Floats, down: int, across: int, step: float) -> Mask:
    """Return which blocks of so many samples have a step of at least that in them, or on the way to the next."""
    high, low = (_reduced(reach, _reduced(reach, values, 0, down), 1, across) for reach in (np.maximum, np.minimum))
    uneven = np.asarray(high - low > step)
    for axis in (0, 1):  # the way to the first sample of the next block goes on into that
        uneven[(slice(None),) * axis + (slice(1, None),)] |= np.diff(uneven.astype(np.int8), axis=axis) < 0
    return uneven


def _reduced(reach: np.ufunc, values: Floats, axis: int, each: int) -> Floats:
    """Return the greatest or the least of blocks of samples along an axis: of each, and the first of the next."""
    count = values.shape[axis]
    starts = np.arange(0, count, each)
    found = reach.reduceat(values, starts, axis=axis)
    return np.asarray(reach(found, values.take(np.minimum(starts + each, count - 1), axis=axis)))


class _OnPlots:
    """The edges of a map that is kept by plots: a part of one is uneven that has one, or one towards another part."""

    def __init__(self, step: float) -> None:
        self._step = step
        self._of: tuple[Plots | None, int, float] = None, -1, 0.0
        self._uneven, self._seen = np.zeros((0, PARTS, PARTS), np.bool_), np.zeros(0, np.int64)
        self._level: Floats = np.zeros((0, PARTS, PARTS, 1), np.float32)
        self._blocks: Blocks | None = None

    def touch(self, plots: Plots, stretches: Stretches, *, most: float = np.inf) -> Mask:
        """Return which stretches touch an uneven part of a plot, of the shape that they have together.

        Values are told apart up to `most`, and where there is no plot it is as if they were all that.
        """
        if self._of != (plots, plots.count, most):
            if self._of[::2] != (plots, most):
                self._seen = np.zeros(0, np.int64)
            self._look(plots, most)
            self._of = plots, plots.count, most
        return np.zeros((), np.bool_) if self._blocks is None else self._blocks.touch(stretches)

    def _look(self, plots: Plots, most: float) -> None:
        self._blocks = None
        if not plots.any:
            return
        known, count = len(self._seen), len(plots.written)
        stale = np.flatnonzero(plots.written != np.append(self._seen, np.full(count - known, -1)))
        pages, highest = plots.pages[stale], np.float32(min(most, FARTHEST))
        cells = pages if pages.ndim > 3 else pages[..., None]
        uneven = np.zeros((count, PARTS, PARTS), np.bool_)
        level = np.empty((*uneven.shape, cells.shape[-1]), np.float32)
        if known:
            uneven[:known], level[:known] = self._uneven, self._level
        ends = np.stack([_reaching(np.minimum, cells), _reaching(np.maximum, cells), cells[:, ::PART, ::PART]])
        low, high, level[stale] = np.minimum(ends.astype(np.float32), highest)
        uneven[stale] = (high - low > self._step).any(axis=-1)
        self._uneven, self._level = uneven, level
        self._seen = plots.written.copy()
        top, left, bottom, right = plots.ends
        if bottom < top:
            return
        first = np.array([top, left]) - 1
        page = np.full((bottom - top + 3, right - left + 3), -1, np.int32)
        page[1:-1, 1:-1] = plots.index[top : bottom + 1, left : right + 1]
        none = np.full((1, *level.shape[1:]), most if most < np.inf else np.nan, np.float32)
        levels = _laid_out(np.append(level, none, axis=0)[page])  # -1 finds the last one
        corner = (first[::-1] - plots.half) * SIDE
        own = np.append(self._uneven, np.zeros((1, PARTS, PARTS), np.bool_), axis=0)
        there = np.repeat(np.repeat(page >= 0, PARTS, axis=0), PARTS, axis=1)
        uneven = _uneven_parts(_laid_out(own[page]), there, levels, self._step)
        self._blocks = Blocks(uneven, corner, np.full(2, SIDE / PARTS))


def _reaching(reach: np.ufunc, cells: Values) -> Values:
    """Return the greatest or the least of the cells of pages (n, CELLS, CELLS, m) by part, (n, PARTS, PARTS, m).

    Those of a page beside it count with it: what lies between is read of both.
    """
    for axis in (1, 2):
        before = (slice(None),) * axis
        parts = cells.reshape(*cells.shape[:axis], PARTS, PART, *cells.shape[axis + 1 :])
        found = reach.reduce(parts, axis=axis + 1)
        for own, beside in ((np.s_[1:], np.s_[PART - 1 : -1 : PART]), (np.s_[:-1], np.s_[PART::PART])):
            found[(*before, own)] = reach(found[(*before, own)], cells[(*before, beside)])
        cells = found
    return cells


def _laid_out(parts: NDArray[Any]) -> NDArray[Any]:
    """Return parts of plots (rows, columns, PARTS, PARTS, ...) as they lie, (PARTS * rows, PARTS * columns, ...)."""
    rows, columns = parts.shape[:2]
    return parts.swapaxes(1, 2).reshape(PARTS * rows, PARTS * columns, *parts.shape[4:])


def _uneven_parts(own: Mask, there: Mask, levels: Floats, step: float) -> Mask:
    """Return which parts of plots (rows, columns) have an edge, in them or towards the part beside them.

    Told are which have an edge of their `own`, which are on plots that are there, and what even ones have, (rows,
    columns, m).
    """
    found = own.copy()
    for axis in (0, 1):
        one, other = (np.s_[:-1], np.s_[1:]) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
        steps = ~(np.abs(levels[one] - levels[other]) <= step).all(axis=-1)
        differs = steps & (there[one] | there[other]) & ~own[one] & ~own[other]
        found[one] |= differs
        found[other] |= differs
    return found
