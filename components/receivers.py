"""Receivers: what collects the wind's messages, for a game to read and to write."""

from typing import Protocol, final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]


class Messages(Protocol):
    """Where the messages of many patches' receivers are kept, a slot for each patch."""

    def ask(self, slot: int, /) -> Floats:
        """Return the messages of a slot, shape (n, 2), to be read and written; from now on what is written counts."""


@final
class Receivers:
    """What collects the wind's messages for one patch in one representation (paper, section 3.2).

    One row per blade, per vertical edge of a strip, or one for a patch of carpet. `message` may be written; the rest
    cannot.
    """

    __slots__ = ("_messages", "_slot", "kind", "patch", "place", "representation", "viewer")

    def __init__(
        self,
        messages: Messages,
        slot: int,
        *,
        place: Floats,
        kind: NDArray[np.intp],
        patch: int,
        representation: str,
        viewer: str,
    ) -> None:
        self._messages, self._slot = messages, slot
        self.place: Floats = place
        """Ground positions (x, z) [m], shape (n, 2)."""
        self.kind: NDArray[np.intp] = kind
        """Number of the kind of grass of each, in the order of the scene, shape (n,)."""
        self.patch: int = patch
        """The entity of the patch."""
        self.representation: str = representation
        """The name of the representation."""
        self.viewer: str = viewer
        """The name of the viewer that the patch is shown to."""
        for array in (place, kind):
            array.flags.writeable = False

    @property
    def message(self) -> Floats:
        """Bending directions times posture indices, (x, z), shape (n, 2): an array to be read and written.

        A system after `wind` finds in it what the wind of this frame says, and everyone else what that of the frame
        before said. What is written is what the next picture shows, for that picture alone; a message longer than 1 is
        shortened to 1.
        """
        return self._messages.ask(self._slot)
