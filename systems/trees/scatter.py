"""Where density brings trees on ground of any size: square by square, the same whichever squares are asked for."""

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
"""Side of a cell in which one tree may stand, of that of the ground which density gives one."""

OWN, LEAST = 0.55, 0.02
"""How much of the disc in which others are too near lies in a tree's own cell, about, and what counts at least
[cells]."""

Share = Callable[[Floats], Floats]
"""Gives how many of the trees of density there are at ground positions (n, 2) [m], of all, in [0, 1], shape (n,)."""


@dataclass(frozen=True, slots=True)
class Squares:
    """Squares of the ground that are asked for: `wanted` of those from a corner on."""

    corner: tuple[int, int]
    """Numbers of the first square, along x and z."""

    wanted: Mask
    """Which of them, shape (along x, along z)."""


@dataclass(frozen=True)
class Scatter:
    """One kind of tree, as density brings it.

    A lattice of cells lies over the ground, and each has a place where a tree may stand. As many of those are drawn as
    the density says, and of two that are nearer than the kind's spacing the one stays that was drawn first (Matérn,
    Spatial Variation, 1960: his second process of hard cores).
    """

    kind: TreeKind
    seed: int
    share: Share
    more: float
    """How many times the density grows where `share` is 1."""

    level: int = 0
    """Cells and squares are 2 to this power times as long, and a tree stands for as many as would stand on its cell."""

    @cached_property
    def least(self) -> float:
        """The distance from tree to tree [m]."""
        return self.kind.spacing * 2.0**self.level

    @cached_property
    def cell(self) -> float:
        """Side of a cell [m]."""
        each = 1e4 / (self.more * self.kind.density)
        return max(self.kind.spacing, CANDIDATES * float(np.sqrt(each))) * 2.0**self.level

    def drawn(self, share: Floats) -> Doubles:
        """Return the part of places that is drawn, so that of those which stay there are so many."""
        due = share * self.more * self.kind.density * 1e-4 * (self.cell / 2.0**self.level) ** 2
        crowd = max(np.pi * (self.least / self.cell) ** 2 - OWN, LEAST)
        return np.asarray(-np.log1p(-np.minimum(crowd * due, 0.999)) / crowd)

    def within(self, squares: Squares, /) -> tuple[Floats, Ints]:
        """Return the places (n, 2) [m] of the trees in squares, and the numbers of those squares (n, 2)."""
        side = SQUARE * 2.0**self.level
        low = np.array(squares.corner, np.float64) * side
        high = low + np.array(squares.wanted.shape) * side
        first = np.floor(low / self.cell).astype(np.int64) - 2
        size = np.ceil(high / self.cell).astype(np.int64) + 2 - first
        lines = [first[axis] + np.arange(size[axis]) for axis in (0, 1)]
        of = [
            np.floor((line + 0.5) * self.cell / side).astype(np.int64) - at
            for line, at in zip(lines, squares.corner, strict=True)
        ]
        inside = [(each >= 0) & (each < count) for each, count in zip(of, squares.wanted.shape, strict=True)]
        at = [np.where(keep, each, 0) for keep, each in zip(inside, of, strict=True)]
        own = squares.wanted[np.ix_(*at)] & inside[0][:, None] & inside[1][None, :]
        near = own.copy()
        for axis in (0, 1):
            near |= np.roll(near, 1, axis) | np.roll(near, -1, axis)
        return self._thinned(lines, own, near, of, squares.corner)

    def _thinned(
        self,
        lines: list[NDArray[np.int64]],
        own: Mask,
        near: Mask,
        of: list[NDArray[np.int64]],
        corner: tuple[int, int],
    ) -> tuple[Floats, Ints]:
        i, j = near.nonzero()
        hashed = hash3(self.seed + 1000 * self.level, lines[0][i], lines[1][j])
        x = (lines[0][i] + unit(stream(hashed, 1)).astype(np.float64)) * self.cell
        z = (lines[1][j] + unit(stream(hashed, 2)).astype(np.float64)) * self.cell
        place = np.stack([x, z], axis=1).astype(np.float32)
        chance = unit(stream(hashed, 3)).astype(np.float64)
        drawn = chance < self.drawn(self.share(place))
        first = np.full(near.shape, np.inf)  # who comes first stays; who is not drawn, never
        first[i, j] = np.where(drawn, unit(stream(hashed, 4)), np.inf)
        at = np.zeros((*near.shape, 2), np.float32)
        at[i, j] = place
        stays = own & np.isfinite(first)
        i, j = stays.nonzero()
        kept = np.ones(len(i), np.bool_)
        for right in (-1, 0, 1):
            for down in (-1, 0, 1):
                if right or down:
                    other = i + right, j + down
                    close = ((at[other] - at[i, j]) ** 2).sum(axis=1) < self.least**2
                    kept &= ~(close & (first[other] < first[i, j]))
        i, j = i[kept], j[kept]
        return at[i, j], np.stack([of[0][i] + corner[0], of[1][j] + corner[1]], axis=1).astype(np.int32)


def apart(place: Floats, others: Floats, least: float, /) -> Mask:
    """Return which places (n, 2) are at least so far [m] from all others (m, 2), shape (n,)."""
    free = np.ones(len(place), np.bool_)
    if not len(others):
        return free
    cell = np.floor(others.astype(np.float64) / least).astype(np.int64)
    key = (cell[:, 0] << 32) + cell[:, 1]
    order = np.argsort(key, kind="stable")
    key, others = key[order], others[order]
    own = np.floor(place.astype(np.float64) / least).astype(np.int64)
    for right in (-1, 0, 1):
        for down in (-1, 0, 1):
            asked = ((own[:, 0] + right) << 32) + own[:, 1] + down
            first, last = np.searchsorted(key, asked, "left"), np.searchsorted(key, asked, "right")
            for number in range(int((last - first).max(initial=0))):
                which = np.flatnonzero(first + number < last)
                near = ((others[first[which] + number] - place[which]) ** 2).sum(axis=1) < least * least
                free[which[near]] = False
    return free
