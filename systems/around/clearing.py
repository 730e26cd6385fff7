"""Clearings: patches whose grass a game has taken away."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ...components.patch import Cell


class Clearings:
    """The cells whose grass is taken away, for all viewers and at any distance from them."""

    def __init__(self) -> None:
        self._cells: set[Cell] = set()
        self.version = 0
        """A number that differs after every change."""

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
        """Clear these cells and no others, as a saved state says."""
        self._cells = set(cells)
        self.version += 1

    def spare(self, cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which cells (n, 2) keep their grass, shape (n,)."""
        if not self._cells:
            return np.ones(len(cells), np.bool_)
        cleared = _keys(np.array(list(self._cells), np.int64))
        return np.isin(_keys(cells.astype(np.int64)), cleared, invert=True)


def _keys(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return a unique number for each cell (n, 2), shape (n,)."""
    return cells[:, 0] << 32 ^ cells[:, 1] & 0xFFFFFFFF
