"""Postures and give of a kind of grass, taken from the simulation of its blades (paper, section 3.2)."""

import numpy as np

from ...components.arrays import Doubles, Floats
from ...engine.declared.grass import GrassKind
from .record import GIVES, Postures
from .simulate import LINKS, Chain, build_chain, damp, lowest_swing, place_links, sag, settle, simulate

NEAR_FLAT = np.radians(83.0)
"""Angle of the tip from the vertical at posture index 1 [rad]."""

_CALM, _STORM = 0.02, 400.0
"""Least and largest squared speed of winds, in units of a blade's stiffness over its drag."""

HANGING = 2
"""Number of variants that are hanging leaves, the last ones: one arches, one is folded over."""

_LIGHTEST, _HEAVIEST, _WEIGHTS = 0.02, 8.0, 60
"""Weight of a sagging leaf, relative to what it carries: least, largest, and number of steps."""

_FOLDED_AT, _FOLD_STIFFNESS = 8, 0.12
"""Joint at which a leaf is folded over, and its stiffness relative to an unbroken one."""

_GOLDEN = 0.618
_RESTS = 200
_STEPS, _LONGEST_STEP, _ANGLE_STEP = 1200, 0.1, 0.15
_HEAVY_DAMPING = 0.7


def grow_postures(kind: GrassKind, /, *, variants: int = 4, rows: int = 129, seed: int = 0) -> Postures:
    """Return the shapes of a kind's blades by posture index (paper, section 3.2).

    A wind that grows slowly from nothing bends simulated blades until their tips are near flat: index 1. The
    index is the angle of the line from root to tip, as a fraction of the angle then; 0 is upright, and a negative
    index is the mirror image. Variant 0 has even links; in the others the springs, and so each segment's
    orientation, are random (section 2.2). The last `hanging_of` variants are leaves that sag under their own weight,
    until the line from root to tip is near flat at index 1. Raises ValueError unless `rows` is odd and at least 3.
    """
    if rows < 3 or rows % 2 == 0:
        raise ValueError(f"postures need an odd number of rows, at least 3, not {rows}")
    hanging = hanging_of(variants)
    half = rows // 2
    level = np.linspace(0.0, 1.0, half + 1)
    bent = np.moveaxis(_bend_slowly(build_chain(kind, _random_factors(variants - hanging, seed))), 1, 0)
    sagged = np.moveaxis(_hang(kind), 1, 0)[:hanging]
    rising = np.stack(
        [_resample(angle[: flat_step(angle) + 1], level) for angle in bent]
        + [_resample(angle[: int(np.argmax(chord_angle(angle) >= NEAR_FLAT)) + 1], level) for angle in sagged]
    )
    both = np.concatenate([-rising[:, :0:-1], rising], axis=1)
    index = np.concatenate([-level[:0:-1], level])
    return Postures(index=index.astype(np.float32), shape=place_links(both).astype(np.float32))


def hanging_of(variants: int, /) -> int:
    """Return the number of hanging leaves among `variants`: at least two of these stand."""
    return min(HANGING, max(variants - 2, 0))


def _hang(kind: GrassKind, /) -> Doubles:
    """Return the angles of leaves under growing weight, one that arches and one that is folded over.

    Shape (steps, HANGING, links). Old leaves bend under their weight, or break at a weak place.
    """
    factors = np.ones((HANGING, LINKS))
    factors[1, _FOLDED_AT] = _FOLD_STIFFNESS
    sagged = sag(kind, factors, np.geomspace(_LIGHTEST, _HEAVIEST, _WEIGHTS))
    return np.concatenate([np.zeros_like(sagged[:1]), sagged])


def rest_in_winds(chain: Chain, /) -> tuple[Doubles, Doubles]:
    """Return the angles of one blade at rest in constant winds, from calm to storm, and the speeds of these winds.

    Shapes (winds, links) and (winds,).
    """
    wind = _winds(chain, _RESTS)[:, 0]
    return settle(chain, wind)[:, 0], wind


def _bend_slowly(chain: Chain, /) -> Doubles:
    """Return the angles of blades under a slowly growing wind, shape (steps, batch, links).

    It ends when every tip has been near flat. Joints are damped heavily, so that no blade swings.
    """
    batch, links = chain.stiffness.shape
    damped = damp(chain, ratio=_HEAVY_DAMPING)
    step = min(_ANGLE_STEP / float(lowest_swing(chain)[0]), _LONGEST_STEP)
    wind = _winds(chain, _STEPS)
    angle, rate = np.zeros((1, batch, links)), np.zeros((batch, links))
    for start in range(0, _STEPS, 100):
        more, rate = simulate(damped, angle[-1], rate, wind[start : start + 100], step=step)
        angle = np.concatenate([angle, more[1:]])
        if (angle[:, :, -1].max(axis=0) >= NEAR_FLAT).all():
            break
    return angle


def _winds(chain: Chain, count: int, /) -> Doubles:
    """Return `count` speeds of winds from calm to storm for each blade, shape (count, batch)."""
    scale = chain.stiffness[:, 0] / (chain.stiffness.shape[1] * chain.area.sum())
    return np.asarray(np.sqrt(np.geomspace(_CALM, _STORM, count)[:, None] * scale))


def chord_angle(angle: Doubles, /) -> Doubles:
    """Return the angle of the line from root to tip from the vertical [rad], shape (...)."""
    tip = place_links(angle)[..., -1, :]
    return np.asarray(np.arctan2(tip[..., 0], tip[..., 1]))


def flat_step(angle: Doubles, /) -> int:
    """Return the first step at which a blade's tip is near flat, else its flattest one; angles (steps, links)."""
    tip = angle[:, -1]
    return int(np.argmax(tip >= NEAR_FLAT)) or int(np.argmax(tip))


def _resample(angle: Doubles, level: Doubles, /) -> Doubles:
    """Return angles at evenly spaced deflections, shape (levels, links), exactly 0 at the first."""
    chord = np.maximum.accumulate(chord_angle(angle))
    rises = np.concatenate([[True], np.diff(chord) > 1e-9])
    deflection = level * min(chord[-1], NEAR_FLAT)
    return np.stack([np.interp(deflection, chord[rises], link) for link in angle[rises].T], axis=1)


def _random_factors(variants: int, seed: int, /) -> Doubles:
    """Return stiffness factors of the joints, shape (variants, links): 1 in variant 0, random in the others."""
    random = np.random.default_rng([seed, 0x706F7374])
    along = np.linspace(-1.0, 1.0, LINKS)
    slope = 1.7 * (2.0 * (_GOLDEN * np.arange(variants)[:, None] % 1.0) - 1.0)
    factors = np.exp(slope * along + random.normal(0.0, 0.55, (variants, LINKS)))
    factors[0] = 1.0
    return factors


def grow_give(kind: GrassKind, /) -> Floats:
    """Return the posture indices to which messages of evenly spaced lengths from 0 to 1 bend a kind's blades.

    A message's length is the index to which its wind bends the same blade at stiffness 1. A stiffer blade gets a
    smaller index, a softer one a larger, at most 1, where it lies flat. Shape (GIVES,), rising from 0.
    """
    usual = _rest_by_pressure(kind.model_copy(update={"stiffness": 1.0}))
    own = _rest_by_pressure(kind) if kind.stiffness != 1.0 else usual
    pressure = np.interp(np.linspace(0.0, 1.0, GIVES), usual[1], usual[0])
    return np.interp(pressure, *own).astype(np.float32)


def _rest_by_pressure(kind: GrassKind, /) -> tuple[Doubles, Doubles]:
    """Return squared speeds of constant winds, and the posture indices up to 1 at which they hold an even blade."""
    angle, wind = rest_in_winds(build_chain(kind, np.ones((1, LINKS))))
    end = flat_step(angle) + 1
    chord = np.maximum.accumulate(chord_angle(angle[:end]))
    return np.append(0.0, wind[:end] ** 2), np.append(0.0, chord / chord[-1])
