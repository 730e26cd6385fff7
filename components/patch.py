"""Patches of grass and their level of detail."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """One square of the tiling (paper, section 2.2). Its arrays are one row of the `PatchTable`."""

    cell: NDArray[np.int32]
    """Cell (i, j) of the tiling; it covers [i, i + 1) by [j, j + 1) patch sides in x and z, shape (2,)."""

    model: NDArray[np.int32]
    """Which patch model stands here, shape (1,)."""

    turn: NDArray[np.int32]
    """Quarter turns of the model about the vertical axis, shape (1,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Lod:
    """The level of detail of a patch. Its arrays are one row of the `PatchTable`."""

    distance: NDArray[np.int32]
    """Discrete distance: 0 for the viewer's patch, 1 for its eight neighbours, and so on, shape (1,)."""

    representation: NDArray[np.int8]
    """The `Representation` that the patch has, or is coming to, shape (1,)."""

    previous: NDArray[np.int8]
    """The `Representation` that it comes from, shape (1,)."""

    progress: NDArray[np.float32]
    """How far the change has gone, 1 when it is over, shape (1,)."""

    visible: NDArray[np.bool_]
    """Whether the patch is inside the view cone, shape (1,)."""
