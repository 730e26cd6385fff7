"""Receivers: their messages, as the wind sends them and as a game overwrites them, and their entities."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import zip_longest
from math import prod
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Rows
from ...components.receivers import Places, Receivers
from ...engine.world import World
from .patches import PatchTable

NOT_FINITE = "messages of receivers must be finite numbers; those that are not were taken for no wind"

log = logging.getLogger("tallgrass")


class Pool(Places, Protocol):
    """Receivers of one representation around a viewer, with a slot for each patch."""

    @property
    def slots(self) -> int:
        """Number of slots."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array of a slot's receivers."""

    def grows(self, slots: Rows, cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which receivers of slots (m,), on cells (m, 2), have any grass, shape (n,)."""


Tell = Callable[[Rows], Floats]
"""Computes the wind's messages to the receivers of slots (m,), slot by slot, shape (n, 2)."""


@dataclass(slots=True, eq=False)
class SlotMessages:
    """Messages to one slot's receivers that a game has asked for, each array of shape (n, 2)."""

    message: Floats
    """Messages that the game reads and writes."""

    heard: Floats
    """Messages of the wind."""

    last: Floats
    """Copy of `message` after the last update; where they differ, the game has written since."""

    @classmethod
    def of(cls, heard: Floats) -> "SlotMessages":
        """Return one that holds the wind's messages, with nothing written."""
        return cls(heard.copy(), heard, heard.copy())

    @property
    def written(self) -> bool:
        """Whether any message differs from the wind's."""
        return bool((self.message != self.heard).any())


class PoolMessages:
    """Messages to a pool's receivers that a game has asked for, and has perhaps overwritten.

    All other messages are computed on the graphics card alone, so a game that asks for none pays for none.
    """

    def __init__(self, pool: Pool) -> None:
        self._pool = pool
        self._tell: Tell | None = None
        self._by_slot: dict[int, SlotMessages] = {}
        """Messages of the slots that a game has asked for."""
        self._prefetched: dict[int, Floats] = {}
        self.warned: set[str] = set()
        """Warnings logged so far; once there are entities, those of their world."""
        self.shown: Rows = np.zeros(0, np.int64)
        """Slots of the patches that are shown in this frame, shape (m,)."""

    def ask(self, slot: int, /) -> Floats:
        """Return the messages to a slot's receivers, shape (n, 2); from now on what is written into them counts."""
        if slot not in self._by_slot:
            self._by_slot[slot] = SlotMessages.of(self._fetched(slot))
        return self._by_slot[slot].message

    def _fetched(self, slot: int) -> Floats:
        """Return the wind's messages to a slot's receivers.

        The second slot asked for fetches all that are shown, as a game that asks for two will ask for more.
        """
        fetch_all = self._by_slot and slot not in self._prefetched and slot in self.shown
        slots = self.shown if fetch_all else np.array([slot])
        if slot not in self._prefetched:
            self._prefetched |= zip(slots.tolist(), np.split(self.heard(slots), len(slots)), strict=True)
        return self._prefetched.pop(slot)

    @property
    def busy(self) -> bool:
        """Whether any slot was asked for."""
        return bool(self._by_slot)

    def heard(self, slots: Rows, /) -> Floats:
        """Return the wind's messages to the receivers of slots, shape (n, 2)."""
        if self._tell is None:
            return np.zeros((len(slots) * prod(self._pool.shape), 2), np.float32)
        return self._tell(slots)

    def current(self, slots: Rows, /) -> Floats:
        """Return the messages to the receivers of slots (m,), of the wind or as a game wrote them, shape (m, n, 2)."""
        found = self.heard(slots).reshape(len(slots), prod(self._pool.shape), 2)
        for row, slot in enumerate(slots.tolist() if self._by_slot else ()):
            if slot in self._by_slot:
                found[row] = self._by_slot[slot].message
        return found

    def forget(self, slot: int, /) -> None:
        """Drop the messages of a slot that holds another patch now."""
        self._by_slot.pop(slot, None)

    def forget_all(self) -> None:
        """Drop the messages of all slots, and the wind, because the pool has other receivers now."""
        self._by_slot.clear()
        self._prefetched.clear()
        self._tell = None

    def blow(self, tell: Tell, /) -> None:
        """Replace the wind's messages by those of `tell`, but keep what a game has written since the last time."""
        self._tell = tell
        self._prefetched.clear()
        if not self._by_slot:
            return
        slots = np.array(list(self._by_slot))
        for entry, heard in zip(self._by_slot.values(), np.split(tell(slots), len(slots)), strict=True):
            changed = (entry.message != entry.last).any(axis=1)
            entry.heard = heard
            entry.message[:] = np.where(changed[:, None], self._valid(entry.message), heard)
            entry.last[:] = entry.message

    def written(self) -> Iterator[tuple[int, Floats]]:
        """Yield each slot with messages that differ from the wind's, and these messages (n, 2), made valid."""
        for slot, entry in self._by_slot.items():
            if entry.written:
                entry.message[:] = self._valid(entry.message)
                yield slot, entry.message

    def settle(self) -> None:
        """Restore the wind's messages after the frame is drawn: what a game writes holds for one frame."""
        for entry in self._by_slot.values():
            entry.message[:] = entry.last[:] = entry.heard

    def _valid(self, message: Floats) -> Floats:
        """Return messages with non-finite numbers set to 0, which is warned of once, and lengths clamped to 1."""
        if not np.isfinite(message).all():
            if NOT_FINITE not in self.warned:
                log.warning(NOT_FINITE)
            self.warned.add(NOT_FINITE)
            message = np.where(np.isfinite(message), message, np.float32(0.0))
        index = np.hypot(*message.T.astype(np.float64))
        # A length that exceeds 1 by rounding alone is kept: reading messages must not change a picture.
        return np.asarray(message / np.where(index > 1.0 + 1e-6, index, 1.0)[:, None], np.float32)


class Receiving:
    """The receivers of one pool: those that feel the wind in this frame, and their entities.

    Every slot whose patch is shown has an entity with `Receivers`. It is deleted when another patch is planted in the
    slot, or when the patch is no longer shown in that representation.
    """

    BATCH = 200
    """Most entities created in one frame: otherwise a frame takes long when a viewer leaps."""

    def __init__(self, pool: Pool, representation: str, *, still: bool = False) -> None:
        self.pool = pool
        self.representation = representation
        self.still = still
        """Whether these receivers are without the small oscillations."""
        self.per_slot = prod(pool.shape)
        """Number of receivers in a slot."""
        self.messages = PoolMessages(pool)
        self.rows: Rows = np.zeros(0, np.int64)
        """Rows of the patch table whose receivers feel the wind in this frame, shape (m,)."""
        self.slots: Rows = np.zeros(0, np.int64)
        """Slots of the patches at `rows`, shape (m,)."""
        self._owner = np.zeros(pool.slots, np.int64)
        """Entity of each slot's patch, 0 for none."""
        self._entity = np.zeros(pool.slots, np.int64)
        """Entity of each slot's receivers, 0 for none."""
        self._owned = 0
        """Number of slots with an owner."""
        self._listed: Rows | None = None
        """Slots whose receivers all have their entities; None where some may lack one."""

    def show(self, rows: Rows, slots: Rows, /) -> None:
        """Let the receivers of these patches feel the wind in this frame."""
        self.rows, self.slots, self.messages.shown = rows, slots, slots

    @property
    def addressed(self) -> tuple[Rows, Rows]:
        """Rows and slots that winds without a twin send messages to: all of a still pool, as their mean counts."""
        if not self.still:
            return self.rows, self.slots
        every = np.arange(self.pool.slots)
        return every, every

    @property
    def is_listed(self) -> bool:
        """Whether all receivers shown have had their entities since `enlist` last ran."""
        return self.slots is self._listed

    def enlist(self, world: World, patches: PatchTable, /) -> None:
        """Create and delete entities until they are those of the patches shown now."""
        shown = patches.entity.take(self.rows)
        if np.array_equal(self._owner.take(self.slots), shown) and np.count_nonzero(shown) == self._owned:
            self._listed = self.slots
            return
        owner = np.zeros_like(self._owner)
        owner[self.slots] = shown
        changed = np.flatnonzero(owner != self._owner)
        self._listed = None if changed.size else self.slots
        emptied = changed[self._entity[changed] != 0]
        to_delete = self._entity[emptied].tolist()
        for slot in emptied.tolist():
            self.messages.forget(slot)
        self._owner[changed] = self._entity[changed] = 0
        fresh = changed[owner[changed] != 0][: self.BATCH]
        self.messages.warned = world.warned
        self._owner[fresh] = owner[fresh]
        self._owned = int(np.count_nonzero(self._owner))
        with world.exchanging():
            for slot, entity in zip_longest(fresh.tolist(), to_delete):  # in turn, as `PatchEntities` does
                if slot is not None:
                    component = self.component(slot, viewer=patches.viewer, patch=int(owner[slot]))
                    self._entity[slot] = world.create(component)
                if entity is not None:
                    world.delete(entity)

    def component(self, slot: int, /, *, viewer: str, patch: int) -> Receivers:
        """Return the component of the receivers of a slot."""
        return Receivers(self.messages, self.pool, slot, patch=patch, representation=self.representation, viewer=viewer)

    def lose(self) -> None:
        """Handle that all entities of the world have been deleted."""
        self._owner[:] = self._entity[:] = 0
        self._owned = 0
        self._listed = None

    def release(self, world: World, /) -> None:
        """Delete the entities of all receivers."""
        for slot in np.flatnonzero(self._entity).tolist():
            world.delete(int(self._entity[slot]))
            self.messages.forget(slot)
        self.lose()
