"""Trees of density on ground of any size: square by square, the same whichever squares are asked for."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Ints, Mask
from ...engine.declared.tree import TreeKind
from ...engine.random import hash3, stream, unit

SQUARE = 64.0
"""Side of a square [m]; squares count from the origin, along x and z."""

CANDIDATES = 0.7
"""Side of a cell with one candidate, relative to the square root of the ground that density gives a tree."""

SAME_CELL, LEAST_RIVALS = 0.55, 0.02
"""Area of the disc of rivals within a candidate's own cell, about, and least number of rivals [cells]."""

Share = Callable[[Floats], Floats]
"""Function from ground positions (n, 2) [m] to densities relative to the greatest, in [0, 1], shape (n,)."""


@dataclass(frozen=True, slots=True)
class Squares:
    """Squares that are asked for: those `wanted` from a corner on."""

    corner: tuple[int, int]
    """First square (i, j), along x and z."""

    wanted: Mask
    """Mask of squares, shape (along x, along z)."""


@dataclass(frozen=True)
class Scatter:
    """Trees of one kind, scattered by density.

    A lattice of cells lies over the ground, each with one candidate place. The density says how many candidates are
    drawn; of two nearer than the kind's spacing, the one drawn first stays (Matérn, Spatial Variation, 1960: his second
    hard-core process).
    """

    kind: TreeKind
    seed: int
    share: Share
    densest: float
    """Density where `share` is 1, relative to the kind's."""

    level: int = 0
    """Cells and squares are 2 to this power times as long, and a tree stands for as many as would stand on its cell."""

    @cached_property
    def spacing(self) -> float:
        """Least distance between trees [m]."""
        return self.kind.spacing * 2.0**self.level

    @cached_property
    def cell(self) -> float:
        """Side of a cell [m]."""
        each = 1e4 / (self.densest * self.kind.density)
        return max(self.kind.spacing, CANDIDATES * float(np.sqrt(each))) * 2.0**self.level

    def drawn(self, share: Floats) -> Doubles:
        """Return the probability to draw a candidate, such that those that stay have the right density."""
        wanted = share * self.densest * self.kind.density * 1e-4 * (self.cell / 2.0**self.level) ** 2
        rivals = max(np.pi * (self.spacing / self.cell) ** 2 - SAME_CELL, LEAST_RIVALS)
        return np.asarray(-np.log1p(-np.minimum(rivals * wanted, 0.999)) / rivals)

    def within(self, squares: Squares, /) -> tuple[Floats, Ints]:
        """Return the places (n, 2) [m] of the trees in squares, and the square of each (n, 2)."""
        side = SQUARE * 2.0**self.level
        low = np.array(squares.corner, np.float64) * side
        high = low + np.array(squares.wanted.shape) * side
        first = np.floor(low / self.cell).astype(np.int64) - 2
        size = np.ceil(high / self.cell).astype(np.int64) + 2 - first
        lines = [first[axis] + np.arange(size[axis]) for axis in (0, 1)]
        square_of = [
            np.floor((line + 0.5) * self.cell / side).astype(np.int64) - corner
            for line, corner in zip(lines, squares.corner, strict=True)
        ]
        inside = [(each >= 0) & (each < count) for each, count in zip(square_of, squares.wanted.shape, strict=True)]
        index = [np.where(keep, each, 0) for keep, each in zip(inside, square_of, strict=True)]
        wanted_cell = squares.wanted[np.ix_(*index)] & inside[0][:, None] & inside[1][None, :]
        near = wanted_cell.copy()
        for axis in (0, 1):
            near |= np.roll(near, 1, axis) | np.roll(near, -1, axis)
        return self._thinned(lines, wanted_cell, near, square_of, squares.corner)

    def _thinned(
        self,
        lines: list[NDArray[np.int64]],
        wanted_cell: Mask,
        near: Mask,
        square_of: list[NDArray[np.int64]],
        corner: tuple[int, int],
    ) -> tuple[Floats, Ints]:
        i, j = near.nonzero()
        hashed = hash3(self.seed + 1000 * self.level, lines[0][i], lines[1][j])
        x = (lines[0][i] + unit(stream(hashed, 1)).astype(np.float64)) * self.cell
        z = (lines[1][j] + unit(stream(hashed, 2)).astype(np.float64)) * self.cell
        place = np.stack([x, z], axis=1).astype(np.float32)
        chance = unit(stream(hashed, 3)).astype(np.float64)
        drawn = chance < self.drawn(self.share(place))
        priority = np.full(near.shape, np.inf)  # the lower stays; places not drawn never do
        priority[i, j] = np.where(drawn, unit(stream(hashed, 4)), np.inf)
        position = np.zeros((*near.shape, 2), np.float32)
        position[i, j] = place
        stays = wanted_cell & np.isfinite(priority)
        i, j = stays.nonzero()
        kept = np.ones(len(i), np.bool_)
        for right in (-1, 0, 1):
            for down in (-1, 0, 1):
                if right or down:
                    other = i + right, j + down
                    close = ((position[other] - position[i, j]) ** 2).sum(axis=1) < self.spacing**2
                    kept &= ~(close & (priority[other] < priority[i, j]))
        i, j = i[kept], j[kept]
        square = np.stack([square_of[0][i] + corner[0], square_of[1][j] + corner[1]], axis=1)
        return position[i, j], square.astype(np.int32)


def apart(place: Floats, others: Floats, least: float, /) -> Mask:
    """Return which places (n, 2) are at least a distance [m] from all others (m, 2), shape (n,)."""
    free = np.ones(len(place), np.bool_)
    if not len(others):
        return free
    cell = np.floor(others.astype(np.float64) / least).astype(np.int64)
    key = (cell[:, 0] << 32) + cell[:, 1]
    order = np.argsort(key, kind="stable")
    key, others = key[order], others[order]
    place_cell = np.floor(place.astype(np.float64) / least).astype(np.int64)
    for right in (-1, 0, 1):
        for down in (-1, 0, 1):
            asked = ((place_cell[:, 0] + right) << 32) + place_cell[:, 1] + down
            first, last = np.searchsorted(key, asked, "left"), np.searchsorted(key, asked, "right")
            for number in range(int((last - first).max(initial=0))):
                which = np.flatnonzero(first + number < last)
                near = ((others[first[which] + number] - place[which]) ** 2).sum(axis=1) < least * least
                free[which[near]] = False
    return free
