"""2.5D: vertical strips with the blades painted on them (paper, section 2.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Levels, Mask, Rows
from ....engine.declared.grass import GrassKind
from ....engine.declared.quality import Quality, StripRing
from ...around.kept import Kept
from ...around.outlook import Outlook
from ...around.patches import PatchTable
from ...grow.record import NOTHING, Growth
from ...grow.section import SECTIONS
from ...mow.mown import Mown
from ...space.canopy import lodged
from ...space.ground import Ground
from ..representation import Canvas, Color, Representation, Seedling
from .grow import Strips, grow_strips, texel_of
from .painter import StripsPainter
from .plant import growing_on, plant_strips
from .pool import StripPool, StripsKept
from .shown import StripsOfRing, StripsShown, show_strips
from .stock import StripStock, stock_strips
from .sublevel import (
    axis_of,
    left_of,
    looked_down_on,
    packed,
    ring_of,
    shows_rows,
    strip_ring,
    strips_along,
    viewing_slope,
)
from .textures import Atlas, strip_atlas, strip_stocks

USUAL = 0.4
"""Posture index of a usual breeze: how fine strips have to be is measured in it."""


@dataclass(frozen=True, slots=True, eq=False)
class StripRepresentation(Representation):
    """Strips between blades and carpet: their vertical edges are the receivers."""

    name: ClassVar[str] = "strips"
    label: ClassVar[str] = "2.5D strips"
    programs = 9
    color: ClassVar[Color] = (0.12, 0.50, 0.98)
    grows_out_of: ClassVar[str | None] = "carpet"
    samplers: ClassVar[tuple[str, ...]] = ("atlas", "ranks", "extents", "strips", "placements")
    asked: ClassVar[tuple[str, ...]] = ("placements",)
    record: ClassVar[type | None] = Strips

    stock: StripStock
    growths: Sequence[Growth]

    ready: list[Atlas] = field(default_factory=list)
    """What the next painter takes of what was made beforehand; empty where nothing was."""

    @staticmethod
    def reach(quality: Quality, /) -> int:
        """Return where its last ring ends."""
        return quality.strip_rings[-1].to

    @staticmethod
    def depends(kind: GrassKind, quality: Quality, /) -> object:
        """Return how fine its rings are, and whether they are seen from far."""
        del kind
        return [(ring.strips, ring.texel, _from_far(ring, quality)) for ring in quality.strip_rings]

    @staticmethod
    def grow(seedling: Seedling, /) -> tuple[Strips, ...]:
        """Return a patch model's strips, a record for each ring."""
        quality = seedling.quality
        finest = min(ring.texel for ring in quality.strip_rings)
        return tuple(
            grow_strips(
                seedling.blades, seedling.postures, patch=quality.patch, strips=ring.strips,
                texel=texel_of(ring.texel, finest, seedling.height, far=_from_far(ring, quality)),
                taper=seedling.kind.taper, margin=seedling.margin, height=seedling.height,
                section=SECTIONS[seedling.kind.profile],
            )
            for ring in quality.strip_rings
        )  # fmt: skip

    @staticmethod
    def fits(pictures: tuple[Any, ...], quality: Quality, blades: int, /) -> bool:
        """Return whether there is a record of the right shapes for each ring."""
        rings = quality.strip_rings
        return len(pictures) == len(rings) and all(
            strips.plane.shape == (ring.strips,)
            and strips.texels.ndim == 5
            and strips.texels.shape[:2] == (2, ring.strips)
            and strips.texels.shape == (*strips.ranks.shape, 4)
            and strips.slice.shape == (2, blades)
            for strips, ring in zip(pictures, rings, strict=True)
        )

    @staticmethod
    def layers(quality: Quality, /) -> int:
        """Return how many strips there are in all rings, in both orientations."""
        return 2 * sum(ring.strips for ring in quality.strip_rings)

    @classmethod
    def stocked(
        cls, growths: Sequence[Growth], quality: Quality, ground: Ground, coming: Mapping[int, Growth] = NOTHING, /
    ) -> Self:
        """Return it with all kinds' strips, ready to be planted on a ground."""
        return cls(quality, ground, stock_strips(growths, coming), growths)

    def prepare(self) -> None:
        """Make the atlas for the next painter."""
        self.ready[:] = [
            strip_atlas(
                strip_stocks([form.growth for form in self.stock.forms]),
                [ring.columns for ring in self.quality.strip_rings],
            )
        ]

    def rings(self) -> int:
        """Return how many rings it has."""
        return len(self.quality.strip_rings)

    def ring(self, sublevel: Levels, /) -> Levels:
        """Return the ring that each sub-level (n,) is of."""
        return ring_of(sublevel).astype(np.int8)

    def keep(self, patches: PatchTable, side: int, /) -> StripsKept:
        """Return an empty pool for each ring."""
        del patches
        pools = [
            StripPool(side, strips, ring.columns, self.quality.patch)
            for strips, ring in zip(self.stock.own, self.quality.strip_rings, strict=True)
        ]
        return StripsKept(pools, self.name)

    def margin(self) -> float:
        """Return how far strips reach beyond their patch."""
        return self.stock.margin

    def sublevels(self, outlook: Outlook, rows: Rows, held: Levels, /, *, slack: int) -> Levels:
        """Return the ring and the axis that are due on patches (n,), as one number each."""
        patches, viewer, quality = outlook.patches, outlook.viewer, self.quality
        limits = np.array([self._reach(outlook, ring) for ring in quality.strip_rings[:-1]], np.float32)
        spacing, height = self._spacing(), self._height(outlook)
        slope, _ = viewing_slope(patches, rows, eye=viewer.eye, patch=quality.patch)
        # Halved, -1 for none is -1 again.
        ring = strip_ring(patches.away[rows], slope, held >> 1, limits, spacing, height=height, slack=slack)
        keeps = np.where(held < 0, held, held & 1) if slack else np.full_like(held, -1)
        return packed(ring, strips_along(patches.cell.take(rows, axis=0), viewer.centre, keeps))

    def unfit(self, outlook: Outlook, rows: Rows, has: Mask, /, *, slack: int) -> Mask:
        """Return which patches (n,) are seen from so high that strips would show as rows, however fine."""
        away = outlook.patches.away[rows].astype(np.float32) / np.float32(outlook.lens.factor)
        slope, height, spacing = self._seen(outlook, rows, away)
        return shows_rows(slope, away, has, height=height, spacing=spacing, slack=slack)

    def remaining(self, outlook: Outlook, rows: Rows, away: Floats, /) -> Floats:
        """Return how much of strips is left on patches (n,): they sink where they come near to being unfit."""
        away = away / np.float32(outlook.lens.factor)
        slope, height, spacing = self._seen(outlook, rows, away)
        return left_of(slope, away, height=height, spacing=spacing)

    def _seen(self, outlook: Outlook, rows: Rows, away: Floats | NDArray[np.int32], /) -> tuple[Floats, Floats, float]:
        """Return as how steep patches (n,) count, how high strips stand there, and how far apart the finest do.

        A patch is as far `away` as one that is seen as large without a long lens: rows show by how thin blades look.
        Where all of a patch is mown short, the strips are as short.
        """
        patches, side = outlook.patches, self.quality.patch
        height = np.full(len(rows), self._height(outlook), np.float32)
        mown = outlook.noted(Mown, None)
        if mown is not None and mown.strokes:
            height = np.minimum(height, mown.tops(patches.cell[rows], patch=side))
        slope, drop = viewing_slope(patches, rows, eye=outlook.viewer.eye, patch=side)
        return looked_down_on(slope, drop, away), height, float(self._spacing().min())

    def _reach(self, outlook: Outlook, ring: StripRing) -> float:
        """Return up to where a ring is due: nowhere beyond the blades, where it is for patches seen from above."""
        quality = self.quality
        near = quality.blade_rings[-1].to
        if ring.to > near:
            return outlook.lens.rings_in((ring.to,))[0]
        blades, *_ = outlook.lens.reach_in((near, self.reach(quality), quality.carpet_to))
        return ring.to * blades / max(near, 1)

    def _spacing(self) -> NDArray[np.float32]:
        """Return the distance between each ring's strips [m]."""
        return np.array([self.quality.patch / ring.strips for ring in self.quality.strip_rings], np.float32)

    def _height(self, outlook: Outlook) -> float:
        """Return the height of the lowest kind's strips [m]; a wind that is stronger than usual bends them."""
        index = (max(float(growth.postures.bent_by(outlook.mean_index)), USUAL) for growth in self.growths)
        stand = (lodged(each) / lodged(USUAL) for each in index)
        return min(strips.height * each for strips, each in zip(self.stock.own[0], stand, strict=True))

    def ring_and_axis(self, outlook: Outlook, rows: Rows, /) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
        """Return the ring that patches (n,) are in, and the axis that their strips run along, shape (n,) each."""
        sublevel = outlook.patches.sublevel[outlook.patches.names.index(self.name), rows]
        return ring_of(sublevel), axis_of(sublevel)

    def show(self, outlook: Outlook, cover: NDArray[np.float32], /) -> StripsShown:
        """Return the patches with strips, by ring."""
        level = outlook.patches.names.index(self.name)
        kept = outlook.keeps(StripsKept)
        shown = show_strips(outlook, cover, level=level, side=kept.pools[0].side, rings=self.rings())
        for receiving, ring in zip(kept.receiving, shown.rings, strict=True):
            receiving.show(ring.rows, ring.slots)
        return shown

    def plant(self, outlook: Outlook, /) -> None:
        """Plant the strips of patches whose slot holds another's, or strips that run the other way."""
        patches, kept = outlook.patches, outlook.keeps(StripsKept)
        stale = list[tuple[StripPool, StripsOfRing, NDArray[np.intp]]]()
        for pool, shown in zip(kept.pools, outlook.shows(StripsShown).rings, strict=True):
            wanted = np.empty((len(shown.rows), 3), np.int32)
            wanted[:, :2], wanted[:, 2] = patches.cell.take(shown.rows, axis=0), shown.along
            differs = pool.stamp.take(shown.slots, axis=0) != wanted
            if differs.any():
                stale.append((pool, shown, np.flatnonzero(differs.any(axis=1))))
        if not stale:
            return
        kept.planted += 1
        cells = patches.cell[np.concatenate([shown.rows[which] for _, shown, which in stale])]
        growing, first = growing_on(cells, self.ground, self.margin()), 0  # of all rings at once, that is faster
        for pool, shown, which in stale:
            rows, last = shown.rows[which], first + len(which)
            plant_strips(
                pool, shown.slots[which], cells[first:last], patches.model[rows], patches.turn[rows],
                shown.along[which], growing.some(first, last),
            )  # fmt: skip
            first = last

    def painter(self, canvas: Canvas, /) -> StripsPainter:
        """Return a painter of all rings."""
        return StripsPainter(canvas, self.stock, self.quality, self.atlas())

    def atlas(self) -> Atlas:
        """Return the atlas, as it was made beforehand if it was."""
        if not self.ready:
            self.prepare()
        return self.ready.pop()

    def carry(self, before: Representation, kept: Kept, patches: PatchTable, /) -> None:
        """Let these strips stand where the others did: it is the same kinds that grow there."""
        del before, patches
        assert isinstance(kept, StripsKept)
        for pool, strips in zip(kept.pools, self.stock.own, strict=True):
            pool.strips[:] = strips


def _from_far(ring: StripRing, quality: Quality, /) -> bool:
    """Return whether a ring is seen beyond the last blades: nearer strips stand only where they are seen from above."""
    return ring.to > quality.blade_rings[-1].to
