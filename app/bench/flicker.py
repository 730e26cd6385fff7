"""Flicker: how much a picture's change from frame to frame differs from the reference's, tile by tile.

The change of one patch is lost in the mean over a whole picture. In single pixels it is lost in the shimmer of thin
grass, which differs in every frame. So pictures are low-passed as by the eye, and differences are averaged over tiles.
"""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ..studio.encode import Picture

TILE = 20
"""Side of a tile [pixels]: about the height of a patch that changes from blades to strips, in 360 lines."""

MARGIN = 8
"""Width of the picture's border that is left out [pixels]: what comes into view there was not held."""

LEAST = 1.0
"""Flicker below which none is visible: one of the 255 steps of brightness that a screen can show."""


def low_passed(picture: NDArray[np.generic], /) -> Floats:
    """Return the means of a picture (height, width, 3) over 3 x 3 pixels, shape (height - 2, width - 2, 3).

    That is about what the eye averages at 67 pixels per degree, the viewing distance that FLIP assumes.
    """
    whole = picture.astype(np.uint16)  # nine bytes and their sum fit
    rows = whole[:-2] + whole[1:-1] + whole[2:]
    return np.asarray((rows[:, :-2] + rows[:, 1:-1] + rows[:, 2:]) * np.float32(1.0 / 9.0))


def tiles(difference: Floats, /) -> Floats:
    """Return the mean absolute value of a low-passed difference (height, width, 3) per tile, shape (rows, columns)."""
    absolute = np.abs(difference[MARGIN:-MARGIN, MARGIN:-MARGIN])
    rows, columns = absolute.shape[0] // TILE, absolute.shape[1] // TILE
    blocks = absolute[: rows * TILE, : columns * TILE].reshape(rows, TILE, columns, 3 * TILE)
    return np.asarray(blocks.mean(axis=(1, 3)), np.float32)


def change_of_tile(now: Picture, before: Picture, true_now: Picture, true_before: Picture, /) -> float:
    """Return the mean difference between a tile's change and the reference's change [steps of 255].

    All four are sRGB pictures of a tile and one pixel around it, (TILE + 2, TILE + 2, 3).
    """
    seen = low_passed(now) - low_passed(before)
    return float(np.abs(seen - (low_passed(true_now) - low_passed(true_before))).mean())


def step(now: Floats, held: Floats, /) -> Floats:
    """Return how much changes of representation altered each tile of a frame [steps of 255], shape (rows, columns).

    `held` is the same frame without these changes; both are low-passed.
    """
    return tiles(now - held)


def prominence(stepped: Floats, held: Floats, before: Floats, /) -> Floats:
    """Return each tile's step (rows, columns) relative to what changes there anyway, in the same shape.

    That is the change from the frame `before` to the frame `held`, both low-passed.
    """
    return np.asarray(stepped / np.maximum(tiles(held - before), LEAST))
