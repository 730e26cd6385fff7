"""Packing pictures of many sizes into pages of one size, the layers of a texture."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

ALIGNMENT = 16
"""Multiple that pictures begin at [texels]: texels of the finest mip levels belong to one picture alone, and coarser
ones mix several pictures, all of one kind."""

SPARE = 4
"""Width of the empty border around what is painted [texels]: it keeps the edges of blades free of other pictures."""

GLSL = {"ALIGNMENT": float(ALIGNMENT), "SPARE": float(SPARE)}

ROWS, MOST_PAGES = 512, 256
"""Height of a page [texels], as a page is uploaded at a time; and largest number of pages that OpenGL promises."""

WIDTHS = range(512, 1025, 16)
"""Widths that a page may have [texels], at most what OpenGL promises."""

LEAST_HEIGHT = 0.75
"""Least height of a picture, as a fraction of the height of its shelf."""


@dataclass(frozen=True, slots=True, eq=False)
class Pages:
    """Places of pictures on pages."""

    places: NDArray[np.int64]
    """Page, first row and first column of each picture, shape (n, 3)."""

    shape: tuple[int, int, int]
    """Number of pages; rows and columns of a page."""


def packed(sizes: NDArray[np.int64], kinds: NDArray[np.int64], /) -> Pages:
    """Return the pages of least area for pictures of these kinds (n,) and sizes (n, 2): rows, columns."""
    aligned = -(-sizes // ALIGNMENT) * ALIGNMENT
    widest = int(aligned[:, 1].max())
    candidates = (_packed(aligned, kinds, max(width, widest)) for width in WIDTHS)
    return min(candidates, key=lambda pages: np.prod(pages.shape))


def _packed(sizes: NDArray[np.int64], kinds: NDArray[np.int64], width: int) -> Pages:
    """Return pages of this width: pictures of a kind stand side by side on shelves, and shelves are stacked."""
    shelf, column, heights = _shelved(sizes, kinds, width)
    count = min(-(-sum(heights) // max(ROWS, *heights)), MOST_PAGES)
    rows = -(-sum(heights) // (count * ALIGNMENT)) * ALIGNMENT
    while (stacks := _stacked(heights, count, rows)) is None:
        rows += ALIGNMENT
    places = np.column_stack([np.array(stacks)[shelf], column])
    return Pages(places, (count, rows, width))


def _shelved(
    sizes: NDArray[np.int64], kinds: NDArray[np.int64], width: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], list[int]]:
    """Return the shelf of each picture (n,), its first column there (n,), and the height of each shelf."""
    shelf, column, heights = np.zeros(len(sizes), np.int64), np.zeros(len(sizes), np.int64), list[int]()
    ends, owners = list[int](), list[int]()
    for number in np.lexsort((-sizes[:, 1], -sizes[:, 0])):
        (high, wide), kind = sizes[number].tolist(), int(kinds[number])
        fitting = (
            candidate
            for candidate, (end, owner) in enumerate(zip(ends, owners, strict=True))
            if owner == kind and end + wide <= width and high >= LEAST_HEIGHT * heights[candidate]
        )
        found = next(fitting, len(ends))
        if found == len(ends):
            ends.append(0)
            heights.append(high)
            owners.append(kind)
        shelf[number], column[number] = found, ends[found]
        ends[found] += wide
    return shelf, column, heights


def _stacked(heights: list[int], count: int, rows: int) -> list[tuple[int, int]] | None:
    """Return the page and the first row of each shelf; None if `count` pages of this many rows do not hold them all."""
    filled, stacks = [0] * count, []
    for high in heights:
        page = next((page for page, end in enumerate(filled) if end + high <= rows), None)
        if page is None:
            return None
        stacks.append((page, filled[page]))
        filled[page] += high
    return stacks
