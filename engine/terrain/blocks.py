"""Ground without an edge: heights of a function, computed in blocks on demand, and cached."""

from collections.abc import Callable
from dataclasses import dataclass, field
from logging import getLogger
from threading import RLock
from typing import Any

import numpy as np

from ...components.arrays import Doubles, Floats, Ints, Mask
from .errors import MapError

BLOCK = 64
"""Number of cells along a side of a block, which the function is called for as a whole."""

SQUARE = 16
"""Number of samples along a side of the squares in which changes are stored."""

REACH = 16384.0
"""Greatest distance of ground from the origin along x and z [m]: single precision resolves a millimetre there."""

PARTS = 8
"""Ratio of a window's width to the steps in which it moves."""

APART = 5
"""Distance between the samples of a changed square that tell where it lay [samples]: 4 by 4 of them, edges included."""

SPARE = 512
"""Number of cached blocks beyond those of a window."""

Numbers = tuple[int, int]
"""Row and column of a sample, block or square, counted from the origin: negative towards -z and -x."""

Piece = tuple[Floats, Mask | None]
"""Heights [m], and a mask of holes if there are any."""

Ask = Callable[[Doubles, Doubles], Piece]
"""Returns the heights on a grid of columns at x and rows at z [m]; raises `MapError` where it cannot."""

_log = getLogger(__name__)


@dataclass(eq=False)
class Blocks:
    """The blocks of an endless ground: the function's heights, cached, and the squares that a game has changed."""

    ask: Ask
    cell: float
    """Metres per cell."""

    cells: int
    """Number of cells along a side of a window, `PARTS` times a multiple of `BLOCK`."""

    changed: dict[Numbers, tuple[Floats, Mask]] = field(default_factory=dict)
    """Heights and holes of each square that a game has changed."""

    lies: dict[Numbers, Floats] = field(default_factory=dict)
    """Samples of changed squares by the function, `lie` of each: far off it need not be asked again to save them."""

    known: dict[Numbers, Piece] = field(default_factory=dict)
    """Cache of blocks as the function returned them."""

    tiles: dict[Numbers, Any] = field(default_factory=dict)
    """Cache of terrains of single blocks, with the game's changes; emptied by each change."""

    lock: RLock = field(default_factory=RLock)
    loads: bool = True
    """Whether the scene is still being loaded; only then are errors of the function raised."""

    failed: set[Numbers] = field(default_factory=set)
    """Blocks for which the function has failed, so that they are level."""

    _has_told: bool = False
    """Whether a failure was logged."""

    @property
    def step(self) -> int:
        """Number of cells by which a window moves."""
        return self.cells // PARTS

    @property
    def most(self) -> int:
        """Number of the last sample to each side of the origin."""
        return int(REACH / self.cell)

    def first_about(self, x: float, z: float, /) -> Numbers:
        """Return the first sample of the window around a place [m]."""
        row, column = (round(min(max(at, -REACH), REACH) / self.cell / self.step) * self.step for at in (z, x))
        return row - self.cells // 2, column - self.cells // 2

    def block(self, row: int, column: int, /) -> Piece:
        """Return a block by the function, up to the first samples of the next blocks: (BLOCK + 1, BLOCK + 1)."""
        with self.lock:  # also keeps the function from being called by two threads at once
            if (row, column) not in self.known:
                z, x = (np.arange(BLOCK * at, BLOCK * (at + 1) + 1) * self.cell for at in (row, column))
                if len(self.known) > (self.cells // BLOCK) ** 2 + 2 * SPARE:
                    del self.known[next(iter(self.known))]
                try:
                    self.known[row, column] = self.ask(np.asarray(x, np.float64), np.asarray(z, np.float64))
                except MapError as error:
                    self._fail(error)
                    self.failed.add((row, column))
                    self.known[row, column] = np.zeros((len(z), len(x)), np.float32), None
            return self.known[row, column]

    def _fail(self, error: MapError) -> None:
        """Raise an error of the function while the scene is being loaded, and log the first one later."""
        if self.loads:
            raise error
        if not self._has_told:
            _log.warning("the ground is level where its function fails: %s", error)
        self._has_told = True

    def forget(self, first: Numbers) -> None:
        """Drop cached blocks outside of the window that begins at `first`, but for the newest `SPARE`.

        Those that have failed are dropped in any case: once the viewer comes back, the function is asked again.
        """
        low, high = (np.floor_divide(first, BLOCK) + more for more in (0, self.cells // BLOCK))
        with self.lock:
            outside = [at for at in self.known if not all(a <= n < b for n, a, b in zip(at, low, high, strict=True))]
            for at in {*outside[: max(len(outside) - SPARE, 0)], *self.failed.intersection(outside)}:
                del self.known[at]
                if at in self.failed:
                    self.failed.remove(at)
                    self.tiles.pop(at, None)

    def square(self, square: Numbers, /) -> tuple[Floats, Mask]:
        """Return copies of a square's present heights and holes."""
        found = self.changed.get(square) or self.original_square(square)
        return found[0].copy(), found[1].copy()

    def original_square(self, square: Numbers, /) -> tuple[Floats, Mask]:
        """Return heights and holes of a square by the function, without changes."""
        per_block = BLOCK // SQUARE
        heights, holes = self.block(square[0] // per_block, square[1] // per_block)
        inner = tuple(slice(SQUARE * (at % per_block), SQUARE * (at % per_block + 1)) for at in square)
        return heights[inner], np.zeros((SQUARE, SQUARE), np.bool_) if holes is None else holes[inner]

    def lie(self, square: Numbers, /) -> Floats:
        """Return samples of a square's heights by the function [m], NaN in holes, shape (16,)."""
        if square not in self.lies:
            heights, holes = self.original_square(square)
            self.lies[square] = np.where(holes, np.float32(np.nan), heights)[::APART, ::APART].ravel()
        return self.lies[square]

    def put(self, square: Numbers, now: tuple[Floats, Mask] | None, /) -> None:
        """Set a square's heights and holes; None restores those of the function."""
        with self.lock:
            self.tiles.clear()
            if now is None:
                self.changed.pop(square, None)
            else:
                self.changed[square] = now

    def at(self, place: Floats, /) -> Ints:
        """Return row and column of the block that each place (n, 2) [m] lies on, (n, 2)."""
        side = BLOCK * self.cell
        return np.floor(place[:, ::-1].astype(np.float64).clip(-REACH, REACH) / side).astype(np.int32)
