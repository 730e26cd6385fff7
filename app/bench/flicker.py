"""Flicker: how much more a picture changes from one frame to the next than the truth does, and where it does most.

A change of one patch is lost in the mean over a whole picture, and in single pixels it is lost in the shimmer of thin
grass, which is another in every frame. So pictures are low-passed as the eye does, and their differences are averaged
over tiles, not over the whole.
"""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ..studio.encode import Picture

TILE = 20
"""Pixels along a side of a tile: about as high as a patch that changes from blades to strips, in 360 lines."""

MARGIN = 8
"""Pixels at the picture's borders that are left out: what comes into view there was not held."""

LEAST = 1.0
"""Flicker that counts as none: one of 255 steps of brightness, the least that a screen can show."""


def low_passed(picture: NDArray[np.generic], /) -> Floats:
    """Return a picture (height, width, 3) as means over squares of 3 pixels, shape (height - 2, width - 2, 3).

    That is about what an eye averages that sees 67 pixels to a degree, FLIP's own distance from the screen.
    """
    whole = picture.astype(np.uint16)  # nine bytes and their sum fit
    rows = whole[:-2] + whole[1:-1] + whole[2:]
    return np.asarray((rows[:, :-2] + rows[:, 1:-1] + rows[:, 2:]) * np.float32(1.0 / 9.0))


def tiles(difference: Floats, /) -> Floats:
    """Return the mean size of a low-passed difference (height, width, 3) in each tile, shape (rows, columns)."""
    size = np.abs(difference[MARGIN:-MARGIN, MARGIN:-MARGIN])
    rows, columns = size.shape[0] // TILE, size.shape[1] // TILE
    blocks = size[: rows * TILE, : columns * TILE].reshape(rows, TILE, columns, 3 * TILE)
    return np.asarray(blocks.mean(axis=(1, 3)), np.float32)


def change_of_tile(now: Picture, before: Picture, true_now: Picture, true_before: Picture, /) -> float:
    """Return how far a tile's change is from the truth's [steps of 255].

    All four are sRGB, a tile and the pixels around it, (TILE + 2, TILE + 2, 3).
    """
    seen = low_passed(now) - low_passed(before)
    return float(np.abs(seen - (low_passed(true_now) - low_passed(true_before))).mean())


def step(now: Floats, held: Floats, /) -> Floats:
    """Return in each tile how much changes of representation changed a frame, in steps of 255, shape (rows, columns).

    `held` is the same frame without them; both are low-passed.
    """
    return tiles(now - held)


def prominence(stepped: Floats, held: Floats, before: Floats, /) -> Floats:
    """Return in each tile the step (rows, columns) in terms of what changes there anyway, in the same shape.

    That is what changes from the frame before to the frame held, both low-passed.
    """
    return np.asarray(stepped / np.maximum(tiles(held - before), LEAST))
