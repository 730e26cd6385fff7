"""Flutter: small oscillations of random direction and strength, each blade with its own phase (paper, section 3.3)."""

from math import cos, pi, sin

import numpy as np

from ...components.arrays import Floats
from ...engine.noise import PERIOD, noise_table, smooth_noise, wander

RIPPLE = 0.45
"""Correlation length of the oscillations over the ground [m]."""

FREQUENCIES = 2.0 * pi * 1.217, 2.0 * pi * 0.753, 2.0 * pi * 2.071
"""Angular frequencies without the drift of the noise: along x, along z, and a second one along x [rad/s].

No two have a common beat. The drift raises them to 1.3, 0.8 and 2.1 turns a second.
"""

APART = 1.5
"""Largest phase shift of a blade, ahead or behind [half turns]: so large that the grass does not sway in step."""

LEAST_BEAT = 0.6
"""Amplitude where the noise is 0; it varies by 1 less this, up and down."""

CARRIED = 0.5
"""Speed at which the mean wind carries the oscillations along, as slow as air is among blades [m/s]."""

SWAY, WHILE = 4.0, 50.0
"""Distance that the oscillations wander from that path, ahead and aside [m], and time scale of the wandering [s]."""


def flutter(place: Floats, /, *, time: float, seed: int, yaw: float = 0.0) -> Floats:
    """Return the oscillations at ground positions (n, 2) at `time` [s], for a swing of 1, shape (n, 2).

    Every wind but a perfectly steady one adds them to its messages, in proportion to its swing. All winds share one
    noise, so that a passing wind does not drag it along; only the mean wind does, which blows to `yaw` [rad].
    """
    phase, shift = _phases(time), _shift(time, seed, yaw)
    ripple = smooth_noise(noise_table(seed, 1), place / np.float32(RIPPLE), shift=shift)
    beat = np.sin(np.float32(APART * np.pi) * ripple[:, :3] + np.array(phase, np.float32))
    amplitude = np.float32(LEAST_BEAT) + np.float32(1.0 - LEAST_BEAT) * ripple[:, 3]
    return np.stack([amplitude * (beat[:, 0] + np.float32(0.5) * beat[:, 2]), amplitude * beat[:, 1]], axis=1)


def flutter_values(*, time: float, seed: int, yaw: float) -> tuple[list[float], Floats]:
    """Return what the twin reads: three phases, within one turn [rad], and the shift of the noise; and its table."""
    return [*_phases(time), *_shift(time, seed, yaw)], noise_table(seed, 1)


def _phases(time: float) -> list[float]:
    """Return the phases of `FREQUENCIES` at `time` [s], within one turn [rad]."""
    return [frequency * time % (2.0 * pi) for frequency in FREQUENCIES]


def _shift(time: float, seed: int, yaw: float) -> tuple[float, float]:
    """Return the place in the noise that is read at the origin, within its period [lattice units]."""
    x, z, *_ = wander(seed, 3, time / WHILE)
    x, z = SWAY * x + CARRIED * time * sin(yaw), SWAY * z - CARRIED * time * cos(yaw)
    return -x / RIPPLE % PERIOD, -z / RIPPLE % PERIOD
