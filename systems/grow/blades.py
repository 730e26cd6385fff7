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
"""Its powers make the sequence of points that stays evenly spread on the torus at every length."""

_JITTER = 0.33
_LEAST_LEAN = 0.05

_TUFT = 8
"""Blades of a tuft, in the mean: tillers of one plant."""

_LOOSEST, _TIGHTEST = 0.05, 0.9
"""How far blades stand drawn to the middle of their tuft, of the way: at least, and at most at a clumping of 1."""

_FANNED = 0.8
"""How far azimuths at which blades lean out of their tuft are off [rad]."""

_WIDTH, _WIDTHS, _WIDEST = 0.95, 0.36, 2.0
"""Mean width of blades, of their kind's; how they differ, as the deviation of its logarithm; and by how much at most:
leaves of one sward differ by a factor of three."""

_OLD = 0.25
"""Share of grass leaves that hang over: a tiller has three or four live ones, and the oldest has grown too heavy."""

_OLD_LEANS, _MOST_OLD = (1.2, 3.0), 0.9
"""How far these hang at rest, of the largest index at which others lean, from the least to the most; how far at all."""

_ALONG_EDGE = 1e-6
"""Least part of its way that a leaf counts as going to the patch's edge."""

_SIDEWAYS = 0.35
"""How far azimuths that they face are off from those to which they hang [rad]: a leaf bends over its face."""

_TUSSOCK = 0.55
"""Width of a tussock [m]."""

_ALIKE = 0.8
"""How much alike blades of a tussock are at most."""

_DROOP, _MOST_DROOP, _SHRUNK = 0.3, 0.9, 0.85
"""How much farther dead blades lean as a posture index, how far at most; how long they are."""


def grow_blades(kind: GrassKind, /, *, count: int, patch: float, variants: int, seed: int) -> Blades:
    """Return the blades of one patch model, `patch` metres wide, from a seed.

    Rows stand in order of `rank`: the first k of them are spread over the patch as evenly as all of them, so
    that thinning out leaves no holes. Roots are even across the patch's edges too; heights and clumps vary
    slowly from place to place, so that neighbours are alike.
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
    """Return blades of a patch [m] of which the oldest hang over, to the side they lean to and with their face up.

    They are as long and as wide as before. Round stems, which have no leaves, and grass that never leans have none.
    """
    random, hanging = np.random.default_rng([seed, 0x68616E67]), hanging_of(variants)
    count = len(blades.height)
    old = (random.random(count) < _OLD) & (hanging > 0) & (kind.profile != "rush")
    least, most = np.minimum(np.multiply(_OLD_LEANS, kind.lean), _MOST_OLD)
    toward = np.arctan2(blades.rest[:, 1], blades.rest[:, 0]).astype(np.float64)
    facing = _within_a_turn(toward + random.normal(0.0, _SIDEWAYS, count))
    index = np.minimum(random.uniform(least, most, count), _inside_up_to(blades, toward, kind.lean, patch))
    rest = _leaning(index, toward)
    which = random.integers(variants - hanging, variants, count, dtype=np.int32) if hanging else blades.variant
    return replace(
        blades,
        rest=np.where(old[:, None], rest, blades.rest),
        facing=np.where(old, facing, blades.facing).astype(np.float32),
        variant=np.where(old, which, blades.variant),
    )


def _inside_up_to(blades: Blades, toward: Doubles, lean: float, patch: float, /) -> Doubles:
    """Return the posture indices up to which leaves (n,) that hang reach no farther over the patch's edge than others.

    Strips are as long as leaves reach. Where the tip of an evenly bent blade is flat, the line from its root to its tip
    lies about a radian from the vertical, and that of a leaf that hangs lies flat. Of the few blades next to the edge,
    none is the longest, leans most and straight outwards: they reach about half as far over it as that one would.
    """
    length = blades.height.astype(np.float64)
    way = np.stack([np.cos(toward), np.sin(toward)], axis=1)
    over = max(0.5 * (length.max(initial=0.0) * np.sin(lean) - blades.width.max(initial=0.0)), 0.0)
    left = np.where(way > 0.0, patch - blades.root, blades.root) + over
    farthest = (left / np.maximum(np.abs(way), _ALONG_EDGE)).min(axis=1)
    return np.asarray(np.arcsin(np.minimum(farthest / length, 1.0)) / NEAR_FLAT)


def _leaning(lean: Doubles, toward: Doubles, /) -> NDArray[np.float32]:
    """Return posture indices at rest (n,) towards azimuths (n,) as vectors."""
    return np.asarray(lean[:, None] * np.stack([np.cos(toward), np.sin(toward)], axis=1), np.float32)


def _within_a_turn(azimuth: Doubles, /) -> Doubles:
    """Return azimuths from -pi to pi."""
    return np.asarray((azimuth + np.pi) % (2.0 * np.pi) - np.pi)


def _widths(height: Doubles, random: np.random.Generator, /) -> Doubles:
    """Return widths of blades that are so high (n,), of their kind's: they have the leaf area of even ones."""
    width = np.exp(np.clip(random.normal(0.0, _WIDTHS, len(height)), -np.log(_WIDEST), np.log(_WIDEST)))
    return np.asarray(_WIDTH * width * (height.sum() / (width @ height)))


def wither(blades: Blades, part: float, /, *, seed: int) -> Blades:
    """Return blades of which this part, 0 to 1, has died: shorter, more bent at rest, and `WITHERED`."""
    random = np.random.default_rng([seed, 0x77697468])
    dead = random.random(len(blades.height)) < part
    length = np.maximum(np.linalg.norm(blades.rest, axis=1), 1e-6)
    bent = np.minimum(_DROOP + length, _MOST_DROOP) / length
    return replace(
        blades,
        organ=np.where(dead, WITHERED, BLADE).astype(np.int32),
        height=np.where(dead, _SHRUNK * blades.height, blades.height).astype(np.float32),
        rest=np.where(dead[:, None], bent[:, None] * blades.rest, blades.rest).astype(np.float32),
    )


def _spread(count: int, clumping: float, random: np.random.Generator, /) -> tuple[Doubles, Doubles]:
    """Return points on the unit torus, shape (count, 2), of which every first few are evenly spread, in tufts.

    Beside them the azimuth of each from the middle of its tuft, shape (count,).
    """
    powers = np.array([1.0 / _PLASTIC, 1.0 / _PLASTIC**2])
    place = np.arange(count)[:, None] * powers + random.random(2)
    place += _JITTER / np.sqrt(count) * random.normal(0.0, 1.0, (count, 2))
    place = place[:, ::-1] if random.random() < 0.5 else place
    centres = random.random((max(count // _TUFT, 1), 2))
    away = centres[None] - place[:, None]
    away -= np.round(away)
    nearest = np.argmin((away**2).sum(axis=2), axis=1)
    inward = away[np.arange(count), nearest]
    tight = _LOOSEST + (_TIGHTEST - _LOOSEST) * clumping * random.random(len(centres))[nearest]
    return np.asarray((place + tight[:, None] * inward) % 1.0), np.arctan2(-inward[:, 1], -inward[:, 0])


def _clumps(place: Doubles, random: np.random.Generator, /) -> Doubles:
    """Return a value in [-1, 1] that varies slowly over the unit torus, at each point."""
    waves = random.integers(-3, 4, (6, 2))
    phase = random.uniform(0.0, 2.0 * np.pi, 6)
    return np.asarray(np.clip(np.sin(2.0 * np.pi * place @ waves.T + phase).sum(axis=1) / 3.0, -1.0, 1.0))


@dataclass(frozen=True, slots=True, eq=False)
class _Tussocks:
    """What the tussocks that blades stand in are like, each (n,)."""

    height: Doubles
    """From 0 to 1."""

    away: Doubles
    """Azimuth of the way from the middle [rad]."""

    facing: Doubles
    """Azimuth that its blades face [rad]."""


def _tussocks(place: Doubles, patch: float, seed: int, /) -> _Tussocks:
    """Return the tussocks that blades at places on the unit torus stand in, about `_TUSSOCK` wide.

    They face all ways evenly, so that no patch as a whole has a tint of its own.
    """
    random = np.random.default_rng([seed, 0x74757373])
    count = max(round((patch / _TUSSOCK) ** 2), 1)
    centres = random.random((count, 2))
    apart = place[:, None] - centres[None]
    apart -= np.round(apart)
    nearest = np.argmin((apart**2).sum(axis=2), axis=1)
    own = apart[np.arange(len(place)), nearest]
    facing = random.permutation(count) * (np.pi / count) + random.uniform(0.0, np.pi)
    return _Tussocks(random.random(count)[nearest], np.arctan2(own[:, 1], own[:, 0]), facing[nearest])


def _inside(root: Doubles, patch: float, /) -> NDArray[np.float32]:
    """Return roots as float32 that stay in [0, patch) after rounding."""
    below = np.nextafter(np.float32(patch), np.float32(0.0))
    return np.clip(root.astype(np.float32), np.float32(0.0), below)
