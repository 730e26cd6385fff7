"""2D: a textured carpet on the terrain (paper, sections 2.1 and 4.3)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Rows
from ....engine.declared.grass import GrassKind
from ....engine.declared.quality import Quality
from ...around.outlook import Outlook
from ...around.patches import PatchTable
from ...grow.record import NOTHING, Growth
from ...grow.section import SECTIONS
from ...space.ground import Ground
from ..representation import Canvas, Color, Representation, Seedling
from .grow import SLOPES, Carpet, grow_carpet
from .painter import CarpetPainter
from .pool import CarpetKept, CarpetPool
from .stock import CarpetStock


@dataclass(frozen=True, slots=True, eq=False)
class CarpetRepresentation(Representation):
    """The carpet beyond the strips: a receiver in the middle of each patch moves leaves and changes their light."""

    name: ClassVar[str] = "carpet"
    label: ClassVar[str] = "2D carpet"
    programs = 18
    color: ClassVar[Color] = (0.72, 0.45, 0.95)
    samplers: ClassVar[tuple[str, ...]] = ("images", "bents", "shares", "far_air", "earth", "rims")
    pass_samplers: ClassVar[tuple[str, ...]] = ("air",)
    record: ClassVar[type | None] = Carpet

    stock: CarpetStock

    @staticmethod
    def reach(quality: Quality, /) -> int:
        """Return the largest discrete distance of the carpet, which is that of all patches."""
        return quality.carpet_to

    @staticmethod
    def depends(kind: GrassKind, quality: Quality, /) -> object:
        """Return the side of the images [texels]."""
        return quality.carpet

    @staticmethod
    def grow(seedling: Seedling, /) -> tuple[Carpet, ...]:
        """Return the images of a patch model."""
        quality = seedling.quality
        images = grow_carpet(
            seedling.blades, seedling.postures, patch=quality.patch, texels=quality.carpet, taper=seedling.kind.taper,
            height=seedling.height, section=SECTIONS[seedling.kind.profile],
        )  # fmt: skip
        return (images,)

    @staticmethod
    def layers(quality: Quality, /) -> int:
        """Return the number of images of a patch model."""
        return 4 * len(SLOPES)

    @classmethod
    def stocked(
        cls, growths: Sequence[Growth], quality: Quality, ground: Ground, coming: Mapping[int, Growth] = NOTHING, /
    ) -> Self:
        """Return the representation with the images of all kinds, and of what some are to become."""
        return cls(quality, ground, CarpetStock.of(growths, coming))

    def keep(self, patches: PatchTable, side: int, /) -> CarpetKept:
        """Return a store of one receiver per patch."""
        return CarpetKept(CarpetPool(patches, self.ground), self.name)

    def show(self, outlook: Outlook, cover: NDArray[np.float32], /) -> Rows:
        """Return the patches whose receivers feel the wind: those in the view cone, and their neighbours."""
        kept = outlook.keeps(CarpetKept)
        rows = (outlook.patches.alive & outlook.patches.near).nonzero()[0]
        kept.receiving[0].show(rows, rows)
        return rows

    def painter(self, canvas: Canvas, /) -> CarpetPainter:
        """Return a painter of ground and carpet."""
        return CarpetPainter(canvas, self.stock, self.ground, 2 * canvas.reach[-1] + 1, coarse=self.quality.coarse)
