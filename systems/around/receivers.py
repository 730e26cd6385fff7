"""Receivers: where the messages of many patches are kept, and what a game writes into them."""

import logging
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...components.receivers import Receivers
from ...engine.world import World
from .patches import PatchTable

Floats = NDArray[np.float32]
Rows = NDArray[np.int64]

log = logging.getLogger("tallgrass")


class Pool(Protocol):
    """Receivers of one representation around a viewer, a slot for each patch."""

    @property
    def message(self) -> Floats:
        """Their messages, shape (slots, ..., 2)."""

    def places(self, slots: Rows, /) -> Floats:
        """Return the ground positions (x, z) [m] of the receivers of some slots, shape (m, ..., 2)."""

    def kind(self, slots: Rows, /) -> NDArray[np.intp]:
        """Return the kind of grass of each receiver of some slots, one slot after another, shape (n,)."""

    def grows(self, slots: Rows, cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which receivers of some slots have grass that grows on these cells (m, 2), shape (n,)."""


@dataclass(slots=True, eq=False)
class Correspondence:
    """The messages of a pool: which were asked for by a game, and what it has written since.

    Only slots that were asked for are looked through; the others cost nothing.
    """

    message: Floats
    """The pool's messages, shape (slots, ..., 2)."""

    _left: dict[int, Floats] = field(default_factory=dict)
    """For each slot that was asked for, its messages at the end of the frame before, shape (n, 2)."""

    _written: dict[int, tuple[NDArray[np.bool_], Floats]] = field(default_factory=dict)
    """For each slot, which receivers a game has written to, and what; once delivered, what the wind told them."""

    _told: bool = False

    def ask(self, slot: int, /) -> Floats:
        """Return the messages of a slot, shape (n, 2), to be read and written; from now on what is written counts."""
        flat: Floats = self.message[slot].reshape(-1, 2)
        if slot not in self._left:
            self._left[slot] = flat.copy()
        return flat

    @property
    def busy(self) -> bool:
        """Whether any slot was asked for."""
        return bool(self._left)

    def forget(self, slot: int, /) -> None:
        """Forget that a slot was asked for, because another patch stands there now."""
        self._left.pop(slot, None)
        self._written.pop(slot, None)

    def collect(self) -> None:
        """Keep what a game has written, before the wind writes over it."""
        self._written.clear()
        for slot, left in self._left.items():
            now = self.message[slot].reshape(-1, 2)
            changed = (now != left).any(axis=1)
            if changed.any():
                self._written[slot] = changed, self._valid(now[changed])

    def deliver(self) -> None:
        """Write what a game has written over what the wind has said."""
        for slot, (changed, value) in self._written.items():
            now = self.message[slot].reshape(-1, 2)
            heard = now[changed]
            now[changed] = value
            self._written[slot] = changed, heard
        self._leave()

    def settle(self) -> None:
        """Put the wind's own messages back after the frame is drawn: what a game writes holds for one frame."""
        for slot, (changed, heard) in self._written.items():
            self.message[slot].reshape(-1, 2)[changed] = heard
        self._written.clear()
        self._leave()

    def _leave(self) -> None:
        for slot, left in self._left.items():
            left[:] = self.message[slot].reshape(-1, 2)

    def check(self) -> None:
        """Mend what systems have written since: a message is finite and at most 1 long."""
        for slot in self._left:
            now = self.message[slot].reshape(-1, 2)
            now[:] = self._valid(now)

    def _valid(self, message: Floats) -> Floats:
        """Return messages as they may be: finite, which is told of once where they were not, and at most 1 long."""
        if not np.isfinite(message).all():
            if not self._told:
                log.warning("messages of receivers must be finite numbers; those that are not were taken for no wind")
            self._told = True
            message = np.where(np.isfinite(message), message, np.float32(0.0))
        index = np.hypot(*message.T.astype(np.float64))
        # A length that is over 1 by rounding alone is left as it is: reading messages must not change a picture.
        return np.asarray(message / np.where(index > 1.0 + 1e-6, index, 1.0)[:, None], np.float32)


class Receiving:
    """The receivers of one pool: those that hear the wind in this frame, and their entities.

    There is an entity with `Receivers` for every slot whose patch is shown. It goes when another patch is planted
    there, or the patch is no longer shown in that representation.
    """

    BATCH = 200
    """Most entities made in one frame: otherwise a frame takes long when a viewer leaps."""

    def __init__(self, pool: Pool, representation: str, *, still: bool = False) -> None:
        self.pool = pool
        self.representation = representation
        self.still = still
        """Whether they take no part in the small oscillations."""
        self.letters = Correspondence(pool.message)
        self.rows: Rows = np.zeros(0, np.int64)
        """Rows of the patch table of those that hear in this frame, shape (m,)."""
        self.slots: Rows = np.zeros(0, np.int64)
        """Their slots, shape (m,)."""
        self._owner = np.zeros(len(pool.message), np.int64)
        self._entity = np.zeros(len(pool.message), np.int64)

    def show(self, rows: Rows, slots: Rows, /) -> None:
        """Let the receivers of these patches hear the wind in this frame."""
        self.rows, self.slots = rows, slots

    def enlist(self, world: World, patches: PatchTable, /) -> None:
        """Create and delete entities so that they are those of the patches shown now."""
        owner = np.zeros_like(self._owner)
        owner[self.slots] = patches.entity[self.rows]
        changed = np.flatnonzero(owner != self._owner)
        if not changed.size:
            return
        for slot in changed[self._entity[changed] != 0].tolist():
            self._delete(world, slot)
        self._owner[changed] = 0
        fresh = changed[owner[changed] != 0][: self.BATCH]
        for slot in fresh.tolist():
            self._entity[slot] = world.create(self.component(slot, viewer=patches.viewer, patch=int(owner[slot])))
        self._owner[fresh] = owner[fresh]

    def component(self, slot: int, /, *, viewer: str, patch: int) -> Receivers:
        """Return the component that stands for the receivers of a slot."""
        return Receivers(self.letters, self.pool, slot, patch=patch, representation=self.representation, viewer=viewer)

    def lose(self) -> None:
        """Take note that all entities are gone."""
        self._owner[:] = self._entity[:] = 0

    def release(self, world: World, /) -> None:
        """Delete all of its entities."""
        for slot in np.flatnonzero(self._entity).tolist():
            self._delete(world, slot)
        self._owner[:] = 0

    def _delete(self, world: World, slot: int) -> None:
        world.delete(int(self._entity[slot]))
        self._entity[slot] = 0
        self.letters.forget(slot)
