"""Sub-levels of blades: the ring that a patch is in."""

import numpy as np

from ....components.arrays import Floats, Ints, Levels


def blade_ring(distance: Ints, current: Levels, limits: Floats, /, *, slack: int) -> Levels:
    """Return the ring of 3D patches (n,): by discrete distance; a finer one is kept for `slack` patches longer."""
    coarse, fine = limits.searchsorted(distance), limits.searchsorted(distance - slack)
    return np.where(current < 0, coarse, np.minimum(np.maximum(current, fine), coarse)).astype(np.int8)
