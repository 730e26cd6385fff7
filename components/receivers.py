"""Receivers, which collect the wind's messages, for a game to read and to write."""

from typing import Protocol, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arrays import Floats
from .words import in_words


class Messages(Protocol):
    """Storage of the messages of many patches' receivers, a slot for each patch."""

    def ask(self, slot: int, /) -> Floats:
        """Return the messages of a slot, shape (n, 2), to read and write; from then on written values take effect."""


class Places(Protocol):
    """Positions of receivers by slot, and the kinds that grow there."""

    def places(self, slots: NDArray[np.int64], /) -> Floats:
        """Return ground positions (x, z) [m], shape (m, ..., 2)."""

    def kind(self, slots: NDArray[np.int64], /) -> NDArray[np.intp]:
        """Return the kinds of grass, one slot after another, shape (n,)."""


@final
class Receivers:
    """The receivers of the wind's messages of one patch in one representation (paper, section 3.2).

    One row per blade, per vertical edge of a strip, or one for a patch of carpet. `message` may be written; the rest
    cannot. For blades and strips they are on entities of their own, for the carpet on the patch's entity.
    """

    __slots__ = ("_messages", "_patch", "_places", "_representation", "_slot", "_viewer")

    def __init__(
        self, messages: Messages, places: Places, slot: int, /, *, patch: int, representation: str, viewer: str
    ) -> None:
        self._messages, self._places, self._slot = messages, places, slot
        self._patch, self._representation, self._viewer = patch, representation, viewer

    def __repr__(self) -> str:
        return f"Receivers(patch={self.patch}, representation={self.representation!r}, viewer={self.viewer!r})"

    @property
    def patch(self) -> int:
        """Entity of the patch; 0 where it is the same entity."""
        return self._patch

    @property
    def representation(self) -> str:
        """Name of the representation: `blades`, `strips` or `carpet`."""
        return self._representation

    @property
    def viewer(self) -> str:
        """Name of the viewer to whom the patch is shown."""
        return self._viewer

    @property
    def place(self) -> Floats:
        """Ground positions (x, z) [m], shape (n, 2); a copy."""
        return self._places.places(np.array([self._slot])).reshape(-1, 2).copy()

    @property
    def kind(self) -> NDArray[np.intp]:
        """Number of each receiver's kind of grass, in the order of the scene, shape (n,)."""
        return self._places.kind(np.array([self._slot]))

    @property
    def message(self) -> Floats:
        """Bending directions times posture indices, (x, z), shape (n, 2): an array to read and write.

        After the system `wind` it holds the wind of this frame, before it that of the last frame. Values that you write
        show in the next picture alone. A message longer than 1 is shortened to 1.
        """
        return self._messages.ask(self._slot)

    @message.setter
    def message(self, message: ArrayLike) -> None:
        kept = self._messages.ask(self._slot)
        if message is not kept:  # `message *= 2` has written to it already
            try:
                kept[:] = message
            except (TypeError, ValueError):
                due = f"the messages of {len(kept)} receivers have the shape {kept.shape}, or are one for all, (x, z)"
                raise ValueError(f"{due}; they were given {in_words(message)}") from None
