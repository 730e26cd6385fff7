"""What is known of the 2.5D strips around a viewer, and where they stand; an edge of one is a receiver."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints
from ...around.kept import Kept
from ...around.patches import NOWHERE
from ...around.receivers import Receiving
from ...space.window import window_rows
from .grow import Strips


def strip_edges(strips: Strips, columns: int, along: Ints, turn: Ints, /, *, patch: float) -> tuple[Floats, Ints]:
    """Return the feet of the strips' edges in patches turned by `turn` (m,) whose strips run along axis `along` (m,).

    The first array (m, strips, columns + 1, 2) holds positions in the patch, strips by rising place in their stack;
    the second (m, strips) says which of the model's planes each strip is. `lib/stack.glsl` has the same.
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


@dataclass(frozen=True, slots=True, eq=False)
class StripPool:
    """The strips of one ring of 2.5D patches, one slot per patch and orientation; an edge is a receiver.

    The slots of patches whose strips run along x come first, then those of strips along z; each form a window that
    wraps round. Strips are counted by rising distance along their stacking axis (+z or +x). Where they stand is
    reckoned when it is asked for.
    """

    side: int
    """Patches along the window's side."""

    strips: list[Strips]
    """By kind, strips whose planes hold for all the kind's models."""

    columns: int
    """Polygon strips side by side in each strip."""

    patch: float
    """Side of a patch [m]."""

    stamp: NDArray[np.int32] = field(init=False)
    """Cell (i, j) and orientation that each slot is planted for, shape (slots, 3)."""

    stand: NDArray[np.int32] = field(init=False)
    """Model and quarter turns of each slot's patch, shape (slots, 2)."""

    present: NDArray[np.bool_] = field(init=False)
    """Whether the kind grows on the patch at all, shape (slots, kinds)."""

    least: Floats = field(init=False)
    """Density at each slot's thinnest edge, of the kinds that grow there at all, shape (slots,)."""

    edged: NDArray[np.bool_] = field(init=False)
    """Whether the density of any kind changes much on the patch, shape (slots,)."""

    def __post_init__(self) -> None:
        slots = 2 * self.side * self.side
        stamp = np.full((slots, 3), NOWHERE, np.int32)
        stamp[:, 2] = 0  # so that it can be asked where anything is, planted or not
        for name, value in (
            ("stamp", stamp),
            ("stand", np.zeros((slots, 2), np.int32)),
            ("present", np.zeros((slots, len(self.strips)), np.bool_)),
            ("least", np.zeros(slots, np.float32)),
            ("edged", np.zeros(slots, np.bool_)),
        ):
            object.__setattr__(self, name, value)

    @property
    def slots(self) -> int:
        """How many slots there are."""
        return len(self.stamp)

    @property
    def shape(self) -> tuple[int, ...]:
        """How the receivers of a slot are laid out: kinds, strips, edges."""
        return len(self.strips), len(self.strips[0].plane), self.columns + 1

    def places(self, slots: NDArray[np.int64], /) -> Floats:
        """Return the feet (x, z) [m] of the edges of some slots, shape (m, kinds, strips, columns + 1, 2)."""
        along, turn = self.stamp[slots, 2], self.stand[slots, 1]
        corner = self.stamp[slots, :2].astype(np.float32) * np.float32(self.patch)
        local = [strip_edges(strips, self.columns, along, turn, patch=self.patch)[0] for strips in self.strips]
        return (np.stack(local, axis=1) + corner[:, None, None, None, :]).astype(np.float32)

    def kind(self, slots: NDArray[np.int64], /) -> NDArray[np.intp]:
        """Return the kind that each receiver of some slots is of, one row after another."""
        kinds, strips, edges = self.shape
        return np.tile(np.repeat(np.arange(kinds), strips * edges), len(slots))

    def grows(self, slots: NDArray[np.int64], cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which edges of some slots stand in grass that grows on these cells (m, 2), shape (n,)."""
        planted = (self.stamp[slots, :2] == cells).all(axis=1)
        kinds = (self.present[slots] & planted[:, None])[..., None, None]
        return np.broadcast_to(kinds, (len(slots), *self.shape)).reshape(-1)


class StripsKept(Kept):
    """The strips around one viewer, a pool for each ring."""

    def __init__(self, pools: list[StripPool], name: str) -> None:
        super().__init__([Receiving(pool, name) for pool in pools])
        self.pools = pools

    def sow_on(self, cells: Ints, /) -> None:
        """Plant strips anew of patches on these cells."""
        for pool in self.pools:
            rows = window_rows(cells, side=pool.side)
            stamp = pool.stamp.reshape(2, -1, 3)
            along, which = np.nonzero((stamp[:, rows, :2] == cells).all(axis=2))
            stamp[along, rows[which], :2] = NOWHERE
