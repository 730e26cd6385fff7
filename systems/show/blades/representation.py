"""3D: every blade a ribbon of segments (paper, section 2.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints, Levels, Rows
from ....engine.declared.quality import Quality
from ...around.kept import Kept
from ...around.outlook import Outlook
from ...around.patches import NOWHERE, PatchTable
from ...grow.organs import LIGULES, TEETH, any_eyes
from ...grow.record import NOTHING, Growth
from ...space.ground import Ground
from ...space.grown import Grown
from ..representation import Canvas, Color, Representation
from ..strips.representation import StripRepresentation
from .draw import own_segment_defines
from .organs import any_with
from .painter import BladesPainter
from .plant import BladeStock, carry_blades, plant_blades, sow_blades, stock_blades
from .pool import BladePool, BladesKept
from .shown import BladesShown, show_blades


@dataclass(frozen=True, slots=True, eq=False)
class BladeRepresentation(Representation):
    """Blades near the viewer, each a receiver."""

    name: ClassVar[str] = "blades"
    label: ClassVar[str] = "3D blades"
    programs = 6
    color: ClassVar[Color] = (0.98, 0.33, 0.20)
    morphs_into: ClassVar[str | None] = StripRepresentation.name
    samplers: ClassVar[tuple[str, ...]] = ("targets",)
    pass_samplers: ClassVar[tuple[str, ...]] = ("blades", "standing", "slices")

    stock: BladeStock

    @staticmethod
    def reach(quality: Quality, /) -> int:
        """Return the discrete distance at which the last ring ends."""
        return quality.blade_rings[-1].to

    @classmethod
    def stocked(
        cls, growths: Sequence[Growth], quality: Quality, ground: Ground, coming: Mapping[int, Growth] = NOTHING, /
    ) -> Self:
        """Return the representation with all kinds' blades, ready to be planted on a ground."""
        return cls(quality, ground, stock_blades(growths, quality.patch, coming))

    def defines(self, grown: Grown, /) -> Mapping[str, str | int]:
        """Return the defines of kinds with segment counts of their own, and of kinds with teeth, ligules or eyes."""
        growths = [*grown.growths, *grown.coming.values()]
        special = {
            "TOOTHED": any_with(TEETH + LIGULES, growths), "LIGULES_TOO": any_with(LIGULES, growths),
            "EYED": any_eyes(growths),
        }  # fmt: skip
        return {**own_segment_defines(grown.own_segments), **{name: 1 for name, needed in special.items() if needed}}

    def rings(self) -> int:
        """Return the number of rings."""
        return len(self.quality.blade_rings)

    def keep(self, patches: PatchTable, side: int, /) -> BladesKept:
        """Return an empty pool of `side` by `side` patches."""
        return BladesKept(BladePool(side, self.stock.kinds), self.name)

    def sublevels(self, outlook: Outlook, rows: Rows, held: Levels, /, *, slack: int) -> Levels:
        """Return the ring that is due on patches (n,) that hold the rings `held`, shape (n,)."""
        limits = np.array(outlook.lens.rings_in(tuple(ring.to for ring in self.quality.blade_rings[:-1])), np.float32)
        return blade_ring(outlook.patches.away[rows], held, limits, slack=slack)

    def show(self, outlook: Outlook, cover: NDArray[np.float32], /) -> BladesShown:
        """Return the patches with blades, by ring, and the morphing ones."""
        kept = outlook.keeps(BladesKept)
        level = outlook.patches.names.index(self.name)
        shown = show_blades(outlook, cover, level=level, side=kept.pool.side, rings=self.rings())
        kept.receiving[0].show(shown.standing.rows, shown.standing.slots)
        return shown

    def plant(self, outlook: Outlook, /) -> None:
        """Plant the patches whose slot holds another cell, and update the slots that were sown."""
        patches, kept, shown = outlook.patches, outlook.keeps(BladesKept), outlook.shows(BladesShown).standing
        pool = kept.pool
        differs = pool.stamp.take(shown.slots, axis=0) != patches.cell.take(shown.rows, axis=0)
        if differs.any():
            kept.planted += 1
            stale = differs.any(axis=1)
            rows = shown.rows[stale]
            cell, model, turn = patches.cell[rows], patches.model[rows], patches.turn[rows]
            plant_blades(pool, shown.slots[stale], cell, model, turn, self.stock, self.ground)
        sown = pool.sown.take(shown.slots, axis=0)
        stale = sown[:, 0] != sown[:, 1]
        if stale.any():
            kept.planted += 1
            sow_blades(pool, shown.slots[stale], patches.model[shown.rows[stale]], self.stock, self.ground)

    def carry_ahead(self, before: Representation, kept: Kept, patches: PatchTable, /) -> bool:
        """Prepare the pool of `carry`, which takes as long as a frame; return whether it had been prepared."""
        assert isinstance(kept, BladesKept)
        if kept.ahead is not None and kept.ahead[0] is self:
            return True
        kept.ahead = self, self._carried(before, kept, patches), kept.slot_states()
        return False

    def carry(self, before: Representation, kept: Kept, patches: PatchTable, /) -> None:
        """Replace the blades of `before` by these on all slots; only new forms are planted."""
        assert isinstance(kept, BladesKept)
        if kept.ahead is None or kept.ahead[0] is not self:
            kept.hold(self._carried(before, kept, patches))
            return
        _, pool, states = kept.ahead
        pool.ground[:] = kept.pool.ground
        pool.stamp[(kept.slot_states() != states).any(axis=1)] = NOWHERE
        kept.hold(pool)

    def _carried(self, before: Representation, kept: BladesKept, patches: PatchTable) -> BladePool:
        """Return a pool of these blades on the slots where those of `before` stand."""
        assert isinstance(before, BladeRepresentation)
        pool = BladePool(kept.pool.side, self.stock.kinds)
        carry_blades(pool, self.stock, kept.pool, before.stock, patches, self.ground)
        return pool

    def painter(self, canvas: Canvas, /) -> BladesPainter:
        """Return a painter of all rings."""
        strips = next(each for each in canvas.representations if isinstance(each, StripRepresentation))
        return BladesPainter(canvas, self.stock, strips, self.quality)


def blade_ring(distance: Ints, current: Levels, limits: Floats, /, *, slack: int) -> Levels:
    """Return the ring of 3D patches (n,) by discrete distance; a finer current one is kept `slack` patches longer."""
    coarse, fine = limits.searchsorted(distance), limits.searchsorted(distance - slack)
    return np.where(current < 0, coarse, np.minimum(np.maximum(current, fine), coarse)).astype(np.int8)
