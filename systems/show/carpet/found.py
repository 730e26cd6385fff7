"""Rims and holes, which take long to compute; for streamed ground they are computed ahead, on another thread."""

from dataclasses import dataclass
from typing import Self

from ....engine.terrain.record import Terrain
from .holes import Holes
from .rims import Rims


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """The rims and the holes of a terrain."""

    rims: Rims
    holes: Holes

    @classmethod
    def of(cls, terrain: Terrain, /) -> Self:
        """Return a terrain's rims and holes: those computed ahead, if there are any, or else computed now.

        Any thread may call this.
        """
        return terrain.derived if isinstance(terrain.derived, cls) else cls(Rims(terrain), Holes(terrain))

    def attach(self, terrain: Terrain, /) -> None:
        """Follow the changes of a terrain that has just taken over the heights these were computed from."""
        self.rims.attach(terrain)
        self.holes.attach(terrain)
