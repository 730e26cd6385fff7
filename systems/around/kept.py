"""What a representation keeps for one viewer."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Ints
from ...engine.world import World
from .patches import PatchTable
from .receivers import Receiving


class Kept:
    """What a representation keeps for one viewer: the receivers that it stands on, of each pool."""

    def __init__(self, receiving: Sequence[Receiving] = ()) -> None:
        self.receiving = list(receiving)
        self.planted = 0
        """How often anything of it has been planted, or has come to stand elsewhere."""

    def enlist(self, world: World, patches: PatchTable, /) -> None:
        """Let the receivers of what is shown be entities, and no others."""
        for receiving in self.receiving:
            receiving.enlist(world, patches)

    @property
    def is_listed(self) -> bool:
        """Whether that is done: otherwise some more come in the next frame."""
        return all(receiving.is_listed for receiving in self.receiving)

    def leave(self, rows: NDArray[np.int32], /) -> None:
        """Take note that other patches are in some rows of the patch table now."""

    def stand_on(self, first: Ints, last: Ints, span: tuple[float, float], /) -> None:
        """Take note that the ground is another on the cells from `first` to `last`, each (i, j).

        `span` has its lowest and its highest height [m].
        """

    def sow_on(self, cells: Ints, /) -> None:
        """Take note that something else grows on these cells (n, 2)."""

    def lose(self) -> None:
        """Take note that all entities are gone."""
        for receiving in self.receiving:
            receiving.lose()

    def release(self, world: World, /) -> None:
        """Delete its entities."""
        for receiving in self.receiving:
            receiving.release(world)
