"""Receivers: what collects the wind's messages, for a game to read and to write."""

from typing import Protocol, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arrays import Floats


class Messages(Protocol):
    """Where the messages of many patches' receivers are kept, a slot for each patch."""

    def ask(self, slot: int, /) -> Floats:
        """Return the messages of a slot, shape (n, 2), to be read and written; from now on what is written counts."""


class Places(Protocol):
    """Where the receivers of some slots are, and what grows there."""

    def places(self, slots: NDArray[np.int64], /) -> Floats:
        """Return ground positions (x, z) [m], shape (m, ..., 2)."""

    def kind(self, slots: NDArray[np.int64], /) -> NDArray[np.intp]:
        """Return the kinds of grass, one slot after another, shape (n,)."""


@final
class Receivers:
    """What collects the wind's messages for one patch in one representation (paper, section 3.2).

    One row per blade, per vertical edge of a strip, or one for a patch of carpet. `message` may be written; the rest
    cannot. Those of blades and strips have entities of their own; the carpet's are carried by the patch's.
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
        """The entity of the patch; 0 where it is the same entity."""
        return self._patch

    @property
    def representation(self) -> str:
        """The name of the representation: `blades`, `strips` or `carpet`."""
        return self._representation

    @property
    def viewer(self) -> str:
        """The name of the viewer that the patch is shown to."""
        return self._viewer

    @property
    def place(self) -> Floats:
        """Ground positions (x, z) [m], shape (n, 2); a copy."""
        return self._places.places(np.array([self._slot])).reshape(-1, 2).copy()

    @property
    def kind(self) -> NDArray[np.intp]:
        """Number of the kind of grass of each, in the order of the scene, shape (n,)."""
        return self._places.kind(np.array([self._slot]))

    @property
    def message(self) -> Floats:
        """Bending directions times posture indices, (x, z), shape (n, 2): an array to be read and written.

        After the system `wind` it holds the wind of this frame, before it that of the last. What you write shows in the
        next picture, and in that alone. A message longer than 1 is shortened to 1.
        """
        return self._messages.ask(self._slot)

    @message.setter
    def message(self, message: ArrayLike) -> None:
        kept = self._messages.ask(self._slot)
        if message is not kept:  # `message *= 2` has written to it already
            kept[:] = message
