"""Messages of a prairie's receivers, as arrays to assert on."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Floats
from ..engine.handed import must_be_known
from ..systems.around.patches import PatchTable
from ..systems.around.receivers import Receiving
from ..systems.prairie import Prairie

Words = NDArray[np.str_]


@dataclass(frozen=True, slots=True, eq=False)
class Heard:
    """Receivers of the patches that are shown, one row each: blades and edges of strips, not carpet."""

    place: Floats
    """Ground positions (x, z) [m], shape (n, 2)."""

    message: Floats
    """Latest messages: vectors along the bending direction whose norm is the posture index, shape (n, 2)."""

    kind: Words
    """Name of each receiver's kind of grass in the scene, shape (n,)."""

    representation: Words
    """`blades` or `strips`, shape (n,)."""

    kinds: tuple[str, ...]
    """Names of all kinds of grass in the scene, also of kinds without a receiver here."""

    representations: tuple[str, ...]
    """Names of all representations with such receivers, also of those without a receiver here."""

    def __len__(self) -> int:
        return len(self.place)

    @property
    def index(self) -> Floats:
        """Posture index of each receiver, in [0, 1], shape (n,)."""
        return np.asarray(np.hypot(*self.message.T))

    def only(self, *, kind: str | None = None, representation: str | None = None) -> "Heard":
        """Return the receivers of a kind, of a representation, or of both. Raises ValueError for an unknown name."""
        chosen = np.ones(len(self), np.bool_)
        for what, name, known, have in (
            ("grass", kind, self.kinds, self.kind),
            ("representation", representation, self.representations, self.representation),
        ):
            must_be_known(what, name, known)
            if name is not None:
                chosen &= have == name
        return self._of(chosen)

    def near(self, x: float, z: float, *, within: float) -> "Heard":
        """Return the receivers at most `within` metres from a ground position (x, z) [m]."""
        chosen = np.hypot(self.place[:, 0] - x, self.place[:, 1] - z) <= within
        return self._of(chosen)

    def _of(self, chosen: NDArray[np.bool_]) -> "Heard":
        rows = {name: getattr(self, name)[chosen] for name in ("place", "message", "kind", "representation")}
        return replace(self, **rows)


def receivers_of(prairie: Prairie, /, *, viewer: str = "main") -> Heard:
    """Return copies of the receivers of the patches that are shown to a viewer, with their messages.

    Messages are there once the prairie has been drawn, or after `watch` and `step(prairie, Phase.BLOW)`. Patches that
    have not been planted yet have no receivers.
    """
    outlook = prairie.viewers[viewer]
    pools = [receiving for kept in outlook.kept.values() for receiving in kept.receiving if not receiving.still]
    parts = [_heard(prairie, receiving, outlook.patches) for receiving in pools]
    place, message, kind, representation = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    names = tuple(dict.fromkeys(receiving.representation for receiving in pools))
    return Heard(place, message, kind, representation, tuple(prairie.scene.grass), names)


def _heard(prairie: Prairie, receiving: Receiving, patches: PatchTable) -> tuple[Floats, Floats, Words, Words]:
    """Return place, message, kind and representation of a pool's receivers that are shown and planted."""
    pool, slots = receiving.pool, receiving.slots
    grows = pool.grows(slots, patches.cell[receiving.rows])
    place, message = pool.places(slots).reshape(-1, 2)[grows], receiving.messages.current(slots).reshape(-1, 2)[grows]
    kind = np.array(list(prairie.scene.grass))[pool.kind(slots)[grows]]
    return place, message, kind, np.full(len(kind), receiving.representation)
