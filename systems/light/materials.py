"""Optical properties of a kind of grass: pigments, transmittance of leaves, leaf area."""

from dataclasses import dataclass
from math import cos, hypot, sin

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.grass import GrassKind
from ..grow.bend import across, spine, tone, widths
from ..grow.organs import LEAF, TONES
from ..grow.record import Growth
from ..grow.section import SECTIONS
from .color import linear, luminance
from .daylight import Daylight

LEAF_TRANSMISSION = np.array([1.05, 1.18, 0.55])
"""Light transmitted by a leaf relative to reflected light: yellower and greener."""

PETAL_TRANSMISSION = np.array([1.05, 1.05, 0.9])
"""Light transmitted by a petal relative to reflected light: nearly the petal's own colour."""

FACING_SUN = 0.22
"""Extra sunlight on blades that face the sun, relative to those edge on."""

SIDE_CONTRAST = 0.45
"""Extra brightness of the sunlit side of a round stem, or face of a fold, relative to the mean of both sides."""

FULL_UNDERSTOREY = 0.25
"""Height of a canopy from which the understorey has its full cover [m]."""

LOW_LEAF_TONE = 0.6
"""Part of the `tip` colour in low leaves of grass."""

_POINTS = 9
"""Points along a blade's spine."""


@dataclass(frozen=True, slots=True, eq=False)
class Leaves:
    """Projected leaf area of a kind's canopy at full density, per area of ground."""

    side: float
    """Area projected horizontally, averaged over all azimuths."""

    above: float
    """Area projected vertically."""


def pigment(color: str, /) -> Doubles:
    """Return the square root of a colour's albedo, shape (3,), in which colours interpolate evenly."""
    return np.sqrt(linear(color))


def transmission(kind: GrassKind, /) -> Doubles:
    """Return the light transmitted by a kind's leaves, relative to the light they reflect, shape (3,)."""
    return np.asarray(kind.translucency * (LEAF_TRANSMISSION if kind.head is None else PETAL_TRANSMISSION))


def bloom(kind: GrassKind, growth: Growth, /) -> float:
    """Return the share of the `tip` colour that a kind shows at rest, relative to grass, which has 1; in [0, 1]."""
    blades = growth.models[0].blades
    if not blades.organ.any():
        return 1.0
    along = (np.arange(_POINTS - 1) + 0.5) / (_POINTS - 1)
    area = widths(blades, along, kind.taper, SECTIONS[kind.profile]) * blades.height[:, None]
    return min(2.0 * float(np.average(tone(blades, along), weights=area)), 1.0)


def leaves_of(kind: GrassKind, growth: Growth, patch: float, /) -> Leaves:
    """Return the projected leaf area of a kind's first model at rest; `patch` is a patch's side [m]."""
    blades = growth.models[0].blades
    centre = spine(blades, growth.postures, (0.0, 0.0), points=_POINTS).astype(np.float64)
    along = (np.arange(_POINTS - 1) + 0.5) / (_POINTS - 1)
    width, ground = widths(blades, along, kind.taper, SECTIONS[kind.profile]).astype(np.float64), patch * patch
    if SECTIONS[kind.profile].is_round:
        x, y, z = np.moveaxis(np.diff(centre, axis=1), -1, 0)
        side = np.sqrt(y * y + 0.5 * (x * x + z * z))
        return Leaves(float((side * width).sum()) / ground, float((np.hypot(x, z) * width).sum()) / ground)
    normal = np.cross(np.diff(centre, axis=1), across(blades)[:, None]) * width[..., None]
    level = np.hypot(normal[..., 0], normal[..., 2])
    return Leaves(float(level.sum() * 2.0 / np.pi) / ground, float(np.abs(normal[..., 1]).sum()) / ground)


def understorey(kind: GrassKind, canopy: float, /) -> float:
    """Return the ground coverage of low leaves under a canopy of some height [m], relative to the largest.

    It shrinks with the height of low canopies, above which the leaves would stand.
    """
    return kind.understorey * min(canopy / FULL_UNDERSTOREY, 1.0)


def undertone(kind: GrassKind, bloom: float, /) -> float:
    """Return the tone of a kind's low leaves, from 0 for `root` to 1 for `tip`; `bloom` is what `bloom()` returns.

    Beneath a plant with flowers it is the tone of the plant's leaves, because the `tip` colour is the petals'.
    """
    if kind.plant != "grass" and kind.head is not None:
        return float(TONES[LEAF].mean())
    return LOW_LEAF_TONE * bloom * bloom


def sun_fraction(light: Daylight, /) -> float:
    """Return the sun's fraction of the light on a leaf, 0 to 1."""
    sun, down = float(luminance(light.sun)), float(luminance(light.down))
    return sun / max(sun + down, 1e-9)


def side_contrast(kind: GrassKind, light: Daylight, /) -> float:
    """Return the largest contrast between the two sides of a blade's face: their difference over their sum.

    The sides are the two faces of a fold, or the sunlit and the shaded half of a round stem. A flat blade has 0.
    """
    section = SECTIONS[kind.profile]
    if section.is_round:
        return SIDE_CONTRAST * sun_fraction(light) * hypot(light.direction[0], light.direction[2])
    return SIDE_CONTRAST * sun_fraction(light) * sin(2.0 * section.folded)


def grain(kind: GrassKind, light: Daylight, /) -> tuple[Doubles, Doubles]:
    """Return the relative change of a blade's pigment with cosine and sine of twice its azimuth, each of shape (3,).

    One cause is the sun: it lights blades that face it, or face away, more than those edge on. The other is the kind's
    variety: blades of one azimuth are greener, of another paler. Both are linear in the cosine and sine, so that an
    average over many blades is exact.
    """
    x, _, z = light.direction
    section = SECTIONS[kind.profile]
    shine = 0.0 if section.is_round else FACING_SUN * sun_fraction(light) * cos(2.0 * section.folded)
    warm, pale = np.array([1.0, 0.2, -0.6]), np.array([0.9, 1.0, 0.8])
    variety = 0.6 * kind.variety
    return shine * (x * x - z * z) + variety * pale, shine * 2.0 * x * z + variety * warm
