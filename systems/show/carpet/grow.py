"""The carpet: images of an endless field of a patch model from several viewing angles (paper, section 2.2)."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Doubles, Floats
from ...grow.bend import highest_tip, ribbon, segment_normals, sides_of, spine, tone
from ...grow.dye import eyed
from ...grow.organs import has_eyes
from ...grow.raster import Fragments, along_ribbons, interpolate, rasterise, ribbon_triangles
from ...grow.record import LENGTHS, Blades, PatchModel, Postures
from ...grow.section import FLAT, Section
from ...space.canopy import lodged

_POINTS = 9
"""Points along each edge of a blade in `first_met`."""


@dataclass(frozen=True, slots=True, eq=False)
class Carpet:
    """Images of an endless field of one patch model from several viewing angles (paper, section 2.2).

    An image holds, for each point of the plane at mid-height, the first hit of a ray through it.
    """

    slope: Floats
    """Tangent of the viewing elevation of each row of images, ascending, shape (slopes,)."""

    texels: Bytes
    """Texels, premultiplied by coverage, shape (slopes, 4, r, r, 4). The channels are the tone, which of a grass blade
    is the place along it; the height as a fraction of `height`; 0.5 + 0.5 c, where c is the cosine of twice the face
    normal's azimuth from the view; coverage. For kinds whose heads have eyes, the third is the share of the eye's
    colour instead. The four viewing directions are -z, +x, +z, -x in this order; rows go along z, columns along x."""

    height: float
    """Height of the canopy [m]."""

    bent: Floats
    """Changes of what lines of sight meet in a bent field, relative to the field at rest, shape (`BENT_SLOPES`,
    `BENDS`, 4): number of leaves met more; factors of the mean place along blades and of the mean height in the canopy
    of the leaves that stop them. Rows are slopes, columns posture indices from -1, towards the eye, to 1, away from
    it. The fourth number tells how grass that bends aside differs from the mean of both ways: in columns of positive
    indices by leaves met more, in those of negative ones by the relative increase of place and height."""


SLOPES = (0.02, 0.07, 0.25, 0.9, 3.2)
"""Tangents of the viewing elevations, a geometric series: each is about 3.5 times the one before."""

BENT_SLOPES, BENDS = 12, 9
"""Numbers of slopes of lines of sight and of posture indices in `Carpet.bent`."""

FLATTEST = 0.005
"""Least slope in tables [m/m]: flatter lines of sight meet tips alone."""

STEEPEST = 20.0
"""Greatest slope in `Carpet.bent` [m/m]: steeper lines of sight count as vertical."""

GLSL = {"SLOPES": len(SLOPES), "HEADINGS": 4, "LOWEST": SLOPES[0], "STEEPEST": STEEPEST, "FLATTEST": FLATTEST}

_SEGMENTS = 8
"""Segments along a blade in images."""

_SAMPLES_PER_WIDTH = 5.0
"""Samples across a blade of mean width."""

ASIDE = 0.618
"""Sideways offset of each next patch of the endless field along the view, in patches, rounded to a texel: so few
patches stand in line."""

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

    A ray that travels along a heading h and falls by `slope` [m/m] meets a point at (x, z) and height y if it crosses
    the plane at mid-height o at (x, z) + h (y - o) / slope; of all such points it meets the highest first. Blades reach
    over the patch's edge into the next patch, a copy: across the view in line, along the view `ASIDE` aside. `height`
    is the canopy's [m]; without it, the highest tip's.
    """
    draw = partial(ribbon, blades, postures, (0.0, 0.0), points=_SEGMENTS + 1, taper=taper, section=section)
    seen_along = [ribbon_triangles(*draw(side=side)) for side in sides_of(section)]
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

    Bent grass is lower: a line of sight meets as much leaf as a steeper one meets in grass at rest. Rows are the slopes
    at rest.
    """
    at_rest = np.geomspace(FLATTEST, STEEPEST, BENT_SLOPES)
    linear = replace(postures, give=LENGTHS.astype(np.float32))  # messages are posture indices
    table = np.zeros((BENT_SLOPES, BENDS, 4))
    for heading in _HEADINGS[:2]:
        met = partial(first_met, blades, linear, heading=heading, patch=patch, taper=taper, section=section)
        still = met(0.0 * heading, slopes=at_rest)
        for away, bend in enumerate(np.linspace(0.0, 1.0, BENDS // 2 + 1).tolist()):
            slopes, middle = at_rest * lodged(bend), BENDS // 2
            both = met(bend * heading, slopes=np.concatenate([slopes, -slopes]))
            from_eye, to_eye = both[:BENT_SLOPES], both[BENT_SLOPES:]
            for column, bent in ((middle + away, from_eye), (middle - away, to_eye)):
                table[:, column, 0] += 0.5 * (bent[:, 0] - still[:, 0])
                table[:, column, 1:3] += 0.5 * bent[:, 1:] / (still[:, 1:] * (1.0, lodged(bend)))
            aside, mean = met(bend * heading[::-1], slopes=slopes), 0.5 * (from_eye + to_eye)
            if away:
                table[:, middle + away, 3] += 0.5 * (aside[:, 0] - mean[:, 0])
                table[:, middle - away, 3] += 0.5 * (aside[:, 1] / mean[:, 1] - 1.0)
    table[:, BENDS // 2] *= 0.5  # the middle was added twice
    return table.astype(np.float32)


class _Field:
    """Renders the endless field that repeats a patch's blades."""

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
        self._place = along_ribbons(tones)

    def draw(self, heading: NDArray[np.float64], slope: float, /) -> Bytes:
        """Return the image for a heading (2,) and a slope, (texels, texels, 4): rows along z, columns along x."""
        rows, columns = self._texels * self._fine, self._columns(slope)
        turned = heading[0] == 0.0
        ribbons = self._seen_along[0 if turned else -1]
        ground = ribbons[:, :, ::2] + heading * ((ribbons[:, :, 1:2] - 0.5 * self._height) / slope)
        along, across = (1, 0) if turned else (0, 1)
        corners = np.stack([ground[:, :, along] * columns, ground[:, :, across] * rows], axis=2) / self._patch
        # Were all patches along a line of sight in line, it would meet the same blades in each, and the same gaps.
        shift = round(ASIDE * self._texels) * self._fine
        seen = rasterise(corners, ribbons[:, :, 1], shape=(rows, columns), wrap=True, shift=shift)
        texel = seen.sample // (columns * self._fine) * columns + seen.sample % columns
        count = self._texels * columns
        channels = self._channels(corners, ribbons, seen, heading)
        if self._eyed is not None:
            toward = -float(heading[0]), slope, -float(heading[1])
            dye = eyed(self._eyed, ribbons, points=_SEGMENTS + 1, toward=toward)
            channels[2] = interpolate(corners, dye, seen)
        sums = [np.bincount(texel, values, count) for values in channels]
        means = np.stack(sums).reshape(4, self._texels, columns) / self._fine
        image = _resampled(means, self._texels)
        image = image.transpose(2, 1, 0) if turned else image.transpose(1, 2, 0)
        return np.ascontiguousarray(np.rint(image * 255.0).astype(np.uint8))

    def _columns(self, slope: float, /) -> int:
        """Return the number of samples along the view: fewer than texels where blades are stretched far along it."""
        stretch = slope * self._patch / self._height
        octaves = int(np.clip(np.round(np.log2(2.0 * stretch)), -2, 2))
        return max(int(self._texels * 2.0**octaves), 1)

    def _channels(
        self, corners: Doubles, ribbons: Doubles, seen: Fragments, heading: NDArray[np.float64], /
    ) -> list[Doubles | None]:
        """Return the channels of `Carpet.texels` at fragments, each (f,); None stands for a coverage of 1."""
        level = np.maximum(np.hypot(self._normals[:, 0], self._normals[:, 2]), 1e-6)
        cos_double = 2.0 * (self._normals[:, ::2] @ heading / level) ** 2 - 1.0
        place = interpolate(corners, self._place, seen)
        height = interpolate(corners, ribbons[:, :, 1], seen) / self._height
        return [place, np.clip(height, 0.0, 1.0), (0.5 + 0.5 * cos_double).take(seen.triangle), None]


def _resampled(means: Doubles, texels: int, /) -> Doubles:
    """Resample columns of samples (4, texels, columns) to texels, (4, texels, texels): averaged or repeated."""
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
    section: Section,
) -> Doubles:
    """Return what lines of sight meet in a field of blades that a message bends, shape (slopes, 3).

    The columns are the optical depth down to the ground, in leaves, and the mean place along the blade and mean height
    [m] of the leaves that stop the line of sight; leaves overlap at random (Monsi and Saeki, 1953). Lines of sight run
    over level ground along the unit vector `heading` (2,), or against it if their slope is negative, and fall by
    `slopes` (slopes,) [m/m]. `patch` is the side of the blades' patch [m].
    """
    side = (-float(heading[1]), 0.0, float(heading[0])) if section.is_round else None
    leaf = ribbon_triangles(*ribbon(blades, postures, message, points=_POINTS, taper=taper, section=section, side=side))
    place = along_ribbons(tone(blades, np.linspace(0.0, 1.0, _POINTS)))
    place_height = np.column_stack([place.mean(axis=1), leaf[:, :, 1].mean(axis=1)])
    normal = 0.5 * np.cross(leaf[:, 1] - leaf[:, 0], leaf[:, 2] - leaf[:, 0])
    order = np.argsort(-place_height[:, 1])
    along, up = (normal[:, ::2] @ heading)[order], normal[order, 1]
    met = np.abs(along - slopes[:, None] * up) / (patch * patch * np.abs(slopes[:, None]))
    before = np.cumsum(met, axis=1) - 0.5 * met
    stopped = met * np.exp(-before)
    return np.column_stack([met.sum(axis=1), stopped @ place_height[order] / stopped.sum(axis=1, keepdims=True)])
