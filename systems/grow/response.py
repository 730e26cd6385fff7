"""Response of a blade to a wind that starts and stops: its index over time (paper, section 3.3, figure 8)."""

from dataclasses import replace

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.grass import GrassKind
from .postures import chord_angle, flat_step, rest_in_winds
from .record import Response
from .simulate import LINKS, Chain, build_chain, lowest_swing, settle, simulate

SAMPLES = 256

_FINAL = 0.55
"""Posture index at rest in the simulated wind, as in a visible gust."""

_REST = 0.01
_CYCLES, _LONGEST, _STILL = 4.0, 16.0, 3.0
_STEPS_PER_SWING = 120


def grow_response(kind: GrassKind, /) -> Response:
    """Return the posture index over time of a kind's blade when a constant wind starts, and when it stops.

    Both are simulated, as index over the wind's final index. They last until the blade stays within a hundredth
    of rest, between 4 and 16 of its swings; the remaining swing is faded out over the last eighth, so that a gust
    begins and ends with still grass.
    """
    chain = build_chain(kind, np.ones((1, LINKS)))
    step = 2.0 * np.pi / float(lowest_swing(chain)[0]) / _STEPS_PER_SWING
    bent, speed = _bent_by_wind(chain)
    index = _swings(chain, bent, speed, step)
    length = _length(index)
    time = np.linspace(0.0, length, SAMPLES)
    rise, fall = (np.interp(time, np.arange(len(index)), index[:, k]) for k in range(2))
    return Response(
        step=length * step / chain.second / (SAMPLES - 1), rise=_faded_to(rise, 1.0), fall=_faded_to(fall, 0.0)
    )


def _bent_by_wind(chain: Chain, /) -> tuple[Doubles, float]:
    """Return the angles at rest in the constant wind that bends a blade to `_FINAL`, (links,), and the wind's speed."""
    angle, wind = rest_in_winds(chain)
    chord = np.maximum.accumulate(chord_angle(angle))
    final = _FINAL * chord[flat_step(angle)]
    number = int(np.argmax(chord >= final))
    speed = float(np.interp(final, chord[number - 1 : number + 1], wind[number - 1 : number + 1]))
    return settle(chain, np.append(wind[:number], speed))[-1, 0], speed


def _swings(chain: Chain, bent: Doubles, speed: float, step: float, /) -> Doubles:
    """Return the index over time of a blade when the wind starts, and when it stops, shape (steps, 2).

    A swing only dies down: the simulation ends when both have been at rest for `_STILL` swings.
    """
    twice = replace(chain, stiffness=np.repeat(chain.stiffness, 2, 0), damping=np.repeat(chain.damping, 2, 0))
    angle = np.stack([np.zeros(LINKS), bent])[None]
    rate = np.zeros_like(angle[0])
    winds = np.broadcast_to(np.array([speed, 0.0]), (_STEPS_PER_SWING, 2))
    for swing in range(int(_LONGEST)):
        more, rate = simulate(twice, angle[-1], rate, winds, step=step)
        angle = np.concatenate([angle, more[1:]])
        index = chord_angle(angle) / chord_angle(bent)
        if swing + 1 >= _CYCLES and len(index) - _last_away(index) > _STILL * _STEPS_PER_SWING:
            break
    return np.asarray(index)


def _last_away(index: Doubles, /) -> int:
    """Return the last step at which one of both curves is away from rest."""
    return int(np.flatnonzero((np.abs(index - [1.0, 0.0]) > _REST).any(axis=1))[-1])


def _length(index: Doubles, /) -> int:
    """Return the number of steps until both curves stay near rest, within the bounds."""
    return int(np.clip(_last_away(index) * 1.15, _STEPS_PER_SWING * _CYCLES, index.shape[0] - 1))


def _faded_to(curve: Doubles, rest: float, /) -> np.ndarray[tuple[int], np.dtype[np.float32]]:
    """Return a curve that fades to `rest` over its last eighth."""
    part = np.linspace(0.0, 8.0, curve.shape[0]) - 7.0
    weight = np.clip(part, 0.0, 1.0)
    weight = weight * weight * (3.0 - 2.0 * weight)
    return (curve + (rest - curve) * weight).astype(np.float32)
