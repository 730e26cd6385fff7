"""Growing strips: images of the blades in vertical slices of a patch, in both orientations (paper, section 2.2)."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Doubles, Floats
from ...grow.bend import highest_tip, ribbon, sides_of, spine, tone
from ...grow.dye import eyed
from ...grow.organs import HEADS, has_eyes
from ...grow.raster import Fragments, along_ribbons, interpolate, rasterise, ribbon_triangles
from ...grow.record import Blades, PatchModel, Postures
from ...grow.section import FLAT, Section


@dataclass(frozen=True, slots=True, eq=False)
class Strips:
    """The blades of one patch model drawn on vertical strips, in both orientations (paper, section 2.1).

    Orientation 0 has strips along x, stacked in z; orientation 1 has strips along z, stacked in x.
    """

    plane: Floats
    """Distance of each strip's plane from the patch's edge [m], shape (strips,)."""

    texels: Bytes
    """Texels premultiplied by coverage, bottom row first, shape (2, strips, h, w, 4): tone, cosine c and sine s of
    twice the face normal's azimuth (0.5 + 0.5 c, 0.5 + 0.5 s), coverage. The tone of a grass blade is the place along
    it. For kinds whose heads have eyes, the fraction of the eye's colour replaces the sine."""

    ranks: Bytes
    """Rank of the blades in each texel, premultiplied by coverage, shape (2, strips, h, w)."""

    height: float
    """Height of the texture [m]."""

    margin: float
    """Distance that the texture reaches beyond the patch at either end [m]."""

    slice: NDArray[np.int32]
    """Index of the strip that each blade is painted on, shape (2, n)."""

    @property
    def patch(self) -> float:
        """Side of the patch [m]."""
        return 2.0 * float(self.plane[0]) * len(self.plane)


_SEGMENTS = 12

SLANT = 0.16
"""Tangent of the angle from which heads are painted, looking down. It is the same for the view from either side, as
heads are about round."""


_TEXELS_UP = 96, 140
"""Number of texels from the ground to the highest tip above which texels get coarser, and the largest number: tall
kinds have broad blades, which need fewer."""

_COARSE = 0.011
"""Width of a texel [m] that is fine enough for broad blades in all rings."""


def texel_of(texel: float, finest: float, height: float, /, *, far: bool) -> float:
    """Return the width of a kind's texels [m] in a ring of width `texel` [m]; that of the finest ring is `finest` [m].

    The texels of all rings get coarser with the kind's `height` [m], until broad blades would blur. From there on, the
    width in a ring seen from `far` is the largest of `texel`, the width for broad blades, and the least that there is
    room for.
    """
    least, most = _TEXELS_UP
    coarser = texel * max(height / least / finest, 1.0)
    return max(texel, _COARSE, height / most) if far and height > least * _COARSE else coarser


def strips_of(model: PatchModel, /) -> tuple[Strips, ...]:
    """Return the strips of a patch model by ring, from the nearest to the farthest: fewer strips, coarser texels."""
    return model.pictures["strips"]


def grow_strips(
    blades: Blades,
    postures: Postures,
    /,
    *,
    patch: float,
    strips: int,
    texel: float,
    taper: float,
    margin: float,
    height: float | None = None,
    section: Section = FLAT,
) -> Strips:
    """Return the strips of a patch model, drawn from its blades at rest.

    A strip shows the blades whose roots lie in its slice, seen along the slice's normal. Where blades cross, the lower
    rank lies in front: depth in a flat strip means little, and a blade that stays where its kind grows thinly must not
    be hidden by one that goes. Face normals are kept as their doubled azimuth: both sides of a blade are lit alike, and
    light is linear in its cosine and sine, so that means over many blades are right. The texture spans -`margin` to
    `patch` + `margin`, and the ground to `height` [m], by default the highest tip. Its texels are square but for
    rounding, at most `texel` metres wide.
    """
    if height is None:
        height = highest_tip(spine(blades, postures, (0.0, 0.0), points=postures.shape.shape[2]), texel)
    size = _count(height, texel), _count(patch + 2.0 * margin, texel)
    shared = _Sheet(
        blades, postures, strips=strips, patch=patch, margin=margin, height=height, size=size, taper=taper,
        section=section,
    )  # fmt: skip
    images = np.stack([shared.draw(orientation) for orientation in (0, 1)])
    return Strips(
        plane=((np.arange(strips) + 0.5) * (patch / strips)).astype(np.float32),
        texels=np.ascontiguousarray(images[..., :4]),
        ranks=np.ascontiguousarray(images[..., 4]),
        height=height,
        margin=margin,
        slice=np.stack([shared.slice(orientation) for orientation in (0, 1)]),
    )


def targets_on(strips: Strips, blades: Blades, postures: Postures, /) -> Floats:
    """Return the texture coordinates (u, v) at which blades' control points are painted, shape (2, n, points, 2).

    They are the targets of the morph (paper, section 4.2), and the same on strips of all rings.
    """
    centre = spine(blades, postures, (0.0, 0.0), points=postures.shape.shape[2])
    u = (centre[:, :, ::2].astype(np.float64) + strips.margin) / (strips.patch + 2.0 * strips.margin)
    v = centre[:, :, 1].astype(np.float64) / strips.height
    return np.stack([np.stack([u[:, :, axis], v], axis=2) for axis in (0, 1)]).astype(np.float32)


def _count(length: float, texel: float, /) -> int:
    return max(int(np.ceil(length / texel - 1e-6)), 1)


class _Sheet:
    """The image that strips of one orientation are drawn on, one above another, and the blades to draw."""

    def __init__(
        self,
        blades: Blades,
        postures: Postures,
        /,
        *,
        strips: int,
        patch: float,
        margin: float,
        height: float,
        size: tuple[int, int],
        taper: float,
        section: Section,
    ) -> None:
        self._blades, self._strips, self._size = blades, strips, size
        self._patch, self._margin, self._height = patch, margin, height
        draw = partial(ribbon, blades, postures, (0.0, 0.0), points=_SEGMENTS + 1, taper=taper, section=section)
        self._triangles = [ribbon_triangles(*draw(side=side)) for side in sides_of(section)]
        self._samples = int(np.clip(np.ceil(4.0 * height / size[0] / float(blades.width.mean())), 4, 10))
        """Number of samples across a texel, in either direction."""

    def slice(self, orientation: int, /) -> NDArray[np.int32]:
        """Return the index of the strip that each blade is painted on, shape (n,)."""
        depth = self._blades.root[:, 1 - orientation].astype(np.float64)
        return np.clip(depth / self._patch * self._strips, 0, self._strips - 1).astype(np.int32)

    def draw(self, orientation: int, /) -> Bytes:
        """Return the texels of one orientation and their ranks, shape (strips, h, w, 5)."""
        h, w = self._size
        fine = self._samples
        span = 2 * _SEGMENTS
        along = 2 * orientation
        ribbons = self._triangles[min(orientation, len(self._triangles) - 1)]
        corners = np.empty((*ribbons.shape[:2], 2))
        corners[:, :, 0] = (ribbons[:, :, along] + self._margin) * (w * fine / (self._patch + 2.0 * self._margin))
        up = ribbons[:, :, 1] + self._lifted(ribbons, 1 - orientation)
        front = np.repeat(-self._blades.rank.astype(np.float64), span)[:, None].repeat(3, axis=1)
        if has_eyes(self._blades):
            front -= self._behind(ribbons, 1 - orientation)
        corners[:, :, 1] = np.minimum(up / self._height, 1.0) * (h * fine)
        corners[:, :, 1] += np.repeat(self.slice(orientation), span)[:, None] * float(h * fine)
        shape = self._strips * h * fine, w * fine
        seen = rasterise(corners, front, shape=shape)
        values = self._values(corners, seen)
        if has_eyes(self._blades):
            toward = (0.0, SLANT, -1.0) if along == 0 else (-1.0, SLANT, 0.0)
            values[2] = interpolate(corners, eyed(self._blades, ribbons, points=_SEGMENTS + 1, toward=toward), seen)
        texel = (seen.sample // shape[1] // fine) * w + seen.sample % shape[1] // fine
        sums = [np.bincount(texel, weights=value, minlength=self._strips * h * w) for value in values]
        texels: Bytes = np.rint(np.stack(sums, axis=1) * (255.0 / fine**2)).astype(np.uint8)
        return texels.reshape(-1, h, w, 5)

    def _lifted(self, ribbons: Doubles, depth: int, /) -> Doubles | float:
        """Return the heights added to the corners of heads [m], which are seen from a little above, (triangles, 3)."""
        heads = np.repeat(np.isin(np.broadcast_to(self._blades.organ, self._blades.rank.shape), HEADS), 2 * _SEGMENTS)
        if not heads.any():
            return 0.0
        position = ribbons[:, :, 2 * depth]
        foot = position.reshape(-1, 2 * _SEGMENTS * 3)[:, :1].repeat(2 * _SEGMENTS, axis=0)
        return np.asarray(np.where(heads[:, None], SLANT * (position - foot), 0.0))

    def _behind(self, ribbons: Doubles, depth: int, /) -> Doubles:
        """Return the depth of corners behind their plant's root, in ranks, so that petals hide the eye behind them.

        It stays below half the step between two ranks. Shape (triangles, 3).
        """
        root, ranks = self._blades.root[:, depth].astype(np.float64), np.unique(self._blades.rank)
        offset = ribbons[:, :, 2 * depth] - np.repeat(root, 2 * _SEGMENTS)[:, None]
        return np.asarray(offset * (0.5 / len(ranks) / max(np.abs(offset).max(), 1e-6)))

    def _values(self, corners: Doubles, seen: Fragments, /) -> list[Doubles]:
        """Return each sample's tone, cosine and sine of twice the normal's azimuth, coverage of 1, and rank."""
        ends = along_ribbons(tone(self._blades, np.linspace(0.0, 1.0, _SEGMENTS + 1)))
        tones = interpolate(corners, ends, seen)
        facing, rank = self._blades.facing.astype(np.float64), self._blades.rank.astype(np.float64)
        blade = seen.triangle // (2 * _SEGMENTS)
        twice = [(0.5 + 0.5 * part(2.0 * facing)).take(blade) for part in (np.cos, np.sin)]
        return [tones, *twice, np.ones_like(tones), rank.take(blade)]
