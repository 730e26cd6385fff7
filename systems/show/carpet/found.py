"""What takes a while to make out of a terrain's heights: of ground that streams, it is made out beforehand."""

from dataclasses import dataclass
from typing import Self

from ....engine.terrain.record import Terrain
from .holes import Holes
from .rims import Rims


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """The rims and the holes of a terrain, and of what it becomes next."""

    rims: Rims
    holes: Holes

    @classmethod
    def of(cls, terrain: Terrain, /) -> Self:
        """Return those of a terrain, as they were made out beforehand if they were; else it may be another thread."""
        return terrain.found if isinstance(terrain.found, cls) else cls(Rims(terrain), Holes(terrain))

    def belong(self, terrain: Terrain, /) -> None:
        """Be those of a terrain that has just become what they were made out of."""
        self.rims.belong(terrain)
        self.holes.belong(terrain)
