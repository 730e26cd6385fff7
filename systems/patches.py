"""The table of patches around a viewer."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..components.patch import Lod, Patch


@dataclass(frozen=True, slots=True, eq=False)
class PatchTable:
    """All patches of a prairie as one structure of arrays, one row per patch that exists.

    The rows form a square window around the viewer that wraps round: the patch of cell (i, j) is always at
    row (j mod side) * side + (i mod side), so that a step of the viewer replaces one line of rows.
    """

    side: int
    """Patches along the window's side."""

    cell: NDArray[np.int32]
    """Shape (rows, 2)."""

    alive: NDArray[np.bool_]
    """Whether the row's cell lies on the terrain, shape (rows,)."""

    model: NDArray[np.int32]
    """Shape (rows,)."""

    turn: NDArray[np.int32]
    """Shape (rows,)."""

    distance: NDArray[np.int32]
    """Shape (rows,)."""

    representation: NDArray[np.int8]
    """Shape (rows,)."""

    previous: NDArray[np.int8]
    """Shape (rows,)."""

    progress: NDArray[np.float32]
    """Shape (rows,)."""

    visible: NDArray[np.bool_]
    """Shape (rows,)."""

    height: NDArray[np.float32]
    """Height of the ground in the patch's middle [m], shape (rows,)."""

    slope: NDArray[np.float32]
    """Rise of the ground there along x and z, shape (rows, 2)."""

    message: NDArray[np.float32]
    """The wind's message at the patch's middle, without small oscillations: the carpet's receiver, shape (rows, 2)."""

    sublevel: NDArray[np.int8]
    """How fine blades and strips are, or are coming to be: the blades' ring; twice the strips' ring and the axis that
    they run along, 0 for x; -1 for none yet, shape (2, rows)."""

    sublevel_before: NDArray[np.int8]
    """The sub-levels that they come from, shape (2, rows)."""

    sublevel_progress: NDArray[np.float32]
    """How far these changes have gone, 1 when they are over, shape (2, rows)."""

    entity: NDArray[np.int64]
    """The patch's entity, 0 where there is none, shape (rows,)."""

    @classmethod
    def allocate(cls, side: int) -> "PatchTable":
        """Return an empty table for a window of `side` by `side` patches."""
        rows = side * side
        return cls(
            side=side,
            cell=np.full((rows, 2), np.iinfo(np.int32).min, np.int32),
            alive=np.zeros(rows, np.bool_),
            model=np.zeros(rows, np.int32),
            turn=np.zeros(rows, np.int32),
            distance=np.zeros(rows, np.int32),
            representation=np.full(rows, -1, np.int8),
            previous=np.full(rows, -1, np.int8),
            progress=np.ones(rows, np.float32),
            visible=np.zeros(rows, np.bool_),
            height=np.zeros(rows, np.float32),
            slope=np.zeros((rows, 2), np.float32),
            message=np.zeros((rows, 2), np.float32),
            sublevel=np.full((2, rows), -1, np.int8),
            sublevel_before=np.full((2, rows), -1, np.int8),
            sublevel_progress=np.ones((2, rows), np.float32),
            entity=np.zeros(rows, np.int64),
        )

    def patch(self, row: int) -> Patch:
        """Return the `Patch` component of one row: views, not copies."""
        only = slice(row, row + 1)
        return Patch(cell=self.cell[row], model=self.model[only], turn=self.turn[only])

    def lod(self, row: int) -> Lod:
        """Return the `Lod` component of one row: views, not copies."""
        only = slice(row, row + 1)
        return Lod(
            distance=self.distance[only],
            representation=self.representation[only],
            previous=self.previous[only],
            progress=self.progress[only],
            visible=self.visible[only],
        )


NOWHERE = np.iinfo(np.int32).min
"""Stamp of a slot on which nothing stands."""
