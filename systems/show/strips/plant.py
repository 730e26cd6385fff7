"""Planting strips: whose strips a slot of a pool holds, and how densely they grow there (paper, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Ints
from ....engine.terrain.sample import own_density_at, sown_between
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
    least, most = dense.min(axis=2), dense.max(axis=2)
    corner = cell.astype(np.float32) * np.float32(ground.patch)
    sown, least_sown, most_sown = sown_between(ground.density, corner, corner + np.float32(ground.patch))
    least[sown] = np.minimum(least[sown], least_sown[sown])  # edges stand too far apart for what is so narrow
    most[sown] = np.maximum(most[sown], most_sown[sown])
    grows = most > PRESENT
    pool.present[slots] = grows
    pool.least[slots] = np.where(grows, least, np.float32(1.0)).min(axis=1)
