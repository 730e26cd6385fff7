"""The carpet's receivers: one in the middle of each patch around a viewer."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Rows
from ....engine.world import World
from ...around.kept import Kept
from ...around.patches import PatchTable
from ...around.receivers import Receiving
from ...space.ground import Ground, densest_kind


class CarpetPool:
    """One receiver per patch; a slot is a row of the patch table."""

    def __init__(self, patches: PatchTable, ground: Ground) -> None:
        self.patches, self._ground = patches, ground

    @property
    def slots(self) -> int:
        """Number of slots."""
        return len(self.patches.progress)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the receivers of a slot: a single one."""
        return (1,)

    def places(self, slots: Rows, /) -> Floats:
        """Return the middles (x, z) of the patches of slots (m,) [m], shape (m, 1, 2)."""
        return self.patches.middle[slots].astype(np.float32)[:, None]

    def kind(self, slots: Rows, /) -> NDArray[np.intp]:
        """Return the kind that grows most densely in the middle of each patch of slots (m,), shape (m,)."""
        return densest_kind(self._ground.density, self.places(slots)[:, 0])

    def grows(self, slots: Rows, cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which slots (m,) hold a patch with grass on the cell given for it (m, 2), shape (m,)."""
        patches = self.patches
        return np.asarray(patches.stands[slots] & (patches.cell[slots] == cells).all(axis=1))


class CarpetKept(Kept):
    """The carpet around one viewer. Its receivers are carried by the patches' own entities."""

    def __init__(self, pool: CarpetPool, name: str) -> None:
        super().__init__([Receiving(pool, name, still=True)])
        self.pool = pool

    def enlist(self, world: World, patches: PatchTable, /) -> None:
        """Make no entities: the patches' own carry the receivers."""
        self.receiving[0].messages.warned = world.warned

    def components(self, rows: list[int], /) -> list[tuple[object, ...]]:
        """Return the component of the receiver of the patch in each of some rows."""
        receiving, viewer = self.receiving[0], self.pool.patches.viewer
        return [(receiving.component(row, viewer=viewer, patch=0),) for row in rows]

    @property
    def is_listed(self) -> bool:
        """Whether all entities are made: always."""
        return True

    def leave(self, rows: NDArray[np.int32], /) -> None:
        """Forget the messages that were set for some rows of the patch table."""
        for row in rows.tolist() if self.receiving[0].messages.busy else ():
            self.receiving[0].messages.forget(row)
