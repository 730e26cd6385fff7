"""Pools of the 2.5D strips around a viewer. Every vertical edge of a strip is a receiver."""

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
    """Return the feet of strips' edges in a patch, and the plane of each strip; `lib/stack.glsl` is the twin.

    `turn` (m,) are the patches' quarter turns, `along` (m,) the axes that their strips run along. The feet have shape
    (m, strips, columns + 1, 2) [m]: strips by rising distance along the axis that they are stacked on. The planes
    (m, strips) are indices into those of the model.
    """
    count, orientation = len(strips.plane), (along + turn) % 2
    u = np.linspace(-strips.margin, patch + strips.margin, columns + 1, dtype=np.float32)
    # The edges of a strip and the planes of a patch are symmetric about its middle: a turn only reverses their order.
    runs_back = (turn == 2) | (turn == np.where(orientation == 0, 3, 1))
    run = np.where(runs_back[:, None], u[::-1], u)[:, None, :]
    feet = np.empty((len(turn), count, columns + 1, 2), np.float32)
    for axis in (0, 1):
        feet[..., axis] = np.where((along == axis)[:, None, None], run, strips.plane[:, None])
    order = np.arange(count, dtype=np.int32)
    return feet, np.where(is_reversed(orientation, along, turn)[:, None], order[::-1], order)


def is_reversed(orientation: Ints, along: Ints, turn: Ints, /) -> NDArray[np.bool_]:
    """Return whether the order of a model's planes is reversed along the axis that they are stacked on, shape (m,).

    `orientation` is that of the strips in the model, `along` the axis that they run along on the turned patch.
    """
    return np.asarray(turn == np.where(orientation == 0, np.where(along == 0, 2, 1), np.where(along == 0, 3, 2)))


@dataclass(slots=True, eq=False)
class StripPool:
    """The strips of one ring of 2.5D patches, with a slot for each patch and orientation.

    The slots of patches whose strips run along x come first, then those with strips along z. Each half is a window of
    `side` by `side` patches that wraps round. Strips are counted by rising distance along the axis that they are
    stacked on (+z or +x). Their positions are computed on demand.
    """

    side: int
    """Number of patches along the window's side."""

    strips: list[Strips]
    """Strips by kind, of the kind's first model; the planes are the same in all its models."""

    columns: int
    """Number of polygon strips side by side in each strip."""

    patch: float
    """Side of a patch [m]."""

    stamp: NDArray[np.int32] = field(init=False)
    """Cell (i, j) of the patch planted in each slot, and the axis that its strips run along, shape (slots, 3)."""

    model_and_turn: NDArray[np.int32] = field(init=False)
    """Model and number of quarter turns of each slot's patch, shape (slots, 2)."""

    present: NDArray[np.bool_] = field(init=False)
    """Whether each kind grows on the patch, shape (slots, kinds)."""

    least: Floats = field(init=False)
    """Lowest density on each slot's patch, of the kinds that grow there, shape (slots,)."""

    edged: NDArray[np.bool_] = field(init=False)
    """Whether the density of any kind changes abruptly on the patch, shape (slots,)."""

    def __post_init__(self) -> None:
        slots = 2 * self.side * self.side
        self.stamp = np.full((slots, 3), NOWHERE, np.int32)
        self.stamp[:, 2] = 0  # a valid axis, so that `places` works for empty slots too
        self.model_and_turn = np.zeros((slots, 2), np.int32)
        self.present = np.zeros((slots, len(self.strips)), np.bool_)
        self.least, self.edged = np.zeros(slots, np.float32), np.zeros(slots, np.bool_)

    @property
    def slots(self) -> int:
        """Number of slots."""
        return len(self.stamp)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of a slot's receivers: (kinds, strips, edges)."""
        return len(self.strips), len(self.strips[0].plane), self.columns + 1

    def places(self, slots: NDArray[np.int64], /) -> Floats:
        """Return the feet (x, z) [m] of the edges of some slots, shape (m, kinds, strips, columns + 1, 2)."""
        along, turn = self.stamp[slots, 2], self.model_and_turn[slots, 1]
        corner = self.stamp[slots, :2].astype(np.float32) * np.float32(self.patch)
        local = [strip_edges(strips, self.columns, along, turn, patch=self.patch)[0] for strips in self.strips]
        return (np.stack(local, axis=1) + corner[:, None, None, None, :]).astype(np.float32)

    def kind(self, slots: NDArray[np.int64], /) -> NDArray[np.intp]:
        """Return the kind of each receiver of some slots, one slot after another, shape (n,)."""
        kinds, strips, edges = self.shape
        return np.tile(np.repeat(np.arange(kinds), strips * edges), len(slots))

    def grows(self, slots: NDArray[np.int64], cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return whether grass grows at each edge of some slots that are to hold these cells (m, 2), shape (n,)."""
        planted = (self.stamp[slots, :2] == cells).all(axis=1)
        kinds = (self.present[slots] & planted[:, None])[..., None, None]
        return np.broadcast_to(kinds, (len(slots), *self.shape)).reshape(-1)


class StripsKept(Kept):
    """The pools of strips around one viewer, one for each ring."""

    def __init__(self, pools: list[StripPool], name: str) -> None:
        super().__init__([Receiving(pool, name) for pool in pools])
        self.pools = pools

    def sow_on(self, cells: Ints, /) -> None:
        """Mark the strips on these cells (n, 2) to be planted anew."""
        for pool in self.pools:
            rows = window_rows(cells, side=pool.side)
            stamp = pool.stamp.reshape(2, -1, 3)
            along, index = np.nonzero((stamp[:, rows, :2] == cells).all(axis=2))
            stamp[along, rows[index], :2] = NOWHERE
