"""Quality: fineness and reach of each representation."""

from itertools import pairwise
from typing import TYPE_CHECKING, Literal

from pydantic import Field, model_validator

from ...components.declaration import Declaration, DeclarationError

LodName = Literal["auto", "blades", "strips", "carpet"]
"""Representation that is drawn: by distance, or one of them everywhere."""


class BladeRing(Declaration):
    """A sub-level of the 3D blades."""

    to: int = Field(ge=0, le=64)
    """Largest discrete distance of the ring."""

    segments: int = Field(ge=1, le=16)
    """Line segments per blade."""


class StripRing(Declaration):
    """A sub-level of the 2.5D strips."""

    to: int = Field(ge=0, le=128)
    """Largest discrete distance of the ring. A ring that reaches no farther than the one before it, or than the
    blades, is for patches seen from above, where coarser strips would show as rows."""

    strips: int = Field(ge=1, le=32)
    """Strips per patch and orientation."""

    columns: int = Field(default=2, ge=1, le=8)
    """Quads side by side in each strip; they share their vertical edges."""

    sections: int = Field(default=3, ge=1, le=8)
    """Quads one above the other, over which a vertical edge bends."""

    texel: float = Field(default=0.006, ge=0.001, le=0.5)
    """Width and height of a texel [m]."""


class Quality(Declaration):
    """The numbers behind a preset (paper, section 5.1)."""

    patch: float = Field(default=2.5, ge=0.5, le=20.0)
    """Side of a patch of grass [m]."""

    blades: int = Field(default=500, ge=1, le=5000)
    """Blades per patch at full density, for kinds without a number of their own."""

    models: int = Field(default=3, ge=1, le=16)
    """Patch models per kind; each is also turned by quarter turns, so that no repetition shows. With many kinds there
    are fewer, if textures would have no room for all."""

    blade_rings: list[BladeRing] = Field(min_length=1, max_length=16)
    """Sub-levels of the 3D blades, from the nearest."""

    strip_rings: list[StripRing] = Field(min_length=1, max_length=16)
    """Sub-levels of the 2.5D strips, from the nearest."""

    edge: float = Field(default=0.5, ge=0.25, le=0.5)
    """Half the width of the soft edges of blades [pixels]: where they are narrower, blades cost less and are less
    smooth."""

    carpet_to: int = Field(default=40, ge=1, le=160)
    """Largest discrete distance at which patches are kept; the ground beyond is one carpet."""

    carpet: int = Field(default=128, ge=8, le=1024)
    """Texels along a side of a carpet image."""

    coarse: bool = False
    """Whether the carpet has one image of each kind, and the ground's mesh far off half as many points along a side: at
    three fifths of the cost. With more than four kinds, only the mesh is coarser. Clouds have fewer pixels, too."""

    pixels: float = Field(default=1.0, ge=0.25, le=1.0)
    """Resolution along each side as a fraction of the picture's; below 1 the picture is scaled up afterwards."""

    @model_validator(mode="after")
    def _rising_rings(self) -> "Quality":
        limits: list[tuple[int, tuple[str | int, ...]]] = [
            *((ring.to, ("blade_rings", i, "to")) for i, ring in enumerate(self.blade_rings)),
            *((ring.to, ("strip_rings", i, "to")) for i, ring in enumerate(self.strip_rings)),
            (self.carpet_to, ("carpet_to",)),
        ]
        for (before, _), (to, where) in pairwise(limits):
            also = where[0] == "strip_rings"
            if to < before or (to == before and not also):
                least = "be at least" if also else "exceed"
                raise DeclarationError(f"{where[-1]} must {least} {before}, where the ring before it ends", *where)
        return self


def _quality(
    blades: int,
    blade_rings: list[tuple[int, int]],
    strip_rings: list[tuple[int, int, int, int, float]],
    carpet_to: int,
    *,
    coarse: bool = False,
    edge: float = 0.5,
    pixels: float = 1.0,
) -> Quality:
    return Quality(
        blades=blades,
        blade_rings=[BladeRing(to=to, segments=segments) for to, segments in blade_rings],
        strip_rings=[
            StripRing(to=to, strips=strips, columns=columns, sections=sections, texel=texel)
            for to, strips, columns, sections, texel in strip_rings
        ],
        carpet_to=carpet_to,
        coarse=coarse,
        edge=edge,
        pixels=pixels,
    )


HALF = 0.5
"""Resolution along each side of `minimal`: a quarter of all pixels."""

PRESETS: dict[str, Quality] = {
    "minimal": _quality(100, [(1, 3), (7, 3)], [(12, 1, 1, 1, 0.012)], 32, coarse=True, pixels=HALF),
    "low": _quality(160, [(1, 3), (8, 3)], [(12, 1, 1, 1, 0.012)], 32, coarse=True, edge=0.33),
    "medium": _quality(320, [(1, 4), (6, 4)], [(6, 4, 1, 2, 0.012), (16, 2, 1, 1, 0.012)], 36, coarse=True),
    "high": _quality(
        500,
        [(1, 8), (3, 6), (6, 4)],
        [(6, 4, 1, 2, 0.008), (11, 3, 1, 2, 0.012), (20, 2, 1, 1, 0.016)],
        40,
        edge=0.42,
    ),
    "ultra": _quality(
        800,
        [(2, 8), (5, 6), (8, 4)],
        [(8, 18, 1, 2, 0.012), (8, 12, 1, 2, 0.01), (10, 8, 2, 3, 0.006), (16, 4, 2, 2, 0.012), (28, 3, 1, 2, 0.016)],
        48,
    ),
    "paper-low": _quality(160, [(2, 3)], [(8, 8, 2, 3, 0.008)], 29),
    "paper-medium": _quality(320, [(1, 4)], [(12, 8, 2, 3, 0.008)], 48),
    "paper-high": _quality(500, [(2, 8)], [(20, 8, 2, 3, 0.008)], 56),
}
"""The presets by name: the paper's three instances, and those that people use (paper, section 5.1).

Blades of the first ring are drawn in two passes, all farther ones in one. So the presets for use begin with a near
ring, even if the next one has as many segments. Their blades reach farther than the paper's: up to there they cost no
more than strips and are much nearer to the truth.

The paper's presets reach so far that the picture of a wide enough `plain` has about 100,000, 500,000 and 1,000,000
blades.
"""

if TYPE_CHECKING:
    PresetName = str
else:
    PresetName = Literal[tuple(PRESETS)]
"""Name of a preset."""
