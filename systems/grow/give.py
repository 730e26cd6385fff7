"""How far a kind of grass gives way to a wind, from the simulation of its blades (paper, section 3.2)."""

import numpy as np

from ...components.arrays import Doubles, Floats
from ...engine.declared.grass import GrassKind
from .postures import chord_angle, flat_step, rest_in_winds
from .record import GIVES
from .simulate import LINKS, build_chain


def grow_give(kind: GrassKind, /) -> Floats:
    """Return the posture indices that messages of evenly spaced lengths from 0 to 1 bend a kind's blades to.

    A message is a wind's force: the force that bends the same blade to that index when its stiffness is 1. So a blade
    of stiffness 1 has the index of the message, a stiffer one a smaller, and a softer one a larger, up to 1, where it
    lies flat already. Shape (GIVES,), rising from 0.
    """
    common = _rest_by_pressure(kind.model_copy(update={"stiffness": 1.0}))
    own = _rest_by_pressure(kind) if kind.stiffness != 1.0 else common
    pressure = np.interp(np.linspace(0.0, 1.0, GIVES), common[1], common[0])
    return np.interp(pressure, *own).astype(np.float32)


def _rest_by_pressure(kind: GrassKind, /) -> tuple[Doubles, Doubles]:
    """Return squared speeds of constant winds, and the posture indices that they hold an even blade at, up to 1."""
    angle, wind = rest_in_winds(build_chain(kind, np.ones((1, LINKS))))
    end = flat_step(angle) + 1
    chord = np.maximum.accumulate(chord_angle(angle[:end]))
    return np.append(0.0, wind[:end] ** 2), np.append(0.0, chord / chord[-1])
