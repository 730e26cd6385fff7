"""Pools and receivers that a representation keeps for one viewer."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Ints
from ...engine.world import World
from .patches import PatchTable
from .receivers import Receiving


class Kept:
    """A representation's pools for one viewer; `receiving` has the receivers of each."""

    def __init__(self, receiving: Sequence[Receiving] = ()) -> None:
        self.receiving = list(receiving)
        self.planted = 0
        """Number of times that patches have been planted or moved."""

    def enlist(self, world: World, patches: PatchTable, /) -> None:
        """Create an entity for the receivers of each patch that is shown, and delete all others."""
        for receiving in self.receiving:
            receiving.enlist(world, patches)

    def components(self, rows: list[int], /) -> list[tuple[object, ...]]:
        """Return what the entity of the patch in each of some rows of the patch table carries."""
        return [()] * len(rows)

    @property
    def is_listed(self) -> bool:
        """Whether all receivers shown have their entities; otherwise the next frame creates more."""
        return all(receiving.is_listed for receiving in self.receiving)

    def leave(self, rows: NDArray[np.int32], /) -> None:
        """Handle that `rows` of the patch table hold other patches now."""

    def stand_on(self, first: Ints, last: Ints, span: tuple[float, float], /) -> None:
        """Handle that the terrain has changed on the cells from `first` to `last`, each (i, j).

        `span` has the least and the largest height there [m].
        """

    def sow_on(self, cells: Ints, /) -> None:
        """Handle that the densities have changed on these cells (n, 2)."""

    def lose(self) -> None:
        """Handle that all entities of the world have been deleted."""
        for receiving in self.receiving:
            receiving.lose()

    def release(self, world: World, /) -> None:
        """Delete the entities of all receivers."""
        for receiving in self.receiving:
            receiving.release(world)
