"""Which blades are near enough to be 3D, and where: their places are those of their receivers."""

from dataclasses import dataclass

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
"""What the graphics card is told of a blade: root [m], length [m], lean, face normal (x, z), width at the root [m],
row of the posture table, kind, and organ. The field names are the shader's; it reads three texels."""

ORGAN = np.dtype(
    [*((name, BLADE[name]) for name in BLADE.names or ()), ("stem", "f4"), ("part", "f4"), ("sways", "2f4")]
)
"""The same where some stand on stems: the stem's length [m], the place along it, and its lean; four texels."""


@dataclass(slots=True, eq=False)
class BladePool:
    """The blades of all patches near enough to be 3D, one slot per patch; each is a receiver.

    Slots form a window that wraps round, as the rows of a `PatchTable` do.
    """

    side: int
    """Patches along the window's side."""

    kinds: NDArray[np.intp]
    """The kind of each of a patch's blades, shape (n,)."""

    present: NDArray[np.bool_]
    """Whether the blade grows at its place's density, shape (side * side, n)."""

    x: Floats
    """Where the receivers are on the ground [m], shape (side * side, n)."""

    z: Floats
    """The same along z."""

    ground: Floats
    """What the ground that a slot's blades grow on lies between [m], shape (side * side, 2)."""

    stamp: NDArray[np.int32]
    """Cell (i, j) that each slot is planted for, shape (side * side, 2)."""

    sown: NDArray[np.int64]
    """How often each slot was sown, and how often of these its blades have been reckoned anew, (side * side, 2)."""

    @property
    def slots(self) -> int:
        """How many slots there are."""
        return len(self.stamp)

    @property
    def shape(self) -> tuple[int, ...]:
        """How the receivers of a slot are laid out."""
        return self.kinds.shape

    def places(self, slots: NDArray[np.int64], /) -> Floats:
        """Return the ground positions (x, z) [m] of the receivers of some slots, shape (m, n, 2)."""
        return np.stack([self.x[slots], self.z[slots]], axis=-1)

    def kind(self, slots: NDArray[np.int64], /) -> NDArray[np.intp]:
        """Return the kind that each receiver of some slots is of, shape (len(slots) * n,)."""
        return np.tile(self.kinds, len(slots))

    def grows(self, slots: NDArray[np.int64], cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which blades of some slots grow on these cells (m, 2), shape (m * n,)."""
        planted = (self.stamp[slots] == cells).all(axis=1)
        return np.asarray(self.present[slots] & planted[:, None]).reshape(-1)

    @classmethod
    def allocate(cls, side: int, kinds: NDArray[np.intp]) -> "BladePool":
        """Return an empty pool for a window of `side` by `side` patches with blades of these kinds (n,)."""
        shape = (side * side, len(kinds))
        return cls(
            side=side,
            kinds=kinds,
            present=np.zeros(shape, np.bool_),
            x=np.zeros(shape, np.float32),
            z=np.zeros(shape, np.float32),
            ground=np.zeros((side * side, 2), np.float32),
            stamp=np.full((side * side, 2), NOWHERE, np.int32),
            sown=np.zeros((side * side, 2), np.int64),
        )


class BladesKept(Kept):
    """The blades around one viewer."""

    def __init__(self, pool: BladePool, name: str) -> None:
        super().__init__([Receiving(pool, name)])
        self.pool = pool
        self.ahead: tuple[object, BladePool, NDArray[np.int64]] | None = None
        """What it is to hold next: for whose blades, that pool, and what stood in which slots when it was made."""

    def hold(self, pool: BladePool, /) -> None:
        """Have the blades of another pool in place of its own, for as many slots: they keep their entities."""
        self.pool.kinds, self.pool.present, self.pool.x, self.pool.z = pool.kinds, pool.present, pool.x, pool.z
        self.pool.ground, self.pool.stamp, self.pool.sown = pool.ground, pool.stamp, pool.sown
        self.ahead = None
        self.receiving[0].letters.forget_all()

    def planted_with(self) -> NDArray[np.int64]:
        """Return what tells in which state each slot is, shape (slots, 4)."""
        return np.concatenate([self.pool.stamp, self.pool.sown], axis=1)

    def stand_on(self, first: Ints, last: Ints, span: tuple[float, float], /) -> None:
        """Let the ground of these cells reach as low and as high: planting all blades again would take far longer."""
        stamp, ground = self.pool.stamp, self.pool.ground
        on = between(stamp, first, last)
        ground[on] = np.stack([np.minimum(ground[on, 0], span[0]), np.maximum(ground[on, 1], span[1])], axis=1)

    def sow_on(self, cells: Ints, /) -> None:
        """Let the blades of these cells be reckoned anew once they are shown."""
        slots = window_rows(cells, side=self.pool.side)
        self.pool.sown[slots[(self.pool.stamp[slots] == cells).all(axis=1)], 0] += 1
