"""Pairs of a thing and something of it, all listed: cells of rectangles, crossings of rays, discs above places."""

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Ints


def numbered(counts: NDArray[np.integer], /) -> tuple[Ints, Ints]:
    """Return the thing of each row and its number within that, (m,) each; `counts` (n,) are each thing's rows."""
    which = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
    return which, np.arange(len(which), dtype=np.int32) - (np.cumsum(counts, dtype=np.int32) - counts)[which]


def cells_between(first: Ints, last: Ints, /) -> tuple[Ints, Ints, Ints]:
    """Return all pairs of a rectangle and a cell in it, row by row: rectangle, column and row of each, (m,).

    The rectangles reach from the cells `first` to the cells `last`, both (column, row), shape (n, 2).
    """
    across, down = (last - first + 1).T
    which, number = numbered(across * down)
    wide = across[which]
    row = number // wide
    return which, first[:, 0][which] + number - row * wide, first[:, 1][which] + row
