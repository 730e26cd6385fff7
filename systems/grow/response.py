"""How a blade answers a wind that starts and stops, over time (paper, section 3.3, figure 8)."""

from dataclasses import replace

import numpy as np

from ...engine.declared.grass import GrassKind
from .postures import bend_slowly, chord_angle, flat_step
from .record import Response
from .simulate import LINKS, Chain, Doubles, build_chain, damp, lowest_swing, simulate

SAMPLES = 256

_FINAL = 0.55
"""Posture index that the wind ends at: a gust that shows."""

_REST = 0.01
_CYCLES, _LONGEST = 4.0, 16.0
_STEPS_PER_SWING = 240
_HEAVY = 0.7


def grow_response(kind: GrassKind, /, *, samples: int = SAMPLES) -> Response:
    """Return the posture index over time of a kind's blade when a constant wind starts, and when it stops.

    Both are the simulation's own: index over the wind's final index. The time covered is what the blade needs
    to come within a hundredth of rest, between 4 and 16 of its swings; whatever swing is left then is faded
    out over the last eighth, so that a gust begins and ends with still grass.
    """
    chain = build_chain(kind, np.ones((1, LINKS)))
    step = 2.0 * np.pi / float(lowest_swing(chain)[0]) / _STEPS_PER_SWING
    angle, wind = bend_slowly(chain)
    bent, speed = _bent(chain, angle[:, 0], wind[:, 0], step)
    count = int(_STEPS_PER_SWING * _LONGEST)
    start = np.stack([np.zeros(LINKS), bent])
    winds = np.broadcast_to(np.array([speed, 0.0]), (count, 2))
    history, _ = simulate(_twice(chain), start, np.zeros_like(start), winds, step=step)
    index = chord_angle(history) / chord_angle(bent)
    length = _length(index)
    time = np.linspace(0.0, length, samples)
    rise, fall = (np.interp(time, np.arange(count + 1), index[:, k]) for k in range(2))
    return Response(
        step=length * step / chain.second / (samples - 1), rise=_settled(rise, 1.0), fall=_settled(fall, 0.0)
    )


def _bent(chain: Chain, angle: Doubles, wind: Doubles, step: float, /) -> tuple[Doubles, float]:
    """Return the blade at rest in a constant wind, shape (links,), and the wind's speed."""
    chord = np.maximum.accumulate(chord_angle(angle))
    number = int(np.argmax(chord >= _FINAL * chord[flat_step(angle)]))
    steady = np.full((int(_STEPS_PER_SWING * _CYCLES), 1), wind[number])
    settled, _ = simulate(damp(chain, ratio=_HEAVY), angle[None, number], np.zeros((1, LINKS)), steady, step=step)
    return settled[-1, 0], float(wind[number])


def _twice(chain: Chain, /) -> Chain:
    return replace(chain, stiffness=np.repeat(chain.stiffness, 2, axis=0), damping=np.repeat(chain.damping, 2, axis=0))


def _length(index: Doubles, /) -> int:
    """Return the steps after which both curves stay near rest, within the bounds."""
    away = np.flatnonzero((np.abs(index - [1.0, 0.0]) > _REST).any(axis=1))
    return int(np.clip(away[-1] * 1.15, _STEPS_PER_SWING * _CYCLES, index.shape[0] - 1))


def _settled(curve: Doubles, rest: float, /) -> np.ndarray[tuple[int], np.dtype[np.float32]]:
    part = np.linspace(0.0, 8.0, curve.shape[0]) - 7.0
    weight = np.clip(part, 0.0, 1.0)
    weight = weight * weight * (3.0 - 2.0 * weight)
    return (curve + (rest - curve) * weight).astype(np.float32)
