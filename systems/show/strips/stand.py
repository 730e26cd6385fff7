"""Where the strips of a patch stand: planes of its model, turned with it, and stacked along an axis of the world.

`lib/stack.glsl` has the same for the graphics card.
"""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints
from .grow import Strips


def strip_edges(strips: Strips, columns: int, along: Ints, turn: Ints, /, *, patch: float) -> tuple[Floats, Ints]:
    """Return the feet of the strips' edges in patches turned by `turn` (m,) whose strips run along axis `along` (m,).

    The first array (m, strips, columns + 1, 2) holds positions in the patch, strips by rising place in their stack;
    the second (m, strips) says which of the model's planes each strip is.
    """
    count, own = len(strips.plane), (along + turn) % 2
    u = np.linspace(-strips.margin, patch + strips.margin, columns + 1, dtype=np.float32)
    # The edges of a strip and the planes of a patch lie evenly about its middle: a turn only counts them backwards.
    backwards = (turn == 2) | (turn == np.where(own == 0, 3, 1))
    run = np.where(backwards[:, None], u[::-1], u)[:, None, :]
    feet = np.empty((len(turn), count, columns + 1, 2), np.float32)
    for axis in (0, 1):
        feet[..., axis] = np.where((along == axis)[:, None, None], run, strips.plane[:, None])
    order = np.arange(count, dtype=np.int32)
    return feet, np.where(falls(own, along, turn)[:, None], order[::-1], order)


def falls(own: Ints, along: Ints, turn: Ints, /) -> NDArray[np.bool_]:
    """Return whether a model's planes fall along the axis that they are stacked on, shape (m,).

    `own` is the orientation that the model has them in, `along` the axis that they run along once it is turned.
    """
    return np.asarray(turn == np.where(own == 0, np.where(along == 0, 2, 1), np.where(along == 0, 3, 2)))
