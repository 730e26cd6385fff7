"""What feet and wheels wear off: the densities under many small rectangles, thinned together."""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles, Floats
from ...engine.terrain.plots import CELL, CELLS, Values
from ...engine.terrain.record import Density
from ...engine.terrain.rectangle import Rectangle
from ...engine.terrain.sample import painted_at
from .sown import painted_densities

_TOGETHER = 2**18
"""Number of cells whose coverage is computed together: 2 MB for each of their numbers."""


class Step(NamedTuple):
    """A rectangle of ground that something goes over."""

    x: float
    z: float
    """Middle of the edge at which it begins [m]."""

    ahead_x: float
    ahead_z: float
    """Direction of the way, a unit vector."""

    half: float
    """Half its width [m]."""

    length: float
    """Its length along the way [m]."""

    wear: float
    """Fraction of the grass that is worn off."""


class _Worn(NamedTuple):
    """Cells that steps cover, one a row."""

    cell: NDArray[np.int64]
    """Row and column of the cell, from the world's origin, shape (m, 2)."""

    step: NDArray[np.intp]
    """Index of the step, shape (m,)."""

    weight: Floats
    """Part of the cell that the step covers, shape (m,)."""


def wear(density: Density, steps: Sequence[Step], /) -> None:
    """Lower all densities under each step by a fraction of themselves, at least by 1/255, one step after the other.

    A cell at an edge takes part as far as the step covers it.
    """
    if not steps:
        return
    numbers = np.array(steps, np.float64)
    worn = _Worn(*map(np.concatenate, zip(*_worn_cells(numbers, density), strict=True)))
    if not len(worn.cell):
        return
    order = np.lexsort((worn.step, worn.cell[:, 1], worn.cell[:, 0]))
    cell, step, weight = worn.cell[order], worn.step[order], worn.weight[order]
    begins = np.flatnonzero(np.append(True, (cell[1:] != cell[:-1]).any(axis=1)))
    which = np.repeat(np.arange(len(begins)), np.diff(np.append(begins, len(cell))))
    rank, fraction = np.arange(len(cell)) - begins[which], numbers[step, -1].astype(np.float32)
    before = _densities(density, cell[begins])
    after = before.copy()
    for number in range(int(rank.max()) + 1):  # a cell's first step, then its second, and so on
        now = np.flatnonzero(rank == number)
        after[which[now]] = _thinned(after[which[now]], fraction[now], weight[now])
    changed = (after != before).any(axis=1)
    _write(density, cell[begins][changed], after[changed])


def _worn_cells(steps: Doubles, density: Density) -> Iterator[_Worn]:
    """Yield the cells on the map that steps cover, those of steps of alike extents together."""
    middle = steps[:, :2] + 0.5 * steps[:, 5:6] * steps[:, 2:4]
    along, across = 0.5 * steps[:, 5:6] * np.abs(steps[:, 2:4]), steps[:, 4:5] * np.abs(steps[:, 3:1:-1])
    reach = along + across + 0.5 * CELL
    first = np.floor((middle - reach) / CELL)
    extent = (np.ceil((middle + reach) / CELL) - first).max(axis=1)
    side = 2 ** np.ceil(np.log2(extent)).astype(int)
    for size in np.unique(side).tolist():
        alike, together = np.flatnonzero(side == size), max(_TOGETHER // size**2, 1)
        for begin in range(0, len(alike), together):
            which = alike[begin : begin + together]
            yield _covered(steps[which], middle[which], first[which].astype(np.int64), size, which, density)


def _covered(
    steps: Doubles, middle: Doubles, first: NDArray[np.int64], size: int, which: NDArray[np.intp], density: Density
) -> _Worn:
    """Return the cells that steps cover, out of squares of `size` cells from the `first` ones (column, row) on."""
    column, row = (first[:, axis, None] + np.arange(size) for axis in (0, 1))
    x, z = ((number + 0.5) * CELL - middle[:, axis, None] for axis, number in enumerate((column, row)))
    (ahead_x, ahead_z), half, length = steps[:, 2:4].T[:, :, None, None], steps[:, 4], steps[:, 5]
    along = np.abs(x[:, None] * ahead_x + z[:, :, None] * ahead_z) - 0.5 * length[:, None, None]
    aside = np.abs(z[:, :, None] * ahead_x - x[:, None] * ahead_z) - half[:, None, None]
    off = np.hypot(np.maximum(along, 0.0), np.maximum(aside, 0.0)) + np.minimum(np.maximum(along, aside), 0.0)
    weight = np.clip(0.5 - off / CELL, 0.0, 1.0).astype(np.float32)
    right, down = (CELLS * half for half in density.sown.half)
    weight *= ((column >= -right) & (column < right))[:, None] & ((row >= -down) & (row < down))[:, :, None]
    step, i, j = np.nonzero(weight)
    return _Worn(np.stack([row[step, i], column[step, j]], axis=1), which[step], weight[step, i, j])


def _thinned(before: Bytes, fraction: Floats, weight: Floats) -> Bytes:
    """Return densities (m, kinds) [1/255] lowered by a fraction of themselves, at least by 1, with a weight each."""
    densities = before.astype(np.float32)
    target = np.minimum(densities * (np.float32(1.0) - fraction[:, None]), densities - np.float32(1.0))
    densities += weight[:, None] * (np.maximum(target, np.float32(0.0)) - densities)
    return np.asarray(np.rint(densities), np.uint8)


def _densities(density: Density, cell: NDArray[np.int64]) -> Bytes:
    """Return the densities of cells (m, 2), shape (m, kinds) [1/255]."""
    plots = density.sown
    (row, column), (right, down) = cell.T, plots.half
    page = plots.index[row // CELLS + down, column // CELLS + right]
    found: Bytes = np.empty((len(cell), len(density.maps)), np.uint8)
    is_stored = page >= 0
    found[is_stored] = plots.pages[page[is_stored], row[is_stored] % CELLS, column[is_stored] % CELLS]
    if not is_stored.all():
        place = (cell[~is_stored, ::-1] + 0.5) * CELL
        found[~is_stored] = np.rint(painted_at(density, place.astype(np.float32)).T * 255.0)
    return found


def _write(density: Density, cell: NDArray[np.int64], densities: Bytes) -> None:
    """Store the densities (m, kinds) of cells (m, 2), plot by plot."""
    untouched = partial(painted_densities, density)
    plots, which = np.unique(cell // CELLS, axis=0, return_inverse=True)
    for number in range(len(plots)):
        on = which.reshape(-1) == number
        low, high = cell[on].min(axis=0), cell[on].max(axis=0) + 1
        part = Rectangle(*low.tolist(), *(high - low).tolist())
        density.sown.put(part, partial(_replaced, at=cell[on] - low, values=densities[on]), untouched)


def _replaced(before: Values, *, at: NDArray[np.int64], values: Bytes) -> Values:
    """Return values of cells with some replaced, at these rows and columns (m, 2)."""
    after = before.copy()
    after[at[:, 0], at[:, 1]] = values
    return after
