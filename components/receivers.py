"""Pools of receivers: all blades and strip edges that feel the wind, as structures of arrays."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Receivers:
    """What collects the wind's messages for one patch in one representation (paper, section 3.2).

    One row per blade, or per vertical edge of a strip. The arrays are slices of one pool.
    """

    place: Floats
    """Ground position (x, z) [m], shape (n, 2)."""

    message: Floats
    """Bending direction times posture index, (x, z), shape (n, 2)."""
