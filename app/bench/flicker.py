"""Flicker: how much more a picture changes from one frame to the next than the truth does, and where it does most.

A change of one patch is lost in the mean over a whole picture, and in a single pixel it is lost in the shimmer of
thin grass, which is another in every frame. So differences are low-passed first, and then averaged over tiles.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Picture = NDArray[np.uint8]

CELLS = 90
"""Cells that a picture's height is cut into; two of them side by side are what the low-pass averages."""

TILE = 5
"""Cells along a side of a tile."""

MARGIN = 2
"""Cells at the picture's borders that are left out: what comes into view there was not held."""

LEAST = 0.25
"""Flicker that counts as nothing: a part of one of 255 steps of brightness."""


def low_passed(picture: NDArray[np.generic], /) -> Floats:
    """Return a picture (height, width, 3) as means over squares of 2 cells, one cell apart, (rows, columns, 3)."""
    height, width = picture.shape[:2]
    cell = max(1, height // CELLS)
    whole = picture[: height // cell * cell, : width // cell * cell].astype(np.float32)
    small = whole.reshape(height // cell, cell, width // cell, cell, 3).mean(axis=(1, 3))
    pairs = (small[1:] + small[:-1]) / 2
    return np.asarray((pairs[:, 1:] + pairs[:, :-1]) / 2, np.float32)


def tiles(difference: Floats, /) -> Floats:
    """Return the mean size of a low-passed difference (rows, columns, 3) in each tile, shape (m, n)."""
    size = np.abs(difference).mean(axis=2)[MARGIN : len(difference) - MARGIN, MARGIN : -MARGIN or None]
    rows, columns = (side // TILE for side in size.shape)
    if not (rows and columns):
        raise ValueError("a picture this small has no tiles")
    blocks = size[: rows * TILE, : columns * TILE].reshape(rows, TILE, columns, TILE)
    return np.asarray(blocks.mean(axis=(1, 3)), np.float32)


def flicker(now: Picture, before: Picture, true_now: Picture, true_before: Picture, /) -> Floats:
    """Return in each tile how far a picture's change is from the truth's, in steps of 255, shape (m, n).

    All four are sRGB, (height, width, 3).
    """
    return tiles((low_passed(now) - low_passed(before)) - (low_passed(true_now) - low_passed(true_before)))


def step(now: Picture, held: Picture, /) -> Floats:
    """Return in each tile how much changes of representation changed a frame, in steps of 255, shape (m, n).

    `held` is the same frame without them.
    """
    return tiles(low_passed(now) - low_passed(held))


def prominence(now: Picture, held: Picture, before: Picture, /) -> float:
    """Return how prominent the largest step in a frame is, in terms of what moves there anyway."""
    return float((step(now, held) / np.maximum(tiles(low_passed(held) - low_passed(before)), LEAST)).max())
