"""What the receivers of a prairie have heard, as arrays to assert on."""

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
    """Receivers of the patches that are shown, one row each; blades and strip edges, not carpets."""

    place: Floats
    """Ground positions (x, z) [m], shape (n, 2)."""

    message: Floats
    """What each has heard last: vectors along the bending direction whose norm is the posture index, shape (n, 2)."""

    kind: Words
    """The name of the grass kind of each, as the scene calls it, shape (n,)."""

    representation: Words
    """`blades` or `strips`, shape (n,)."""

    kinds: tuple[str, ...]
    """The names of the scene's kinds of grass, also of those that none of these is of."""

    representations: tuple[str, ...]
    """The names of the representations that have such receivers, likewise."""

    def __len__(self) -> int:
        return len(self.place)

    @property
    def index(self) -> Floats:
        """The posture index of each, in [0, 1], shape (n,)."""
        return np.asarray(np.hypot(*self.message.T))

    def only(self, *, kind: str | None = None, representation: str | None = None) -> "Heard":
        """Return those of one kind, of one representation, or of both. Raises ValueError for a name that is unknown."""
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
        """Return those at most `within` metres from a ground position (x, z) [m]."""
        chosen = np.hypot(self.place[:, 0] - x, self.place[:, 1] - z) <= within
        return self._of(chosen)

    def _of(self, chosen: NDArray[np.bool_]) -> "Heard":
        rows = {name: getattr(self, name)[chosen] for name in ("place", "message", "kind", "representation")}
        return replace(self, **rows)


def receivers_of(prairie: Prairie, /, *, viewer: str = "main") -> Heard:
    """Return the receivers of the patches that a viewer is shown, with what each has heard: copies, to assert on.

    They have heard something once the prairie has been drawn, or `watch` and `step(prairie, Phase.BLOW)` were called;
    patches that nothing has been planted on yet have none.
    """
    outlook = prairie.viewers[viewer]
    asked = [receiving for kept in outlook.kept.values() for receiving in kept.receiving if not receiving.still]
    parts = [_heard(prairie, receiving, outlook.patches) for receiving in asked]
    place, message, kind, representation = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    names = tuple(dict.fromkeys(receiving.representation for receiving in asked))
    return Heard(place, message, kind, representation, tuple(prairie.scene.grass), names)


def _heard(prairie: Prairie, receiving: Receiving, patches: PatchTable) -> tuple[Floats, Floats, Words, Words]:
    """Return place, message, kind and representation of the receivers of a pool that are shown and planted."""
    pool, slots = receiving.pool, receiving.slots
    grows = pool.grows(slots, patches.cell[receiving.rows])
    place, message = pool.places(slots).reshape(-1, 2)[grows], receiving.letters.messages(slots).reshape(-1, 2)[grows]
    kind = np.array(list(prairie.scene.grass))[pool.kind(slots)[grows]]
    return place, message, kind, np.full(len(kind), receiving.representation)
