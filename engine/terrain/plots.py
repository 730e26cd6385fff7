"""Sparse maps with cells of 0.2 m on a terrain of any size: only changed plots of the ground are stored."""

from collections.abc import Callable
from itertools import pairwise
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Ints
from .rectangle import MOST, Log, Rectangle

CELL = 0.2
"""Side of a cell of the ground [m]."""

CELLS = 64
"""Number of cells along a plot's side: a power of two, so that no mip texel covers two plots."""

SIDE = CELL * CELLS
"""Side of a plot [m]."""

GLSL = {"PLOT_CELLS": CELLS, "PLOT_SIDE": SIDE}

Values = NDArray[Any]
"""Values of a map's cells, shape (rows, columns, ...)."""

Untouched = Callable[[Rectangle], Values]
"""Returns the values of cells of a part that have never been changed."""


class On(NamedTuple):
    """The subset of given places that lies on stored plots."""

    which: NDArray[np.intp]
    """Indices among the given places, shape (m,)."""

    page: Ints
    """Page of each place, shape (m,)."""

    cell: Floats
    """Position of each place on its plot, (x, z) [cells], shape (m, 2)."""


class Plots(Log):
    """A map of cells, stored by plots: a page for each changed plot, shared by plots of the same uniform value.

    Cells are counted along x (columns) and z (rows) from the world's origin, so that they keep their places when the
    terrain changes. A cache made from the map compares `count`, and asks `since` for changes: parts, each
    within a plot.
    """

    def __init__(self, size: tuple[float, float], kind: np.dtype[Any], channels: tuple[int, ...] = ()) -> None:
        super().__init__()
        across, along = (max(ceil(side / 2.0 / SIDE - 1e-6), 1) for side in size)
        self.half = across, along
        """Number of plots from the middle of the terrain to its edges, along x and z."""
        self.pages: Values = np.empty((0, CELLS, CELLS, *channels), kind)
        self.written: NDArray[np.int64] = np.zeros(0, np.int64)
        """Value of `count` at each page's last change, shape (pages,)."""
        self._index: Ints | None = None
        self._uses: NDArray[np.int64] = np.zeros(0, np.int64)
        self._free: list[int] = []
        self._alike: dict[bytes, int] = {}
        """Page of all plots whose cells all have one value, by that value's bytes."""
        self._ends = self._no_ends

    @property
    def ends(self) -> tuple[int, int, int, int]:
        """First row and column of `index` that may have a page, and the last ones."""
        top, left, bottom, right = self._ends
        return top + self.half[1], left + self.half[0], bottom + self.half[1], right + self.half[0]

    @property
    def _no_ends(self) -> list[int]:
        return [self.half[1], self.half[0], -self.half[1], -self.half[0]]

    @property
    def index(self) -> Ints:
        """Page of each plot, -1 where it is not stored, row 0 at the far edge (-z), shape (rows, columns)."""
        if self._index is None:
            self._index = np.full((2 * self.half[1], 2 * self.half[0]), -1, np.int32)
        return self._index

    @property
    def any(self) -> bool:
        """Whether any plot is stored."""
        return self._index is not None

    def on(self, place: Floats, /) -> On:
        """Return those of ground positions (n, 2) [m] that lie on stored plots."""
        if self._index is None:
            return On(np.zeros(0, np.intp), np.zeros(0, np.int32), np.zeros((0, 2), np.float32))
        at = place.astype(np.float64) / SIDE + self.half
        plot = np.floor(at)
        rows, columns = self._index.shape
        x, z = plot.T
        number = (z * columns + x).astype(np.intp)
        within = (x >= 0) & (x < columns) & (z >= 0) & (z < rows)
        page = self._index.reshape(-1).take(number if within.all() else np.where(within, number, 0))
        which = np.flatnonzero((page >= 0) & within)
        return On(which, page[which], ((at - plot)[which] * CELLS).astype(np.float32))

    def on_lines(self, x: Floats, z: Floats, /) -> tuple[Ints, Ints, Ints]:
        """Return page (-1 for none), row and column on the page of the cell at each crossing of lines, (m, n, n).

        The lines of `x` (m, n) and of `z` (m, n) [m] cross on the map.
        """
        column, row = (np.floor(each / np.float32(CELL)).astype(np.int32) for each in (x, z))
        which = row // CELLS + self.half[1], column // CELLS + self.half[0]
        page = self.index[which[0][:, :, None], which[1][:, None, :]]
        return page, (row % CELLS)[:, :, None], (column % CELLS)[:, None, :]

    def nearest(self, on: On, /) -> Values:
        """Return the value of each place's cell, shape (m, ...)."""
        column, row = np.minimum(on.cell.astype(np.intp), CELLS - 1).T
        found: Values = self.pages[on.page, row, column]
        return found

    def between(self, on: On, channel: NDArray[np.intp] | None = None, /) -> Floats:
        """Return values interpolated bilinearly between cell centres: all channels (m, channels), or one each (m,).

        Within half a cell of a plot's edge, the outermost value holds.
        """
        at = np.clip(on.cell - np.float32(0.5), np.float32(0.0), np.float32(CELLS - 1))
        low = np.minimum(at.astype(np.intp), CELLS - 2)
        fraction = np.subtract(at, low, dtype=np.float32)
        (column, row), (right, down) = low.T, fraction.T
        number, flat, each = (on.page * CELLS + row) * CELLS + column, self.pages.reshape(-1), 1
        if channel is None:
            right, down, flat = right[:, None], down[:, None], self.pages.reshape(-1, *self.pages.shape[3:])
        elif self.pages.ndim > 3:
            each = self.pages.shape[3]
            number = number * each + channel
        a, b, c, d = (flat.take(number + each * more, axis=0).astype(np.float32) for more in (0, 1, CELLS, CELLS + 1))
        far, near = a + right * (b - a), c + right * (d - c)
        return np.asarray(far + down * (near - far), np.float32)

    def parts(self, low: Floats, high: Floats, /) -> list[Rectangle]:
        """Return the map's cells between two corners (x, z) [m], a part for each plot."""
        first = np.maximum(np.floor(np.asarray(low, np.float64) / CELL), np.multiply(self.half, -CELLS))
        last = np.minimum(np.ceil(np.asarray(high, np.float64) / CELL), np.multiply(self.half, CELLS))
        if not (first < last).all():
            return []
        (left, far), (right, near) = first.astype(int).tolist(), last.astype(int).tolist()
        columns, rows = _cut(left, right), _cut(far, near)
        return [Rectangle(row, column, down - row, over - column) for row, down in rows for column, over in columns]

    def within(self, low: Floats, high: Floats, /) -> list[Values | None]:
        """Return the values of cells between two corners (x, z) [m], plot by plot; None for plots not stored."""
        return [self.held(part) for part in self.parts(low, high)]

    def held(self, part: Rectangle, /) -> Values | None:
        """Return the values of a part that lies on one plot; None where that plot is not stored."""
        page = int(self.index[part.row // CELLS + self.half[1], part.column // CELLS + self.half[0]])
        inner = Rectangle(part.row % CELLS, part.column % CELLS, part.rows, part.columns)
        return self.pages[page][inner.slices] if page >= 0 else None

    def put(self, part: Rectangle, change: Callable[[Values], Values], untouched: Untouched, /) -> None:
        """Change the cells of a part that lies on one plot; `change` maps their values to the new ones."""
        row, column = part.row // CELLS, part.column // CELLS
        inner = Rectangle(part.row % CELLS, part.column % CELLS, part.rows, part.columns)
        plot = row + self.half[1], column + self.half[0]
        page = int(self.index[plot])
        whole = untouched(Rectangle(row * CELLS, column * CELLS, CELLS, CELLS)) if page < 0 else self.pages[page]
        before = whole[inner.slices]
        after = change(before)
        if (before == after).all():
            return
        self.note(part)
        if after.shape[:2] == (CELLS, CELLS) and (after == after[:1, :1]).all():
            self._share(plot, after)
            return
        own = page
        if page < 0 or self._uses[page] > 1 or self._is_alike(page):
            own = self._claim()
            self.pages[own] = whole
            self._give(plot, own)
        self.pages[own][inner.slices] = after
        self.written[own] = self.count

    def put_alike(self, part: Rectangle, values: Values, /) -> None:
        """Set all cells of a plot to one value, of shape (1, 1, ...); `part` covers the plot."""
        plot = part.row // CELLS + self.half[1], part.column // CELLS + self.half[0]
        if int(self.index[plot]) == self._alike.get(values.tobytes(), -2):
            return
        self.note(part)
        self._share(plot, values)

    def _is_alike(self, page: int) -> bool:
        return self._alike.get(self.pages[page, :1, :1].tobytes(), -1) == page

    def _share(self, plot: tuple[int, int], values: Values) -> None:
        """Give a plot, whose cells all have one value, the page that such plots share."""
        mark = values[:1, :1].tobytes()
        if mark not in self._alike:
            page = self._claim()
            self.pages[page], self._alike[mark], self.written[page] = values, page, self.count
        self._give(plot, self._alike[mark])

    def _give(self, plot: tuple[int, int], page: int) -> None:
        before = int(self.index[plot])
        if before == page:
            return
        self.index[plot] = page
        self._reach(plot[0], plot[0], plot[1], plot[1])
        self._uses[page] += 1
        if before >= 0:
            self._uses[before] -= 1
            if not self._uses[before]:
                if self._is_alike(before):
                    del self._alike[self.pages[before, :1, :1].tobytes()]
                self._free.append(before)

    def _reach(self, top: int, bottom: int, left: int, right: int) -> None:
        ends, (columns, rows) = self._ends, self.half
        ends[:2] = min(ends[0], top - rows), min(ends[1], left - columns)
        ends[2:] = max(ends[2], bottom - rows), max(ends[3], right - columns)

    def _claim(self) -> int:
        """Return the number of an unused page."""
        if self._free:
            return self._free.pop()
        page = len(self._uses)
        if page >= len(self.pages):
            more = np.empty((max(16, 2 * page), *self.pages.shape[1:]), self.pages.dtype)
            more[:page] = self.pages
            self.pages = more
        self._uses, self.written = np.append(self._uses, 0), np.append(self.written, 0)
        return page

    def touch(self, ends: Doubles, /) -> None:
        """Log a change of all cells between corners (x, z) [m], (n, 2, 2); of the whole map, where these are many."""
        parts = [part for low, high in ends[: MOST + 1] for part in self.parts(low, high)]
        self.count += max(len(parts), 1)
        if len(parts) > MOST:
            self.last.clear()
        else:
            self.last.extend(parts)

    def saved(self) -> tuple[Ints, Values]:
        """Return row, column and page of each stored plot, (n, 3), and the pages, renumbered from 0."""
        if self._index is None:
            return np.zeros((0, 3), np.int32), self.pages[:0]
        row, column = (self._index >= 0).nonzero()
        used, number = np.unique(self._index[row, column], return_inverse=True)
        where = np.stack([row - self.half[1], column - self.half[0], number.reshape(-1)], axis=1).astype(np.int32)
        return where, self.pages[used]

    def resume(self, where: Ints, pages: Values, /) -> None:
        """Restore what `saved` returned for a map of as many channels; plots off the terrain are left out.

        The number of pages does not shrink, and all of them count as written, so that caches read each page again.
        """
        if not (self.any or len(where)):
            return
        count = self.count + 1
        at = where[:, :2] + (self.half[1], self.half[0])
        kept = ((at >= 0) & (at < (2 * self.half[1], 2 * self.half[0]))).all(axis=1)
        most = max(len(pages), len(self.written))
        self._index, self._free, self._alike = None, [*range(len(pages), most)], {}
        self.pages, self.written = np.append(pages, self.pages[len(pages) : most], axis=0), np.full(most, count)
        self._uses, self._ends = np.bincount(where[kept, 2], minlength=most).astype(np.int64), self._no_ends
        if kept.any():
            self.index[at[kept, 0], at[kept, 1]] = where[kept, 2]
            (top, left), (bottom, right) = at[kept].min(axis=0).tolist(), at[kept].max(axis=0).tolist()
            self._reach(top, bottom, left, right)
        same = (pages == pages[:, :1, :1]).all(axis=tuple(range(1, pages.ndim)))
        self._alike = {pages[page, :1, :1].tobytes(): page for page in np.flatnonzero(same).tolist()}
        self.last.clear()
        self.count = count


def middles(part: Rectangle, /) -> Floats:
    """Return the middles of a part's cells (x, z) [m], shape (rows, columns, 2)."""
    place = np.empty((part.rows, part.columns, 2), np.float32)
    place[..., 0] = (part.column + 0.5 + np.arange(part.columns)) * CELL
    place[..., 1] = ((part.row + 0.5 + np.arange(part.rows)) * CELL)[:, None]
    return place


def ends_of(part: Rectangle, /) -> tuple[Floats, Floats]:
    """Return the lower and the upper corner (x, z) of a part [m]."""
    low = np.array([part.column, part.row], np.float32) * np.float32(CELL)
    return low, low + np.array([part.columns, part.rows], np.float32) * np.float32(CELL)


def _cut(first: int, last: int) -> list[tuple[int, int]]:
    """Split a range of cells along an axis at plot borders; return the first and end of each piece."""
    stops = [first, *range((first // CELLS + 1) * CELLS, last, CELLS), last]
    return list(pairwise(stops))
