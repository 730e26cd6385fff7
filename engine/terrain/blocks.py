"""Ground without an edge: a function's heights, asked for in blocks when anybody needs them, and forgotten again."""

from collections.abc import Callable
from dataclasses import dataclass, field
from logging import getLogger
from threading import RLock
from typing import Any

import numpy as np

from ...components.arrays import Doubles, Floats, Ints, Mask
from .errors import MapError

BLOCK = 64
"""Cells along a side of what is asked for at a time."""

SQUARE = 16
"""Samples along a side of the squares that changes are kept by."""

REACH = 16384.0
"""How far from the origin ground can be [m]: single precision parts a millimetre there."""

PARTS = 8
"""A window is that many times as wide as the steps that it moves by."""

SPARE = 512
"""Blocks that are remembered besides those of a window."""

Numbers = tuple[int, int]
"""Row and column, of samples, blocks or squares: counted from the origin, to -z and -x below 0."""

Piece = tuple[Floats, Mask | None]
"""Heights [m], and where there are holes if there are any."""

Ask = Callable[[Doubles, Doubles], Piece]
"""Gives the heights where columns at x and rows at z [m] meet; raises `MapError` where it cannot."""

_log = getLogger(__name__)


@dataclass(eq=False)
class Blocks:
    """The blocks of an endless ground, as they were asked for, and what a game has changed of it."""

    ask: Ask
    cell: float
    """Metres per cell."""

    cells: int
    """Cells along a side of a window, `PARTS` times a multiple of `BLOCK`."""

    changed: dict[Numbers, tuple[Floats, Mask]] = field(default_factory=dict)
    """Heights and holes of each square that a game has changed, by its numbers."""

    known: dict[Numbers, Piece] = field(default_factory=dict)
    """What is remembered of what was asked for."""

    tiles: dict[Numbers, Any] = field(default_factory=dict)
    """The ground of single blocks, with all that has been changed of it, as it was asked for since."""

    lock: RLock = field(default_factory=RLock)
    loads: bool = True
    """Whether it is being loaded: then what the function does wrong is raised."""

    _failed: bool = False

    @property
    def step(self) -> int:
        """Cells by which a window moves."""
        return self.cells // PARTS

    @property
    def most(self) -> int:
        """The number of the last sample to each side."""
        return int(REACH / self.cell)

    def first_about(self, x: float, z: float, /) -> Numbers:
        """Return the first sample of the window about a place [m]."""
        row, column = (round(min(max(at, -REACH), REACH) / self.cell / self.step) * self.step for at in (z, x))
        return row - self.cells // 2, column - self.cells // 2

    def block(self, row: int, column: int, /) -> Piece:
        """Return a block as the function gives it, with the first samples of the next ones: (BLOCK + 1, BLOCK + 1)."""
        with self.lock:  # nor is the function asked twice at a time
            if (row, column) not in self.known:
                z, x = (np.arange(BLOCK * at, BLOCK * (at + 1) + 1) * self.cell for at in (row, column))
                if len(self.known) > (self.cells // BLOCK) ** 2 + 2 * SPARE:
                    del self.known[next(iter(self.known))]
                self.known[row, column] = self._asked(np.asarray(x, np.float64), np.asarray(z, np.float64))
            return self.known[row, column]

    def _asked(self, x: Doubles, z: Doubles) -> Piece:
        try:
            return self.ask(x, z)
        except MapError as error:
            if self.loads:
                raise
            if not self._failed:
                _log.warning("the ground is level where its function fails: %s", error)
            self._failed = True
            return np.zeros((len(z), len(x)), np.float32), None

    def forget(self, first: Numbers) -> None:
        """Forget blocks, but for those of a window and some others."""
        low, high = (np.floor_divide(first, BLOCK) + more for more in (0, self.cells // BLOCK))
        with self.lock:
            away = [at for at in self.known if not all(a <= own < b for own, a, b in zip(at, low, high, strict=True))]
            for at in away[: max(len(away) - SPARE, 0)]:
                del self.known[at]

    def square(self, square: Numbers, /) -> tuple[Floats, Mask]:
        """Return heights and holes of a square as they are by now, copies."""
        found = self.changed.get(square) or self.as_asked(square)
        return found[0].copy(), found[1].copy()

    def as_asked(self, square: Numbers, /) -> tuple[Floats, Mask]:
        """Return heights and holes of a square as the function gives them."""
        each = BLOCK // SQUARE
        heights, holes = self.block(square[0] // each, square[1] // each)
        own = tuple(slice(SQUARE * (at % each), SQUARE * (at % each + 1)) for at in square)
        return heights[own], np.zeros((SQUARE, SQUARE), np.bool_) if holes is None else holes[own]

    def put(self, square: Numbers, now: tuple[Floats, Mask] | None, /) -> None:
        """Let a square be that from now on; None is as the function gives it."""
        with self.lock:
            self.tiles.clear()
            if now is None:
                self.changed.pop(square, None)
            else:
                self.changed[square] = now

    def at(self, place: Floats, /) -> Ints:
        """Return the block that each place (n, 2) [m] lies on, row and column, (n, 2)."""
        side = BLOCK * self.cell
        return np.floor(place[:, ::-1].astype(np.float64).clip(-REACH, REACH) / side).astype(np.int32)
