"""Flutter: small oscillations of random direction and strength, each blade's in its own time (paper, section 3.3)."""

from math import cos, pi, sin

import numpy as np

from ...components.arrays import Floats
from ...components.wind import TwinValues
from ...engine.noise import PERIOD, noise_table, smooth_noise, wander

RIPPLE = 0.45
"""Distance over which neighbouring blades swing alike [m]."""

PACES = 2.0 * pi * 1.217, 2.0 * pi * 0.753, 2.0 * pi * 2.071
"""How fast blades swing where they stand: along x, along z, and a second time along x [rad/s].

No two have a common beat. What is carried along makes them 1.3, 0.8 and 2.1 turns a second.
"""

APART = 1.5
"""Most half turns that a blade is ahead or behind: so many that the grass as a whole does not sway in step."""

LEAST_BEAT = 0.6
"""How strongly a blade swings where the noise is 0, and as much stronger or weaker as it lacks to 1."""

CARRIED = 0.5
"""How fast the mean wind carries the oscillations along, as slow as air is among blades [m/s]."""

SWAY, WHILE = 4.0, 50.0
"""How far ahead and aside of that they wander [m], and after how long they are elsewhere [s]."""


def flutter(place: Floats, /, *, time: float, seed: int, to: float = 0.0) -> Floats:
    """Return the oscillations at ground positions (n, 2) at `time` [s], for a swing of 1, shape (n, 2).

    Every wind but a perfectly steady one adds them to its messages, in proportion to its swing. Their noise is one for
    all winds, so that one that passes does not drag it along; the mean wind does, which blows to the yaw `to` [rad].
    """
    turn, carried = _turned(time), _carried(time, seed, to)
    ripple = smooth_noise(noise_table(seed, 1), place / np.float32(RIPPLE), shift=carried)
    beat = np.sin(np.float32(APART * np.pi) * ripple[:, :3] + np.array(turn, np.float32))
    own = np.float32(LEAST_BEAT) + np.float32(1.0 - LEAST_BEAT) * ripple[:, 3]
    return np.stack([own * (beat[:, 0] + np.float32(0.5) * beat[:, 2]), own * beat[:, 1]], axis=1)


def flutter_values(*, time: float, seed: int, to: float = 0.0) -> TwinValues:
    """Return what the twin reads: how far blades have swung, in one turn, how far their noise has come, and it."""
    return TwinValues([*_turned(time), *_carried(time, seed, to)], (noise_table(seed, 1),))


def _turned(time: float) -> list[float]:
    """Return how far blades have swung at `time` [s], in one turn [rad]."""
    return [pace * time % (2.0 * pi) for pace in PACES]


def _carried(time: float, seed: int, to: float) -> tuple[float, float]:
    """Return where the noise is read at the origin, within its period [lattice units]."""
    x, z, *_ = wander(seed, 3, time / WHILE)
    x, z = SWAY * x + CARRIED * time * sin(to), SWAY * z - CARRIED * time * cos(to)
    return -x / RIPPLE % PERIOD, -z / RIPPLE % PERIOD
