"""Receivers: where the messages of many patches are kept, and what a game writes into them."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import zip_longest
from math import prod
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Rows
from ...components.receivers import Receivers
from ...engine.world import World
from .patches import PatchTable

log = logging.getLogger("tallgrass")


class Pool(Protocol):
    """Receivers of one representation around a viewer, a slot for each patch."""

    @property
    def slots(self) -> int:
        """How many slots there are."""

    @property
    def shape(self) -> tuple[int, ...]:
        """How the receivers of a slot are laid out."""

    def places(self, slots: Rows, /) -> Floats:
        """Return the ground positions (x, z) [m] of the receivers of some slots, shape (m, *shape, 2)."""

    def kind(self, slots: Rows, /) -> NDArray[np.intp]:
        """Return the kind of grass of each receiver of some slots, one slot after another, shape (n,)."""

    def grows(self, slots: Rows, cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which receivers of some slots have grass that grows on these cells (m, 2), shape (n,)."""


Tell = Callable[[Rows], Floats]
"""Gives what the receivers of some slots (m,) hear, one slot after another, shape (n, 2)."""


@dataclass(slots=True, eq=False)
class Letter:
    """The messages of one slot that a game has asked for, each of shape (n, 2)."""

    message: Floats
    """What the game reads and writes."""

    heard: Floats
    """What the wind says."""

    left: Floats
    """What was there when the game was last heard of: what differs from it the game has written."""

    @classmethod
    def of(cls, heard: Floats) -> "Letter":
        """Return the letter of what the wind says."""
        return cls(heard.copy(), heard, heard.copy())

    @property
    def written(self) -> bool:
        """Whether it is something else than what the wind says."""
        return bool((self.message != self.heard).any())


class Correspondence:
    """The messages of a pool that a game has asked for, and what it has written since.

    All others are computed on the graphics card alone: whoever asks for none pays for none.
    """

    def __init__(self, pool: Pool) -> None:
        self._pool = pool
        self._tell: Tell | None = None
        self._letters: dict[int, Letter] = {}
        self._known: dict[int, Floats] = {}
        self._told = False
        self.shown: Rows = np.zeros(0, np.int64)
        """Slots of the patches that are shown in this frame, shape (m,)."""

    def ask(self, slot: int, /) -> Floats:
        """Return the messages of a slot, shape (n, 2), to be read and written; from now on what is written counts."""
        if slot not in self._letters:
            self._letters[slot] = Letter.of(self._told_to(slot))
        return self._letters[slot].message

    def _told_to(self, slot: int) -> Floats:
        """Return what the wind last told a slot's receivers; who asks for a second one will ask for more."""
        asked = self._letters and slot not in self._known and slot in self.shown
        slots = self.shown if asked else np.array([slot])
        if slot not in self._known:
            self._known |= zip(slots.tolist(), np.split(self.heard(slots), len(slots)), strict=True)
        return self._known.pop(slot)

    @property
    def busy(self) -> bool:
        """Whether any slot was asked for."""
        return bool(self._letters)

    def heard(self, slots: Rows, /) -> Floats:
        """Return what the wind last told the receivers of some slots, (n, 2)."""
        if self._tell is None:
            return np.zeros((len(slots) * prod(self._pool.shape), 2), np.float32)
        return self._tell(slots)

    def messages(self, slots: Rows, /) -> Floats:
        """Return the messages of some slots (m,), whoever has written them, shape (m, n, 2)."""
        found = self.heard(slots).reshape(len(slots), prod(self._pool.shape), 2)
        for row, slot in enumerate(slots.tolist() if self._letters else ()):
            if slot in self._letters:
                found[row] = self._letters[slot].message
        return found

    def forget(self, slot: int, /) -> None:
        """Forget that a slot was asked for, because another patch stands there now."""
        self._letters.pop(slot, None)

    def forget_all(self) -> None:
        """Forget all that was asked for, because there are other receivers now."""
        self._letters.clear()
        self._known.clear()
        self._tell = None

    def blow(self, tell: Tell, /) -> None:
        """Let the wind tell something else from now on; what a game has written since the last time stands above it."""
        self._tell = tell
        self._known.clear()
        if not self._letters:
            return
        slots = np.array(list(self._letters))
        for letter, heard in zip(self._letters.values(), np.split(tell(slots), len(slots)), strict=True):
            changed = (letter.message != letter.left).any(axis=1)
            letter.heard = heard
            letter.message[:] = np.where(changed[:, None], self._valid(letter.message), heard)
            letter.left[:] = letter.message

    def written(self) -> Iterator[tuple[int, Floats]]:
        """Yield the slots and messages (n, 2) that are other than the wind says, mended to be possible ones."""
        for slot, letter in self._letters.items():
            if letter.written:
                letter.message[:] = self._valid(letter.message)
                yield slot, letter.message

    def settle(self) -> None:
        """Put the wind's own messages back after the frame is drawn: what a game writes holds for one frame."""
        for letter in self._letters.values():
            letter.message[:] = letter.left[:] = letter.heard

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
        self.each = prod(pool.shape)
        """How many there are of a slot."""
        self.letters = Correspondence(pool)
        self.rows: Rows = np.zeros(0, np.int64)
        """Rows of the patch table of those that hear in this frame, shape (m,)."""
        self.slots: Rows = np.zeros(0, np.int64)
        """Their slots, shape (m,)."""
        self._owner = np.zeros(pool.slots, np.int64)
        self._entity = np.zeros(pool.slots, np.int64)
        self._owned = 0
        """How many slots have an owner: the entity of their patch."""
        self._listed: Rows | None = None
        """The slots whose receivers are entities; None where it may be others."""

    def show(self, rows: Rows, slots: Rows, /) -> None:
        """Let the receivers of these patches hear the wind in this frame."""
        self.rows, self.slots, self.letters.shown = rows, slots, slots

    @property
    def told(self) -> tuple[Rows, Rows]:
        """Rows and slots of those that winds without a twin tell something: of still ones all, as their mean counts."""
        if not self.still:
            return self.rows, self.slots
        every = np.arange(self.pool.slots)
        return every, every

    @property
    def is_listed(self) -> bool:
        """Whether those shown were entities, all of them, when that was last seen to."""
        return self.slots is self._listed

    def enlist(self, world: World, patches: PatchTable, /) -> None:
        """Create and delete entities so that they are those of the patches shown now."""
        shown = patches.entity.take(self.rows)
        if np.array_equal(self._owner.take(self.slots), shown) and np.count_nonzero(shown) == self._owned:
            self._listed = self.slots
            return
        owner = np.zeros_like(self._owner)
        owner[self.slots] = shown
        changed = np.flatnonzero(owner != self._owner)
        self._listed = None if changed.size else self.slots
        gone = changed[self._entity[changed] != 0]
        left = self._entity[gone].tolist()
        for slot in gone.tolist():
            self.letters.forget(slot)
        self._owner[changed] = self._entity[changed] = 0
        fresh = changed[owner[changed] != 0][: self.BATCH]
        self._owner[fresh] = owner[fresh]
        self._owned = int(np.count_nonzero(self._owner))
        for slot, entity in zip_longest(fresh.tolist(), left):  # in turn, as those of patches
            if slot is not None:
                self._entity[slot] = world.create(self.component(slot, viewer=patches.viewer, patch=int(owner[slot])))
            if entity is not None:
                world.delete(entity)

    def component(self, slot: int, /, *, viewer: str, patch: int) -> Receivers:
        """Return the component that stands for the receivers of a slot."""
        return Receivers(self.letters, self.pool, slot, patch=patch, representation=self.representation, viewer=viewer)

    def lose(self) -> None:
        """Take note that all entities are gone."""
        self._owner[:] = self._entity[:] = 0
        self._owned = 0
        self._listed = None

    def release(self, world: World, /) -> None:
        """Delete all of its entities."""
        for slot in np.flatnonzero(self._entity).tolist():
            self._delete(world, slot)
        self._owner[:] = 0
        self._owned = 0
        self._listed = None

    def _delete(self, world: World, slot: int) -> None:
        world.delete(int(self._entity[slot]))
        self._entity[slot] = 0
        self.letters.forget(slot)
