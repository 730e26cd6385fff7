"""The blades of a patch: a few hundred, at random but evenly spread (paper, section 2.2)."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.declared.grass import GrassKind
from .organs import BLADE, WITHERED
from .postures import NEAR_FLAT, hanging_of
from .record import Blades

_PLASTIC = 1.32471795724474602596
"""Base of the sequence of points that is evenly spread on the torus at every length: they step by its powers."""

_JITTER = 0.33
_LEAST_LEAN = 0.05

_TUFT = 8
"""Mean number of blades of a tuft: tillers of one plant."""

_LOOSEST, _TIGHTEST = 0.05, 0.9
"""Fraction of the way that blades are drawn to the middle of their tuft: least, and largest at a clumping of 1."""

_FANNED = 0.8
"""Standard deviation of the azimuths at which blades lean out of their tuft [rad]."""

_WIDTH, _WIDTHS, _WIDEST = 0.95, 0.36, 2.0
"""Mean width of blades, relative to their kind's; standard deviation of its logarithm; and largest factor: leaves of
one sward differ by a factor of three."""

_OLD = 0.25
"""Fraction of leaves that hang over: a tiller has three or four live ones, and the oldest has grown too heavy."""

_OLD_LEANS, _MOST_OLD = (1.2, 3.0), 0.9
"""Posture index of hanging leaves at rest, relative to the largest of other leaves: least and largest; upper bound."""

_ALONG_EDGE = 1e-6
"""Least component of a leaf's direction towards an edge of the patch: it guards a division."""

_SIDEWAYS = 0.35
"""Standard deviation of the azimuths that hanging leaves face from those to which they hang [rad]: a leaf bends over
its face."""

_TUSSOCK = 0.55
"""Width of a tussock [m]."""

_ALIKE = 0.8
"""Largest likeness of the blades of a tussock, at a clumping of 1."""

_DROOP, _MOST_DROOP, _SHRUNK = 0.3, 0.9, 0.85
"""Posture index added to the lean of dead blades, and its bound; their length, relative to live ones."""


def grow_blades(kind: GrassKind, /, *, count: int, patch: float, variants: int, seed: int) -> Blades:
    """Return the blades of one patch model, `patch` metres wide, from a seed.

    Rows are ordered by `rank`: the first k are spread over the patch as evenly as all, so that thinning out
    leaves no holes. Roots are even across the patch's edges too; heights and clumps vary slowly from place to
    place, so that neighbours are alike.
    """
    random = np.random.default_rng([seed, 0x626C6164])
    place, outward = _spread(count, kind.clumping, random)
    clump = _clumps(place, random)
    low, high = kind.height
    blend = np.clip(0.75 * random.random(count) + 0.25 * (0.5 + 0.5 * clump), 0.0, 1.0)
    lean = random.uniform(min(_LEAST_LEAN, kind.lean), kind.lean, count)
    toward = random.uniform(-np.pi, np.pi, count)
    facing = random.uniform(-np.pi, np.pi, count)
    if kind.clumping:
        tussock = _tussocks(place, patch, seed)
        alike = kind.clumping * _ALIKE
        blend = (1.0 - 0.6 * alike) * blend + 0.6 * alike * tussock.height
        fanned = _within_a_turn(outward + random.normal(0.0, _FANNED, count) - tussock.away)
        toward, facing = tussock.away + (1.0 - alike) * fanned, tussock.facing + (1.0 - alike) * facing
    height = np.clip(low + (high - low) * blend, low, high)
    return Blades(
        root=_inside(place * patch, patch),
        height=height.astype(np.float32),
        width=(kind.width * _widths(height, random)).astype(np.float32),
        facing=_within_a_turn(facing).astype(np.float32),
        rest=_leaning(lean, toward),
        variant=random.integers(0, variants - hanging_of(variants), count, dtype=np.int32),
        rank=(np.arange(count) / count).astype(np.float32),
    )


def let_hang(blades: Blades, kind: GrassKind, /, *, patch: float, variants: int, seed: int) -> Blades:
    """Return the blades of a patch [m] with the oldest leaves hanging to the side to which they lean, face up.

    Lengths and widths stay. Round stems have no leaves to hang, and grass that never leans has none that do.
    """
    random, hanging = np.random.default_rng([seed, 0x68616E67]), hanging_of(variants)
    count = len(blades.height)
    old = (random.random(count) < _OLD) & (hanging > 0) & (kind.profile != "rush")
    least, most = np.minimum(np.multiply(_OLD_LEANS, kind.lean), _MOST_OLD)
    toward = np.arctan2(blades.rest[:, 1], blades.rest[:, 0]).astype(np.float64)
    facing = _within_a_turn(toward + random.normal(0.0, _SIDEWAYS, count))
    index = np.minimum(random.uniform(least, most, count), _largest_inside(blades, toward, kind.lean, patch))
    rest = _leaning(index, toward)
    variant = random.integers(variants - hanging, variants, count, dtype=np.int32) if hanging else blades.variant
    return replace(
        blades,
        rest=np.where(old[:, None], rest, blades.rest),
        facing=np.where(old, facing, blades.facing).astype(np.float32),
        variant=np.where(old, variant, blades.variant),
    )


def _largest_inside(blades: Blades, toward: Doubles, lean: float, patch: float, /) -> Doubles:
    """Return the posture indices up to which hanging leaves (n,) lean over the patch's edge no farther than others do.

    Strips are as long as leaves reach. At index 1 the line from root to tip is about a radian from the vertical for an
    evenly bent blade, but flat for a hanging leaf. None of the few blades next to the edge is the longest, leans most
    and straight outwards: they reach about half as far over it as such a blade would.
    """
    length = blades.height.astype(np.float64)
    direction = np.stack([np.cos(toward), np.sin(toward)], axis=1)
    over = max(0.5 * (length.max(initial=0.0) * np.sin(lean) - blades.width.max(initial=0.0)), 0.0)
    room = np.where(direction > 0.0, patch - blades.root, blades.root) + over
    farthest = (room / np.maximum(np.abs(direction), _ALONG_EDGE)).min(axis=1)
    return np.asarray(np.arcsin(np.minimum(farthest / length, 1.0)) / NEAR_FLAT)


def _leaning(lean: Doubles, toward: Doubles, /) -> NDArray[np.float32]:
    """Return the leans of posture indices (n,) towards azimuths (n,) as vectors, shape (n, 2)."""
    return np.asarray(lean[:, None] * np.stack([np.cos(toward), np.sin(toward)], axis=1), np.float32)


def _within_a_turn(azimuth: Doubles, /) -> Doubles:
    """Return azimuths wrapped to [-pi, pi)."""
    return np.asarray((azimuth + np.pi) % (2.0 * np.pi) - np.pi)


def _widths(height: Doubles, random: np.random.Generator, /) -> Doubles:
    """Return random relative widths of blades of these heights (n,); their total area is that of equal widths."""
    width = np.exp(np.clip(random.normal(0.0, _WIDTHS, len(height)), -np.log(_WIDEST), np.log(_WIDEST)))
    return np.asarray(_WIDTH * width * (height.sum() / (width @ height)))


def wither(blades: Blades, fraction: float, /, *, seed: int) -> Blades:
    """Return the blades with a random `fraction`, 0 to 1, dead: shorter, more bent at rest, and `WITHERED`."""
    random = np.random.default_rng([seed, 0x77697468])
    dead = random.random(len(blades.height)) < fraction
    length = np.maximum(np.linalg.norm(blades.rest, axis=1), 1e-6)
    bent = np.minimum(_DROOP + length, _MOST_DROOP) / length
    return replace(
        blades,
        organ=np.where(dead, WITHERED, BLADE).astype(np.int32),
        height=np.where(dead, _SHRUNK * blades.height, blades.height).astype(np.float32),
        rest=np.where(dead[:, None], bent[:, None] * blades.rest, blades.rest).astype(np.float32),
    )


def _spread(count: int, clumping: float, random: np.random.Generator, /) -> tuple[Doubles, Doubles]:
    """Return points in tufts on the unit torus, (count, 2), and azimuths from the middles of their tufts, (count,).

    Any number of first points is evenly spread.
    """
    powers = np.array([1.0 / _PLASTIC, 1.0 / _PLASTIC**2])
    place = np.arange(count)[:, None] * powers + random.random(2)
    place += _JITTER / np.sqrt(count) * random.normal(0.0, 1.0, (count, 2))
    place = place[:, ::-1] if random.random() < 0.5 else place
    centres = random.random((max(count // _TUFT, 1), 2))
    offset = centres[None] - place[:, None]
    offset -= np.round(offset)
    nearest = np.argmin((offset**2).sum(axis=2), axis=1)
    inward = offset[np.arange(count), nearest]
    tight = _LOOSEST + (_TIGHTEST - _LOOSEST) * clumping * random.random(len(centres))[nearest]
    return np.asarray((place + tight[:, None] * inward) % 1.0), np.arctan2(-inward[:, 1], -inward[:, 0])


def _clumps(place: Doubles, random: np.random.Generator, /) -> Doubles:
    """Return a value in [-1, 1] at each point that varies slowly over the unit torus."""
    waves = random.integers(-3, 4, (6, 2))
    phase = random.uniform(0.0, 2.0 * np.pi, 6)
    return np.asarray(np.clip(np.sin(2.0 * np.pi * place @ waves.T + phase).sum(axis=1) / 3.0, -1.0, 1.0))


@dataclass(frozen=True, slots=True, eq=False)
class _Tussocks:
    """The tussock of each blade, shape (n,) each."""

    height: Doubles
    """Relative height of its blades, from 0 to 1."""

    away: Doubles
    """Azimuth of the blade from the middle of the tussock [rad]."""

    facing: Doubles
    """Azimuth that its blades face [rad]."""


def _tussocks(place: Doubles, patch: float, seed: int, /) -> _Tussocks:
    """Return the tussocks of blades at places on the unit torus (n, 2), each about `_TUSSOCK` wide.

    They face all ways evenly, so that no patch as a whole has a tint of its own.
    """
    random = np.random.default_rng([seed, 0x74757373])
    count = max(round((patch / _TUSSOCK) ** 2), 1)
    centres = random.random((count, 2))
    offset = place[:, None] - centres[None]
    offset -= np.round(offset)
    nearest = np.argmin((offset**2).sum(axis=2), axis=1)
    outward = offset[np.arange(len(place)), nearest]
    facing = random.permutation(count) * (np.pi / count) + random.uniform(0.0, np.pi)
    return _Tussocks(random.random(count)[nearest], np.arctan2(outward[:, 1], outward[:, 0]), facing[nearest])


def _inside(root: Doubles, patch: float, /) -> NDArray[np.float32]:
    """Return roots as float32, still in [0, patch) after rounding."""
    below = np.nextafter(np.float32(patch), np.float32(0.0))
    return np.clip(root.astype(np.float32), np.float32(0.0), below)
