"""What a kind of grass does to light: its pigments, what its leaves let through, and how many there are."""

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

LEAVES_THROUGH = np.array([1.05, 1.18, 0.55])
"""Light that a leaf lets through, as a part of what it sends back: more yellow and green."""

PETALS_THROUGH = np.array([1.05, 1.05, 0.9])
"""The same of a plant in flower: petals let through the colour that they have."""

FACES = 0.22
"""How much more the sun lights blades that face it than those edge on."""

SIDES = 0.45
"""How much brighter the sunlit side of a round stem, or face of a fold, is than the mean of both sides."""

ROOM = 0.25
"""Height of a canopy that all its understorey has room under [m]."""

LOW_TIPPED = 0.6
"""How much of the colour of tips low leaves of grass have."""

_POINTS = 9


@dataclass(frozen=True, slots=True, eq=False)
class Leaves:
    """How much leaf there is in a kind's canopy at full density, of the ground's area."""

    side: float
    """Area seen from the side, on the mean over all sides."""

    above: float
    """Area seen from above."""


def pigment(color: str, /) -> Doubles:
    """Return the square root of a colour's albedo, shape (3,): what lies between two of them looks as if it did."""
    return np.sqrt(linear(color))


def let_through(kind: GrassKind, /) -> Doubles:
    """Return the light that a kind's leaves let through, as a part of what they send back, shape (3,)."""
    return np.asarray(kind.translucency * (LEAVES_THROUGH if kind.head is None else PETALS_THROUGH))


def bloom(kind: GrassKind, growth: Growth, /) -> float:
    """Return how much of its `tip` colour a kind shows at rest, relative to grass, in [0, 1]; grass itself has 1."""
    blades = growth.models[0].blades
    if not blades.organ.any():
        return 1.0
    along = (np.arange(_POINTS - 1) + 0.5) / (_POINTS - 1)
    area = widths(blades, along, kind.taper, SECTIONS[kind.profile]) * blades.height[:, None]
    return min(2.0 * float(np.average(tone(blades, along), weights=area)), 1.0)


def leaves_of(kind: GrassKind, growth: Growth, patch: float, /) -> Leaves:
    """Return how much leaf a kind's canopy has at rest, by its first model; `patch` is a patch's side [m]."""
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
    """Return how much of the ground the low leaves under a canopy of some height [m] cover, as a part of the most.

    Under low grass there are as much fewer: they would stand above it.
    """
    return kind.understorey * min(canopy / ROOM, 1.0)


def undertone(kind: GrassKind, bloom: float, /) -> float:
    """Return how much of a kind's colour `tip` its low leaves have, 0 to 1; `bloom` says how much of it the kind shows.

    What is low beneath a plant in flower is of the colour of its leaves: the tip's is that of the petals.
    """
    if kind.plant != "grass" and kind.head is not None:
        return float(TONES[LEAF].mean())
    return LOW_TIPPED * bloom * bloom


def sunny(light: Daylight, /) -> float:
    """Return how much of the light is the sun's, 0 to 1."""
    sun, down = float(luminance(light.sun)), float(luminance(light.down))
    return sun / max(sun + down, 1e-9)


def apart(kind: GrassKind, light: Daylight, /) -> float:
    """Return how far the two sides of a blade's face are lit apart where they are so most, of the light on both.

    Of a fold, the sides are its two faces; of a round one, those to the sun and away from it; of a flat one it is 0.
    """
    section = SECTIONS[kind.profile]
    if section.is_round:
        return SIDES * sunny(light) * hypot(light.direction[0], light.direction[2])
    return SIDES * sunny(light) * sin(2.0 * section.folded)


def grain(kind: GrassKind, light: Daylight, /) -> tuple[Doubles, Doubles]:
    """Return how a blade's pigment seems to change with the cosine and sine of twice its azimuth, each of shape (3,).

    One part is the sun: blades that face it, or turn their backs on it, are lit more than those edge on. The other is
    the kind's variety: blades that face one way are greener, another way paler. Both are linear in what is kept of a
    blade, so that the mean of many has exactly the light of their mean.
    """
    x, _, z = light.direction
    section = SECTIONS[kind.profile]
    shine = 0.0 if section.is_round else FACES * sunny(light) * cos(2.0 * section.folded)
    warm, pale = np.array([1.0, 0.2, -0.6]), np.array([0.9, 1.0, 0.8])
    variety = 0.6 * kind.variety
    return shine * (x * x - z * z) + variety * pale, shine * 2.0 * x * z + variety * warm
