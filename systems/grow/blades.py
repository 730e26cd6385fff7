"""The blades of a patch: a few hundred, at random but evenly spread (paper, section 2.2)."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.declared.grass import GrassKind
from .organs import BLADE, WITHERED
from .record import Blades

_PLASTIC = 1.32471795724474602596
"""Its powers make the sequence of points that stays evenly spread on the torus at every length."""

_JITTER = 0.33
_CLUMPING = 0.14
_LEAST_LEAN = 0.05

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
    place = _spread(count, random)
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
        toward, facing = tussock.away + (1.0 - alike) * toward, tussock.facing + (1.0 - alike) * facing
    rest = lean[:, None] * np.stack([np.cos(toward), np.sin(toward)], axis=1)
    return Blades(
        root=_inside(place * patch, patch),
        height=np.clip(low + (high - low) * blend, low, high).astype(np.float32),
        width=(kind.width * random.uniform(0.75, 1.15, count)).astype(np.float32),
        facing=((facing + np.pi) % (2.0 * np.pi) - np.pi).astype(np.float32),
        rest=rest.astype(np.float32),
        variant=random.integers(0, variants, count, dtype=np.int32),
        rank=(np.arange(count) / count).astype(np.float32),
    )


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


def _spread(count: int, random: np.random.Generator, /) -> Doubles:
    """Return points on the unit torus, shape (count, 2), of which every first few are evenly spread."""
    powers = np.array([1.0 / _PLASTIC, 1.0 / _PLASTIC**2])
    place = np.arange(count)[:, None] * powers + random.random(2)
    place += _JITTER / np.sqrt(count) * random.normal(0.0, 1.0, (count, 2))
    place = place[:, ::-1] if random.random() < 0.5 else place
    place = _draw_together(place, count, random)
    return np.asarray(place % 1.0)


def _draw_together(place: Doubles, count: int, random: np.random.Generator, /) -> Doubles:
    """Return the points moved a little towards clump centres, each about eight blades strong."""
    centres = random.random((max(count // 8, 1), 2))
    away = centres[None] - place[:, None]
    away -= np.round(away)
    nearest = np.argmin((away**2).sum(axis=2), axis=1)
    return np.asarray(place + _CLUMPING * away[np.arange(count), nearest])


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
