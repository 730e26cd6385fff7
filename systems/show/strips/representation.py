"""2.5D: vertical strips with the blades painted on them (paper, section 2.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Self

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
    effective_slope,
    packed,
    remaining,
    ring_of,
    shows_rows,
    strip_ring,
    strips_along,
    viewing_slope,
)
from .textures import Atlas, strip_atlas, strip_stocks

USUAL = 0.4
"""Posture index of a usual breeze, in which the height of grass is taken for the choice of rings."""


@dataclass(frozen=True, slots=True, eq=False)
class StripRepresentation(Representation):
    """Strips, drawn between blades and carpet. Their vertical edges are the receivers."""

    name: ClassVar[str] = "strips"
    label: ClassVar[str] = "2.5D strips"
    programs = 9
    color: ClassVar[Color] = (0.12, 0.50, 0.98)
    grows_out_of: ClassVar[str | None] = "carpet"
    samplers: ClassVar[tuple[str, ...]] = ("atlas", "ranks", "extents", "strips", "placements")
    pass_samplers: ClassVar[tuple[str, ...]] = ("placements",)
    record: ClassVar[type | None] = Strips

    stock: StripStock
    growths: Sequence[Growth]

    ready: list[Atlas] = field(default_factory=list)
    """The atlas that `prepare` made for the next painter; empty if it was not called."""

    @staticmethod
    def reach(quality: Quality, /) -> int:
        """Return the distance at which the last ring ends."""
        return quality.strip_rings[-1].to

    @staticmethod
    def depends(kind: GrassKind, quality: Quality, /) -> object:
        """Return each ring's number of strips and width of texels, and whether it is seen from far."""
        return [(ring.strips, ring.texel, _from_far(ring, quality)) for ring in quality.strip_rings]

    @staticmethod
    def grow(seedling: Seedling, /) -> tuple[Strips, ...]:
        """Return the strips of a patch model, one object for each ring."""
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
    def layers(quality: Quality, /) -> int:
        """Return the number of strips in all rings, in both orientations."""
        return 2 * sum(ring.strips for ring in quality.strip_rings)

    @classmethod
    def stocked(
        cls, growths: Sequence[Growth], quality: Quality, ground: Ground, coming: Mapping[int, Growth] = NOTHING, /
    ) -> Self:
        """Return the strips of all kinds, ready to be planted on a ground."""
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
        """Return the number of rings."""
        return len(self.quality.strip_rings)

    def ring(self, sublevel: Levels, /) -> Levels:
        """Return the ring of each sub-level (n,)."""
        return ring_of(sublevel).astype(np.int8)

    def keep(self, patches: PatchTable, side: int, /) -> StripsKept:
        """Return an empty pool for each ring."""
        pools = [
            StripPool(side, strips, ring.columns, self.quality.patch)
            for strips, ring in zip(self.stock.present, self.quality.strip_rings, strict=True)
        ]
        return StripsKept(pools, self.name)

    def margin(self) -> float:
        """Return the largest distance that strips reach beyond their patch [m]."""
        return self.stock.margin

    def sublevels(self, outlook: Outlook, rows: Rows, held: Levels, /, *, slack: int) -> Levels:
        """Return the sub-levels that patches (n,) are to have: ring and axis as one number."""
        patches, viewer, quality = outlook.patches, outlook.viewer, self.quality
        limits = np.array([self._reach(outlook, ring) for ring in quality.strip_rings[:-1]], np.float32)
        spacing, height = self._spacing(), self._height(outlook)
        slope, _ = viewing_slope(patches, rows, eye=viewer.eye, patch=quality.patch)
        held_ring = held >> 1  # -1, for none, stays -1
        ring = strip_ring(patches.away[rows], slope, held_ring, limits, spacing, height=height, slack=slack)
        held_axis = np.where(held < 0, held, held & 1) if slack else np.full_like(held, -1)
        return packed(ring, strips_along(patches.cell.take(rows, axis=0), viewer.centre, held_axis))

    def unfit(self, outlook: Outlook, rows: Rows, has: Mask, /, *, slack: int) -> Mask:
        """Return on which patches (n,) even the finest strips would show as rows, as they are seen from above."""
        away = outlook.patches.away[rows].astype(np.float32) / np.float32(outlook.lens.factor)
        slope, height, spacing = self._row_factors(outlook, rows, away)
        return shows_rows(slope, away, has, height=height, spacing=spacing, slack=slack)

    def remaining(self, outlook: Outlook, rows: Rows, away: Floats, /) -> Floats:
        """Return the part of strips that shows on patches (n,): they sink before they become unfit."""
        away = away / np.float32(outlook.lens.factor)
        slope, height, spacing = self._row_factors(outlook, rows, away)
        return remaining(slope, away, height=height, spacing=spacing)

    def _row_factors(
        self, outlook: Outlook, rows: Rows, away: Floats | NDArray[np.int32], /
    ) -> tuple[Floats, Floats, float]:
        """Return what decides whether strips show as rows on patches (n,).

        That is the effective slope of sight (n,), the height of strips (n,) [m], and the spacing of the finest [m].
        `away` is divided by the lens's factor, as rows show by how thin blades look. On a patch that is mown short all
        over, strips are as short.
        """
        patches, side = outlook.patches, self.quality.patch
        height = np.full(len(rows), self._height(outlook), np.float32)
        mown = outlook.noted(Mown, None)
        if mown is not None and mown.strokes:
            height = np.minimum(height, mown.tops(patches.cell[rows], patch=side))
        slope, drop = viewing_slope(patches, rows, eye=outlook.viewer.eye, patch=side)
        return effective_slope(slope, drop, away), height, float(self._spacing().min())

    def _reach(self, outlook: Outlook, ring: StripRing) -> float:
        """Return the distance at which a ring ends; one for patches seen from above stays within the blades' reach."""
        quality = self.quality
        blades_to = quality.blade_rings[-1].to
        if ring.to > blades_to:
            return outlook.lens.rings_in((ring.to,))[0]
        blades, *_ = outlook.lens.reach_in((blades_to, self.reach(quality), quality.carpet_to))
        return ring.to * blades / max(blades_to, 1)

    def _spacing(self) -> NDArray[np.float32]:
        """Return the distance between the strips of each ring [m]."""
        return np.array([self.quality.patch / ring.strips for ring in self.quality.strip_rings], np.float32)

    def _height(self, outlook: Outlook) -> float:
        """Return the height of the lowest kind's strips [m], lowered where a wind is stronger than usual."""
        index = (max(float(growth.postures.bent_by(outlook.mean_index)), USUAL) for growth in self.growths)
        lowered = (lodged(each) / lodged(USUAL) for each in index)
        return min(strips.height * factor for strips, factor in zip(self.stock.present[0], lowered, strict=True))

    def ring_and_axis(self, outlook: Outlook, rows: Rows, /) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
        """Return the ring of patches (n,), and the axis that their strips run along, shape (n,) each."""
        sublevel = outlook.patches.sublevel[outlook.patches.names.index(self.name), rows]
        return ring_of(sublevel), axis_of(sublevel)

    def show(self, outlook: Outlook, cover: NDArray[np.float32], /) -> StripsShown:
        """Return the patches that show strips, by ring."""
        level = outlook.patches.names.index(self.name)
        kept = outlook.keeps(StripsKept)
        shown = show_strips(outlook, cover, level=level, side=kept.pools[0].side, rings=self.rings())
        for receiving, ring in zip(kept.receiving, shown.rings, strict=True):
            receiving.show(ring.rows, ring.slots)
        return shown

    def plant(self, outlook: Outlook, /) -> None:
        """Plant the strips of shown patches whose slot holds another patch, or strips along the other axis."""
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
        cells = patches.cell[np.concatenate([shown.rows[index] for _, shown, index in stale])]
        growing, first = growing_on(cells, self.ground, self.margin()), 0  # faster for all rings at once
        for pool, shown, index in stale:
            rows, last = shown.rows[index], first + len(index)
            plant_strips(
                pool, shown.slots[index], cells[first:last], patches.model[rows], patches.turn[rows],
                shown.along[index], growing.some(first, last),
            )  # fmt: skip
            first = last

    def painter(self, canvas: Canvas, /) -> StripsPainter:
        """Return a painter of all rings."""
        return StripsPainter(canvas, self.stock, self.quality, self.atlas())

    def atlas(self) -> Atlas:
        """Return the atlas of all strips, which `prepare` may have made already."""
        if not self.ready:
            self.prepare()
        return self.ready.pop()

    def carry(self, before: Representation, kept: Kept, patches: PatchTable, /) -> None:
        """Replace the strips of the pools; the same kinds grow on all patches as before."""
        assert isinstance(kept, StripsKept)
        for pool, strips in zip(kept.pools, self.stock.present, strict=True):
            pool.strips[:] = strips


def _from_far(ring: StripRing, quality: Quality, /) -> bool:
    """Return whether a ring reaches beyond the blades; rings that do not are shown only to a viewer above."""
    return ring.to > quality.blade_rings[-1].to
