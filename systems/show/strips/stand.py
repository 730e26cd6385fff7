"""Where the strips of a patch stand: planes of its model, turned with it, and stacked along an axis of the world.

`lib/stack.glsl` has the same for the graphics card.
"""

import numpy as np
from numpy.typing import NDArray

from ...around.ground import turned
from .grow import Strips

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]


def strip_edges(strips: Strips, columns: int, along: Ints, turn: Ints, /, *, patch: float) -> tuple[Floats, Ints]:
    """Return the feet of the strips' edges in patches turned by `turn` (m,) whose strips run along axis `along` (m,).

    The first array (m, strips, columns + 1, 2) holds positions in the patch, strips by rising place in their stack;
    the second (m, strips) says which of the model's planes each strip is.
    """
    reach = np.linspace(-strips.margin, patch + strips.margin, columns + 1, dtype=np.float32)
    u, plane = np.broadcast_arrays(reach[None, :], strips.plane[:, None])
    own = (along + turn) % 2
    local = np.where(own[:, None, None, None] == 0, np.stack([u, plane], -1), np.stack([plane, u], -1))
    spun = turned(local, turn[:, None, None], patch=patch)
    stack = np.take_along_axis(spun[:, :, 0, :], (1 - along)[:, None, None], axis=2)[..., 0]
    order = np.argsort(stack, axis=1).astype(np.int32)
    return np.take_along_axis(spun, order[:, :, None, None], axis=1), order


def falls(own: Ints, along: Ints, turn: Ints, /) -> NDArray[np.bool_]:
    """Return whether a model's planes fall along the axis that they are stacked on, shape (m,).

    `own` is the orientation that the model has them in, `along` the axis that they run along once it is turned.
    """
    return np.asarray(turn == np.where(own == 0, np.where(along == 0, 2, 1), np.where(along == 0, 3, 2)))
