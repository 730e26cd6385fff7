"""The carpet: images of an endless field of a patch model from several viewing angles (paper, section 2.2)."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Doubles, Floats
from ...grow.bend import highest_tip, ribbon, segment_normals, spine, tone
from ...grow.dye import eyed
from ...grow.organs import has_eyes
from ...grow.raster import Fragments, interpolate, rasterise, ribbon_triangles
from ...grow.record import LENGTHS, Blades, PatchModel, Postures
from ...grow.section import FLAT, Section
from ...space.canopy import lodged

_POINTS = 9
"""Points along the edges of blades that lines of sight meet."""


@dataclass(frozen=True, slots=True, eq=False)
class Carpet:
    """Images of an endless field of one patch model from several viewing angles (paper, section 2.2).

    An image holds, for each point of the plane at mid-height, what a ray through it meets first.
    """

    slope: Floats
    """Tangent of the viewing elevation of each row of images, rising, shape (slopes,)."""

    texels: Bytes
    """Coverage-premultiplied meaning of each texel, shape (slopes, 4, r, r, 4): place along the blade, height
    as a fraction of `height`, cosine c of twice the face normal's azimuth from the view (0.5 + 0.5 c), coverage. Of
    kinds whose heads have eyes, in place of that cosine, how much of the eye's colour it has. The four viewing
    directions are -z, +x, +z, -x in this order; rows go along z, columns along x."""

    height: float
    """Height of the canopy [m]."""

    bent: Floats
    """How what lines of sight meet of the field changes as it is bent, shape (`BENT_SLOPES`, `BENDS`, 3): by how many
    leaves; and by which factors the mean place along blades and the mean height in the canopy of what stops them. Rows
    are slopes, columns posture indices from -1, towards the eye, to 1, away from it."""


SLOPES = (0.02, 0.07, 0.25, 0.9, 3.2)
"""Tangents of the viewing elevations, a geometric series: each is about 3.5 times the one before."""

BENT_SLOPES, BENDS = 12, 9
"""How many slopes of lines of sight, and how many posture indices, `Carpet.bent` has."""

FLATTEST = 0.005
"""The least slope that is told apart: lines of sight that are flatter meet tips alone."""

STEEPEST = 20.0
"""The greatest slope that is told apart for bent grass: above it, all is seen straight from above."""

GLSL = {"SLOPES": len(SLOPES), "HEADINGS": 4, "LOWEST": SLOPES[0], "STEEPEST": STEEPEST, "FLATTEST": FLATTEST}

_SEGMENTS = 8
_SAMPLES_PER_WIDTH = 5.0
ASIDE = 0.618
"""How far each next patch of the endless field stands aside from the one before, in patches, to a whole texel: so few
of them stand in line."""

_HEADINGS = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])


def carpet_of(model: PatchModel, /) -> Carpet:
    """Return the carpet of a patch model."""
    carpet: Carpet
    (carpet,) = model.pictures["carpet"]
    return carpet


def grow_carpet(
    blades: Blades,
    postures: Postures,
    /,
    *,
    patch: float,
    texels: int,
    taper: float,
    slopes: tuple[float, ...] = SLOPES,
    height: float | None = None,
    section: Section = FLAT,
) -> Carpet:
    """Return images of the endless field of a patch model's blades at rest, `texels` wide and high.

    A ray that travels along a heading h and falls by `slope` meets a point at (x, z) and height y where it
    goes through the plane at mid-height o at (x, z) + h (y - o) / slope; of all such points it meets the
    highest first. Blades reach over the patch's edge into the next one, which is the same patch again: beside it in
    line, along the view by `ASIDE` aside. `height` is the canopy's [m]; without it, the highest tip's.
    """
    seen_along = [
        ribbon_triangles(*(edge.astype(np.float64) for edge in edges))
        for side in (((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)) if section.is_round else (None,))
        for edges in [
            ribbon(blades, postures, (0.0, 0.0), points=_SEGMENTS + 1, taper=taper, section=section, side=side)
        ]
    ]
    centre = spine(blades, postures, (0.0, 0.0), points=_SEGMENTS + 1)
    height = highest_tip(centre, 0.01) if height is None else height
    width = float(blades.width.mean())
    tones = tone(blades, np.linspace(0.0, 1.0, _SEGMENTS + 1))
    normals = segment_normals(blades, centre)
    field = _Field(seen_along, normals, tones, width, patch, height, texels, blades if has_eyes(blades) else None)
    images = [[field.draw(heading, slope) for heading in _HEADINGS] for slope in slopes]
    return Carpet(
        slope=np.asarray(slopes, np.float32),
        texels=np.stack([np.stack(row) for row in images]),
        height=height,
        bent=_bent(blades, postures, patch=patch, taper=taper, section=section),
    )


def _bent(blades: Blades, postures: Postures, /, *, patch: float, taper: float, section: Section) -> Floats:
    """Return `Carpet.bent`.

    Bent grass is lower: across a line of sight of some slope it has as much leaf as grass at rest has across a steeper
    one, and rows go by that.
    """
    at_rest, straight = (
        np.geomspace(FLATTEST, STEEPEST, BENT_SLOPES),
        replace(postures, give=LENGTHS.astype(np.float32)),
    )
    table = np.zeros((BENT_SLOPES, BENDS, 3))
    for heading in _HEADINGS[:2]:
        met = partial(first_met, blades, straight, heading=heading, patch=patch, taper=taper, section=section)
        still = met(0.0 * heading, slopes=at_rest)
        for away, bend in enumerate(np.linspace(0.0, 1.0, BENDS // 2 + 1).tolist()):
            slopes, middle = at_rest * lodged(bend), BENDS // 2
            both = met(bend * heading, slopes=np.concatenate([slopes, -slopes]))
            for column, seen in ((middle + away, both[:BENT_SLOPES]), (middle - away, both[BENT_SLOPES:])):
                table[:, column, 0] += 0.5 * (seen[:, 0] - still[:, 0])
                table[:, column, 1:] += 0.5 * seen[:, 1:] / (still[:, 1:] * (1.0, lodged(bend)))
    table[:, BENDS // 2] *= 0.5  # the middle is met twice
    return table.astype(np.float32)


class _Field:
    """The triangles of a patch's blades, and how to draw the endless field that repeats them."""

    def __init__(
        self,
        seen_along: list[Doubles],
        normals: Doubles,
        tones: Doubles,
        width: float,
        patch: float,
        height: float,
        texels: int,
        eyed: Blades | None,
        /,
    ) -> None:
        self._eyed = eyed
        self._fine = int(np.clip(np.ceil(_SAMPLES_PER_WIDTH * patch / texels / width), 6, 64))
        self._seen_along, self._patch, self._height, self._texels = seen_along, patch, height, texels
        self._normals = np.repeat(normals.reshape(-1, 3), 2, axis=0)
        ends = tones[:, :, None]
        self._place = ribbon_triangles(ends, ends)[:, :, 0]

    def draw(self, heading: NDArray[np.float64], slope: float, /) -> Bytes:
        """Return one image, shape (texels, texels, 4): rows along z, columns along x."""
        rows, columns = self._texels * self._fine, self._columns(slope)
        turned = heading[0] == 0.0
        ribbons = self._seen_along[0 if turned else -1]
        ground = ribbons[:, :, ::2] + heading * ((ribbons[:, :, 1:2] - 0.5 * self._height) / slope)
        along, across = (1, 0) if turned else (0, 1)
        corners = np.stack([ground[:, :, along] * columns, ground[:, :, across] * rows], axis=2) / self._patch
        # Were all patches along a line of sight in line, it would meet the same blades in each, and the same gaps.
        shift = round(ASIDE * self._texels) * self._fine
        seen = rasterise(corners, ribbons[:, :, 1], shape=(rows, columns), wrap=True, shift=shift)
        where = seen.sample // (columns * self._fine) * columns + seen.sample % columns
        count = self._texels * columns
        meaning = self._meaning(corners, ribbons, seen, heading)
        if self._eyed is not None:
            toward = -float(heading[0]), slope, -float(heading[1])
            dye = eyed(self._eyed, ribbons, points=_SEGMENTS + 1, toward=toward)
            meaning[2] = interpolate(corners, dye, seen)
        sums = [np.bincount(where, values, count) for values in meaning]
        means = np.stack(sums).reshape(4, self._texels, columns) / self._fine
        image = _spread(means, self._texels)
        image = image.transpose(2, 1, 0) if turned else image.transpose(1, 2, 0)
        return np.ascontiguousarray(np.rint(image * 255.0).astype(np.uint8))

    def _columns(self, slope: float, /) -> int:
        """Return the samples along the view: fewer than texels where every blade is drawn out far."""
        drawn_out = slope * self._patch / self._height
        octaves = int(np.clip(np.round(np.log2(2.0 * drawn_out)), -2, 2))
        return max(int(self._texels * 2.0**octaves), 1)

    def _meaning(
        self, corners: Doubles, ribbons: Doubles, seen: Fragments, heading: NDArray[np.float64], /
    ) -> list[Doubles | None]:
        """Return place along the blade, height and doubled azimuth from the view, each (f,), and none for 1."""
        level = np.maximum(np.hypot(self._normals[:, 0], self._normals[:, 2]), 1e-6)
        twice = 2.0 * (self._normals[:, ::2] @ heading / level) ** 2 - 1.0
        place = interpolate(corners, self._place, seen)
        height = interpolate(corners, ribbons[:, :, 1], seen) / self._height
        return [place, np.clip(height, 0.0, 1.0), (0.5 + 0.5 * twice).take(seen.triangle), None]


def _spread(means: Doubles, texels: int, /) -> Doubles:
    """Return columns of samples (4, texels, columns) as texels: means of several, or each more than once."""
    columns = means.shape[2]
    if columns < texels:
        return means[:, :, np.arange(texels) * columns // texels]
    return np.asarray(means.reshape(4, texels, texels, columns // texels).mean(axis=3))


def first_met(
    blades: Blades,
    postures: Postures,
    message: Doubles,
    /,
    *,
    heading: Doubles,
    slopes: Doubles,
    patch: float,
    taper: float,
    section: Section = FLAT,
) -> Doubles:
    """Return what lines of sight meet of a field of blades that a message bends, shape (slopes, 3).

    Leaves hide one another by chance there (Monsi and Saeki, 1953). It is how many leaves each would meet on its way to
    the ground, and of those that stop it the mean place along the blade and the mean height [m]. They run along the
    unit vector `heading` (2,) over level ground and fall by each of `slopes` (slopes,) [m/m], or against it where that
    is below 0; `patch` is the side of the blades' patch [m].
    """
    side = (-float(heading[1]), 0.0, float(heading[0])) if section.is_round else None
    edges = ribbon(blades, postures, message, points=_POINTS, taper=taper, section=section, side=side)
    leaf = ribbon_triangles(*(edge.astype(np.float64) for edge in edges))
    ends = tone(blades, np.linspace(0.0, 1.0, _POINTS))[:, :, None]
    what = np.column_stack([ribbon_triangles(ends, ends)[:, :, 0].mean(axis=1), leaf[:, :, 1].mean(axis=1)])
    normal = 0.5 * np.cross(leaf[:, 1] - leaf[:, 0], leaf[:, 2] - leaf[:, 0])
    order = np.argsort(-what[:, 1])
    along, up = (normal[:, ::2] @ heading)[order], normal[order, 1]
    met = np.abs(along - slopes[:, None] * up) / (patch * patch * np.abs(slopes[:, None]))
    before = np.cumsum(met, axis=1) - 0.5 * met
    stopped = met * np.exp(-before)
    return np.column_stack([met.sum(axis=1), stopped @ what[order] / stopped.sum(axis=1, keepdims=True)])
