"""Packing pictures of many sizes into pages of one size: the layers of a texture."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

WHOLE = 16
"""Pictures begin at multiples of so many texels, so that texels of the finest mip-maps are of one picture alone. Others
show several, which are of one kind."""

SPARE = 4
"""Texels around what is painted that are empty: there the edges of blades are seen, and no other picture's."""

GLSL = {"WHOLE": float(WHOLE), "SPARE": float(SPARE)}

ROWS, MOST_PAGES = 512, 256
"""Texels up, of a page: so much is sent to a graphics card at a time. And pages: OpenGL promises no more."""

WIDTHS = range(512, 1025, 16)
"""Texels across that a page may have: the least that OpenGL promises, at most."""

LOWER = 0.75
"""How high a picture is at least, of the shelf that it stands on."""


@dataclass(frozen=True, slots=True, eq=False)
class Pages:
    """Where pictures stand."""

    places: NDArray[np.int64]
    """Of each picture its page, its first row and its first column, (n, 3)."""

    shape: tuple[int, int, int]
    """How many pages there are; rows and columns of each."""


def packed(sizes: NDArray[np.int64], kinds: NDArray[np.int64], /) -> Pages:
    """Return pages for pictures of these sizes (n, 2), rows and columns, and kinds (n,): those that take least room."""
    whole = -(-sizes // WHOLE) * WHOLE
    widest = int(whole[:, 1].max())
    each = (_packed(whole, kinds, max(width, widest)) for width in WIDTHS)
    return min(each, key=lambda pages: np.prod(pages.shape))


def _packed(sizes: NDArray[np.int64], kinds: NDArray[np.int64], width: int) -> Pages:
    shelf, column, heights = _shelved(sizes, kinds, width)
    count = min(-(-sum(heights) // max(ROWS, *heights)), MOST_PAGES)
    rows = -(-sum(heights) // (count * WHOLE)) * WHOLE
    while (stacks := _stacked(heights, count, rows)) is None:
        rows += WHOLE
    places = np.column_stack([np.array(stacks)[shelf], column])
    return Pages(places, (count, rows, width))


def _shelved(
    sizes: NDArray[np.int64], kinds: NDArray[np.int64], width: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], list[int]]:
    """Return the shelf that each picture stands on, its first column there, and how high each shelf is."""
    shelf, column, heights = np.zeros(len(sizes), np.int64), np.zeros(len(sizes), np.int64), list[int]()
    ends, owners = list[int](), list[int]()
    for number in np.lexsort((-sizes[:, 1], -sizes[:, 0])):
        (high, wide), kind = sizes[number].tolist(), int(kinds[number])
        fits = (
            at
            for at, (end, owner) in enumerate(zip(ends, owners, strict=True))
            if owner == kind and end + wide <= width and high >= LOWER * heights[at]
        )
        at = next(fits, len(ends))
        if at == len(ends):
            ends.append(0)
            heights.append(high)
            owners.append(kind)
        shelf[number], column[number] = at, ends[at]
        ends[at] += wide
    return shelf, column, heights


def _stacked(heights: list[int], count: int, rows: int) -> list[tuple[int, int]] | None:
    """Return the page of each shelf, from the highest on, and its first row; None where so many pages are too few."""
    filled, stacks = [0] * count, []
    for high in heights:
        page = next((page for page, end in enumerate(filled) if end + high <= rows), None)
        if page is None:
            return None
        stacks.append((page, filled[page]))
        filled[page] += high
    return stacks
