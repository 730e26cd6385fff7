"""The pools of 2.5D strips, and of the receivers at their edges."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...around.patches import NOWHERE
from ...around.receivers import Receiving
from ...around.representation import Kept

Floats = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class StripPool:
    """The strips of one ring of 2.5D patches, one slot per patch and orientation; an edge is a receiver.

    The slots of patches whose strips run along x come first, then those of strips along z; each form a window that
    wraps round. Strips are stored by rising distance along their stacking axis (+z or +x).
    """

    side: int
    """Patches along the window's side."""

    place: Floats
    """Feet of the vertical edges (x, z) [m], shape (2 * side * side, kinds, strips, columns + 1, 2)."""

    ground: Floats
    """Height of the ground under each edge [m], shape (2 * side * side, kinds, strips, columns + 1)."""

    message: Floats
    """Receivers' messages, shape (2 * side * side, kinds, strips, columns + 1, 2)."""

    layer: Floats
    """Layer of the texture array, shape (2 * side * side, kinds, strips)."""

    present: NDArray[np.bool_]
    """Whether the kind grows on the patch at all, shape (2 * side * side, kinds)."""

    least: Floats
    """Density at each slot's thinnest edge, of the kinds that grow there at all, shape (2 * side * side,)."""

    stamp: NDArray[np.int32]
    """Cell (i, j) and orientation that each slot is planted for, shape (2 * side * side, 3)."""

    def places(self, slots: NDArray[np.int64], /) -> Floats:
        """Return the feet (x, z) [m] of the edges of some slots, shape (m, kinds, strips, columns + 1, 2)."""
        return self.place[slots]

    def kind(self, slots: NDArray[np.int64], /) -> NDArray[np.intp]:
        """Return the kind that each receiver of some slots is of, one row after another."""
        _, kinds, strips, edges = self.ground.shape
        return np.tile(np.repeat(np.arange(kinds), strips * edges), len(slots))

    def grows(self, slots: NDArray[np.int64], cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which edges of some slots stand in grass that grows on these cells (m, 2), shape (n,)."""
        planted = (self.stamp[slots, :2] == cells).all(axis=1)
        kinds = (self.present[slots] & planted[:, None])[..., None, None]
        return np.broadcast_to(kinds, (len(slots), *self.ground.shape[1:])).reshape(-1)

    @classmethod
    def allocate(cls, side: int, kinds: int, strips: int, columns: int) -> "StripPool":
        """Return an empty pool for a window of `side` by `side` patches, in either orientation."""
        shape = (2 * side * side, kinds, strips)
        return cls(
            side=side,
            place=np.zeros((*shape, columns + 1, 2), np.float32),
            ground=np.zeros((*shape, columns + 1), np.float32),
            message=np.zeros((*shape, columns + 1, 2), np.float32),
            layer=np.zeros(shape, np.float32),
            present=np.zeros(shape[:2], np.bool_),
            least=np.zeros(2 * side * side, np.float32),
            stamp=np.full((2 * side * side, 3), NOWHERE, np.int32),
        )


class StripsKept(Kept):
    """The strips around one viewer, a pool for each ring."""

    def __init__(self, pools: list[StripPool], name: str) -> None:
        super().__init__([Receiving(pool, name) for pool in pools])
        self.pools = pools
