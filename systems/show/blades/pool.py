"""The pool of the 3D blades around a viewer: each is a receiver, which stands at its root."""

from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints
from ...around.kept import Kept
from ...around.patches import NOWHERE
from ...around.receivers import Receiving
from ...space.window import between, window_rows

BLADE = np.dtype(
    [
        ("root", "3f4"),
        ("height", "f4"),
        ("rest", "2f4"),
        ("facing", "2f4"),
        ("width", "f4"),
        ("variant", "f4"),
        ("kind", "f4"),
        ("organ", "f4"),
    ]
)
"""Record of a blade on the graphics card: root [m], length [m], rest lean, face normal (x, z), width at the root [m],
row of the posture table, kind, and organ. The field names are the shader's; it reads three texels."""

ORGAN = np.dtype(
    [*((name, BLADE[name]) for name in BLADE.names or ()), ("stem", "f4"), ("part", "f4"), ("sways", "2f4")]
)
"""Record of an organ, which may stand on a stem: a `BLADE`, its stem's length [m], its place along the stem, and the
stem's rest lean; four texels."""


@dataclass(slots=True, eq=False)
class BladePool:
    """The blades of all patches near enough for 3D, one slot per patch; each blade is a receiver.

    Slots form a window that wraps round, as the rows of a `PatchTable` do.
    """

    side: int
    """Patches along the window's side."""

    kinds: NDArray[np.intp]
    """The kind of each of a patch's blades, shape (n,)."""

    present: NDArray[np.bool_] = field(init=False)
    """Whether the density at its place lets each blade grow, shape (side * side, n)."""

    x: Floats = field(init=False)
    """Receivers' x on the ground [m], shape (side * side, n)."""

    z: Floats = field(init=False)
    """Receivers' z on the ground [m], shape (side * side, n)."""

    ground: Floats = field(init=False)
    """Lowest and highest ground under each slot's blades [m], shape (side * side, 2)."""

    stamp: NDArray[np.int32] = field(init=False)
    """Cell (i, j) that each slot is planted with, shape (side * side, 2)."""

    sown: NDArray[np.int64] = field(init=False)
    """Number of times each slot was sown, and that number when `present` was last computed, shape (side * side, 2)."""

    def __post_init__(self) -> None:
        slots, shape = self.side * self.side, (self.side * self.side, len(self.kinds))
        self.present = np.zeros(shape, np.bool_)
        self.x, self.z = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
        self.ground = np.zeros((slots, 2), np.float32)
        self.stamp, self.sown = np.full((slots, 2), NOWHERE, np.int32), np.zeros((slots, 2), np.int64)

    @property
    def slots(self) -> int:
        """Number of slots."""
        return len(self.stamp)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of a slot's receivers, (n,)."""
        return self.kinds.shape

    def places(self, slots: NDArray[np.int64], /) -> Floats:
        """Return the ground positions (x, z) [m] of the receivers of some slots, shape (m, n, 2)."""
        return np.stack([self.x[slots], self.z[slots]], axis=-1)

    def kind(self, slots: NDArray[np.int64], /) -> NDArray[np.intp]:
        """Return the kind of each receiver of some slots (m,), shape (m * n,)."""
        return np.tile(self.kinds, len(slots))

    def grows(self, slots: NDArray[np.int64], cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which blades of some slots grow on these cells (m, 2), shape (m * n,)."""
        planted = (self.stamp[slots] == cells).all(axis=1)
        return np.asarray(self.present[slots] & planted[:, None]).reshape(-1)


class BladesKept(Kept):
    """The blades around one viewer."""

    def __init__(self, pool: BladePool, name: str) -> None:
        super().__init__([Receiving(pool, name)])
        self.pool = pool
        self.ahead: tuple[object, BladePool, NDArray[np.int64]] | None = None
        """Result of `carry_ahead`: the next representation, its pool, and the `slot_states` at that time."""

    def hold(self, pool: BladePool, /) -> None:
        """Take over the blades of another pool with as many slots; the entities of the slots stay."""
        for each in fields(pool):
            setattr(self.pool, each.name, getattr(pool, each.name))
        self.ahead = None
        self.receiving[0].messages.forget_all()

    def slot_states(self) -> NDArray[np.int64]:
        """Return each slot's cell and sowing counts, shape (slots, 4): they change whenever its blades do."""
        return np.concatenate([self.pool.stamp, self.pool.sown], axis=1)

    def stand_on(self, first: Ints, last: Ints, span: tuple[float, float], /) -> None:
        """Widen the ground range of these cells by `span`: planting all their blades again would take far longer."""
        stamp, ground = self.pool.stamp, self.pool.ground
        inside = between(stamp, first, last)
        lowest, highest = np.minimum(ground[inside, 0], span[0]), np.maximum(ground[inside, 1], span[1])
        ground[inside] = np.stack([lowest, highest], axis=1)

    def sow_on(self, cells: Ints, /) -> None:
        """Mark the slots of these cells, so that `present` is computed again once they are shown."""
        slots = window_rows(cells, side=self.pool.side)
        self.pool.sown[slots[(self.pool.stamp[slots] == cells).all(axis=1)], 0] += 1
