"""Flutter: small oscillations of random direction and strength, each blade's in its own time (paper, section 3.3)."""

from math import pi

import numpy as np
from numpy.typing import NDArray

from ...components.wind import TwinValues
from ...engine.noise import noise_table, smooth_noise

Floats = NDArray[np.float32]

RIPPLE = 0.45
"""Distance over which neighbouring blades swing alike [m]."""

PACES = 2.0 * np.pi * np.array([1.3, 0.9, 2.1], np.float32)
"""How fast blades swing: along x, along z, and a second time along x [rad/s]."""

_PACES: list[float] = PACES.tolist()

APART = 1.5
"""Most half turns that a blade is ahead or behind: so many that the grass as a whole does not sway in step."""


def flutter(place: Floats, /, *, time: float, seed: int) -> Floats:
    """Return the oscillations at ground positions (n, 2) at `time` [s], for a swing of 1, shape (n, 2).

    Every wind but a perfectly steady one adds them to its messages, in proportion to its swing; their noise stands on
    the ground, so that a wind that passes does not drag it along.
    """
    ripple = smooth_noise(noise_table(seed, 1), place / np.float32(RIPPLE))
    beat = np.sin(np.float32(APART * np.pi) * ripple[:, :3] + np.float32(np.mod(PACES * np.float64(time), 2.0 * np.pi)))
    own = np.float32(0.6) + np.float32(0.4) * ripple[:, 3]
    return np.stack([own * (beat[:, 0] + np.float32(0.5) * beat[:, 2]), own * beat[:, 1]], axis=1)


def flutter_values(*, time: float, seed: int) -> TwinValues:
    """Return what the twin reads: how far blades have swung at `time` [s], in one turn, and their noise."""
    turn = 2.0 * pi
    return TwinValues([pace * time % turn for pace in _PACES], (noise_table(seed, 1),))
