"""Planting strips: whose strips a slot of a pool holds, and how densely they grow there (paper, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ....engine.terrain.sample import density_at
from ...around.ground import PRESENT, Ground
from .pool import StripPool

Ints = NDArray[np.int32]


def plant_strips(
    pool: StripPool, slots: NDArray[np.int64], cell: Ints, model: Ints, turn: Ints, along: Ints, ground: Ground, /
) -> None:
    """Stand the strips of each cell (m, 2), running along axis `along` (m,), in its slot of the pool."""
    pool.stamp[slots, :2], pool.stamp[slots, 2] = cell, along
    pool.stand[slots] = np.column_stack([model, turn])
    place = pool.places(slots)
    least = np.ones(len(slots), np.float32)
    for kind in range(len(pool.strips)):
        dense = density_at(ground.density, place[:, kind].reshape(-1, 2))[kind].reshape(len(slots), -1)
        grows = dense.max(axis=1) > PRESENT
        pool.present[slots, kind] = grows
        least = np.where(grows, np.minimum(least, dense.min(axis=1)), least)
    pool.least[slots] = least
