"""Where grass does not stand evenly: where it ends, or has been cut, more sharply than the mesh of the ground shows."""

import numpy as np

from ....components.arrays import Floats, Ints, Mask
from ....engine.handed import FARTHEST
from ....engine.terrain.plots import CELLS, SIDE, Plots, Values
from ...mow.mown import Mown
from ...space.ground import Ground
from .found import Found
from .holes import MOST_BLOCKS, Blocks, Holes, Stretches

WITHIN = 1.0 / 3.0
"""An edge is a step within this part of a patch's side: what is softer the mesh shows well enough."""

STEP_OF_DENSITY = 0.35
"""By how much a kind's density changes at least where there is an edge."""

STEP_OF_HEIGHT = 0.05
"""By how much the height changes at least that grass is cut to where there is an edge [m]."""


class Edges:
    """Where there are edges in the grass of a terrain; made out anew where that has changed."""

    def __init__(self) -> None:
        self._maps: Values | None = None
        self._painted: Blocks | None = None
        self._holes: Holes | None = None
        self._sown, self._cut = _OnPlots(STEP_OF_DENSITY * 255.0), _OnPlots(STEP_OF_HEIGHT)

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
    step = STEP_OF_DENSITY / min(1.0, within * float((shape / size).max()))
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
    """The edges of a map that is kept by plots: a plot is uneven that has one, or one towards the plot beside it."""

    def __init__(self, step: float) -> None:
        self._step = step
        self._of: tuple[Plots | None, int, float] = None, -1, 0.0
        self._uneven, self._seen = np.zeros(0, np.bool_), np.zeros(0, np.int64)
        self._level: Floats = np.zeros((0, 1), np.float32)
        self._blocks: Blocks | None = None

    def touch(self, plots: Plots, stretches: Stretches, *, most: float = np.inf) -> Mask:
        """Return which stretches touch an uneven plot, of the shape that they have together.

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
        self._uneven = np.append(self._uneven[:known], np.zeros(count - known, np.bool_))
        stale = np.flatnonzero(plots.written != np.append(self._seen, np.full(count - known, -1)))
        pages, channels = plots.pages[stale], int(np.prod(plots.pages.shape[3:]))
        level = np.empty((count, channels), np.float32)
        level[:known] = self._level[:known]
        lines, highest = pages.reshape(len(stale), CELLS, CELLS * channels), np.float32(min(most, FARTHEST))
        low, high = (each.reshape(len(stale), CELLS, channels) for each in (lines.min(axis=1), lines.max(axis=1)))
        ends = np.stack([low.min(axis=1), high.max(axis=1), lines[:, 0, :channels]])
        low, high, level[stale] = np.minimum(ends.astype(np.float32), highest)
        uneven = (high - low > self._step).any(axis=1)
        self._uneven[stale] = uneven
        self._level = level
        self._seen = plots.written.copy()
        top, left, bottom, right = plots.ends
        if bottom < top:
            return
        first = np.array([top, left]) - 1
        page = np.full((bottom - top + 3, right - left + 3), -1, np.int32)
        page[1:-1, 1:-1] = plots.index[top : bottom + 1, left : right + 1]
        none = np.full((1, level.shape[1]), most if most < np.inf else np.nan, np.float32)
        levels = np.append(level, none, axis=0)[page]  # -1 finds the last one
        corner = (first[::-1] - plots.half) * SIDE
        self._blocks = Blocks(_uneven_plots(page, self._uneven, levels, self._step), corner, np.array([SIDE, SIDE]))


def _uneven_plots(page: Ints, uneven: Mask, levels: Floats, step: float) -> Mask:
    """Return which plots (rows, columns) have an edge, in them or towards the plot beside them.

    Told are the page of each, -1 for none, which pages have an edge (n,), and what even plots have (rows, columns, m).
    """
    own = (page >= 0) & uneven[np.maximum(page, 0)]
    found = own.copy()
    for axis in (0, 1):
        one, other = (np.s_[:-1], np.s_[1:]) if axis == 0 else (np.s_[:, :-1], np.s_[:, 1:])
        steps = ~(np.abs(levels[one] - levels[other]) <= step).all(axis=-1)
        differs = steps & (page[one] != page[other]) & ~own[one] & ~own[other]
        found[one] |= differs
        found[other] |= differs
    return found
