"""Planting strips: whose strips a slot of a pool holds, and how densely they grow there (paper, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints
from ....engine.terrain.plots import CELL
from ....engine.terrain.sample import density_at
from ...space.ground import PRESENT, Ground
from .pool import StripPool

MOST_PLACES = 13
"""Places along a side of a patch that are asked how densely grass grows there at most."""

STEP_OF_DENSITY = 0.35
"""By how much a kind's density changes on a patch where pixels make out themselves how densely it grows."""


def plant_strips(
    pool: StripPool, slots: NDArray[np.int64], cell: Ints, model: Ints, turn: Ints, along: Ints, ground: Ground, /
) -> None:
    """Stand the strips of each cell (m, 2), running along axis `along` (m,), in its slot of the pool."""
    pool.stamp[slots, :2], pool.stamp[slots, 2] = cell, along
    pool.stand[slots] = np.column_stack([model, turn])
    place = _spread(cell, ground, pool.strips[0].margin)
    dense = density_at(ground.density, place.reshape(-1, 2)).reshape(len(pool.strips), len(slots), -1)
    least, most = dense.min(axis=2).T, dense.max(axis=2).T
    grows = most > PRESENT
    pool.present[slots] = grows
    pool.least[slots] = np.where(grows, least, np.float32(1.0)).min(axis=1)
    pool.edged[slots] = (most - least > STEP_OF_DENSITY).any(axis=1)


def _spread(cell: Ints, ground: Ground, margin: float) -> Floats:
    """Return places (x, z) all over cells (m, 2), and as far beyond as strips reach, shape (m, n, 2) [m].

    They lie about as close as the samples of what is painted, or the cells of what is sown, so that no way across a
    patch is missed.
    """
    _, rows, columns = ground.density.maps.shape
    finest = min(ground.density.size[0] / columns, ground.density.size[1] / rows)
    if ground.density.sown.any:
        finest = min(finest, CELL)
    count = int(np.clip(np.ceil((ground.patch + 2.0 * margin) / finest), 1, MOST_PLACES - 1)) + 1
    line = np.linspace(-margin, ground.patch + margin, count, dtype=np.float32)
    square = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2)
    return np.asarray(cell[:, None] * np.float32(ground.patch) + square, np.float32)
