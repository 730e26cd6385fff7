"""What the receivers of a prairie have heard, as arrays to assert on."""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..systems.field import Field
from ..systems.prairie import Prairie
from ..systems.show.blades.pool import BladePool
from ..systems.show.seen import Shown, seen_now
from ..systems.show.strips.pool import StripPool

Floats = NDArray[np.float32]
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

    def __len__(self) -> int:
        return len(self.place)

    @property
    def index(self) -> Floats:
        """The posture index of each, in [0, 1], shape (n,)."""
        return np.asarray(np.hypot(*self.message.T))

    def only(self, *, kind: str | None = None, representation: str | None = None) -> "Heard":
        """Return those of one kind, of one representation, or of both."""
        chosen = np.ones(len(self), np.bool_)
        if kind is not None:
            chosen &= self.kind == kind
        if representation is not None:
            chosen &= self.representation == representation
        return Heard(*(getattr(self, each.name)[chosen] for each in fields(self)))

    def near(self, x: float, z: float, *, within: float) -> "Heard":
        """Return those at most `within` metres from a ground position (x, z) [m]."""
        chosen = np.hypot(self.place[:, 0] - x, self.place[:, 1] - z) <= within
        return Heard(*(getattr(self, each.name)[chosen] for each in fields(self)))


def receivers_of(prairie: Prairie, /) -> Heard:
    """Return the receivers of the patches that are shown, with what each has heard: copies, to assert on.

    They have heard something once the prairie has been drawn, or `watch` and `step(prairie, Phase.BLOW)` were called;
    patches that nothing has been planted on yet have none.
    """
    field, seen = prairie.field, seen_now(prairie.field)
    parts = [_heard(field, "blades", field.blades, seen.standing)]
    parts += [_heard(field, "strips", pool, shown) for pool, shown in zip(field.strips, seen.strips, strict=True)]
    place, message, kind, representation = (np.concatenate(rows) for rows in zip(*parts, strict=True))
    return Heard(place, message, kind, representation)


def _heard(field: Field, name: str, pool: BladePool | StripPool, shown: Shown) -> tuple[Floats, Floats, Words, Words]:
    """Return place, message, kind and representation of the receivers that grow in some slots of a pool."""
    slots = shown.slots[(pool.stamp[shown.slots, :2] == field.table.cell[shown.rows]).all(axis=1)]
    place, message = pool.place[slots], pool.message[slots]
    present = pool.present[slots].reshape(*pool.present[slots].shape, *(1,) * (place.ndim - pool.present.ndim - 1))
    grows = np.broadcast_to(present, place.shape[:-1]).reshape(-1)
    kind = np.array(list(field.scene.grass))[pool.kind(slots)[grows]]
    return place.reshape(-1, 2)[grows], message.reshape(-1, 2)[grows], kind, np.full(len(kind), name)
