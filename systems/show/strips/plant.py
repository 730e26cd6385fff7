"""Planting strips: whose strips a slot of a pool holds, and how densely they grow there (paper, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Ints
from ....engine.terrain.sample import own_density_at
from ...space.ground import PRESENT, Ground
from .pool import StripPool


def plant_strips(
    pool: StripPool, slots: NDArray[np.int64], cell: Ints, model: Ints, turn: Ints, along: Ints, ground: Ground, /
) -> None:
    """Stand the strips of each cell (m, 2), running along axis `along` (m,), in its slot of the pool."""
    pool.stamp[slots, :2], pool.stamp[slots, 2] = cell, along
    pool.stand[slots] = np.column_stack([model, turn])
    own = own_density_at(ground.density, pool.kind(slots), pool.places(slots).reshape(-1, 2))
    dense = own.reshape(len(slots), len(pool.strips), -1)
    grows = dense.max(axis=2) > PRESENT
    pool.present[slots] = grows
    pool.least[slots] = np.where(grows, dense.min(axis=2), np.float32(1.0)).min(axis=1)
