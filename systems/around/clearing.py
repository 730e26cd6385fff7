"""Clearings: patches whose grass a game has taken away."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ...components.patch import Cell


class Clearings:
    """The cells without grass, for every viewer alike, however far it has gone meanwhile."""

    def __init__(self) -> None:
        self._cells: set[Cell] = set()
        self.version = 0
        """A number that is another one after every change."""

    def __contains__(self, cell: object) -> bool:
        return cell in self._cells

    def clear(self, cell: Cell, /) -> None:
        """Take the grass of a cell away."""
        self._cells.add(cell)
        self.version += 1

    def restore(self, cell: Cell, /) -> None:
        """Give the grass of a cell back."""
        self._cells.discard(cell)
        self.version += 1

    @property
    def cells(self) -> frozenset[Cell]:
        """The cells that are cleared."""
        return frozenset(self._cells)

    def resume(self, cells: Iterable[Cell], /) -> None:
        """Let just these cells be cleared."""
        self._cells = set(cells)
        self.version += 1

    def spare(self, cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return whether grass grows on each of some cells (n, 2), shape (n,)."""
        if not self._cells:
            return np.ones(len(cells), np.bool_)
        cleared = _keys(np.array(list(self._cells), np.int64))
        return np.isin(_keys(cells.astype(np.int64)), cleared, invert=True)


def _keys(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return a number for each cell (n, 2) that no other has, shape (n,)."""
    return cells[:, 0] << 32 ^ cells[:, 1] & 0xFFFFFFFF
