"""Planting strips: whose strips a slot of a pool holds, and how densely they grow there (paper, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints, Mask
from ....engine.terrain.plots import CELL
from ....engine.terrain.sample import density_at
from ...space.ground import PRESENT, Ground
from .pool import StripPool

MOST_PLACES = 13
"""Places along a side of a patch that are asked how densely grass grows there at most."""

STEP_OF_DENSITY = 0.35
"""By how much a kind's density changes at an edge, where pixels make out themselves how densely it grows."""

WITHIN = 1.0 / 3.0
"""An edge is a step within this part of a patch's side."""


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
    pool.edged[slots] = _steps(dense, place, ground.patch)


def _steps(dense: Floats, place: Floats, patch: float) -> Mask:
    """Return on which patches the density (kinds, m, n) of any kind, at places (m, n, 2), has an edge, shape (m,)."""
    line = round(place.shape[1] ** 0.5)
    spacing = float(place[0, 1, 0] - place[0, 0, 0])
    apart = min(max(int(patch * WITHIN / spacing), 1), line - 1)
    square, step = dense.reshape(*dense.shape[:2], line, line), STEP_OF_DENSITY * max(spacing / (patch * WITHIN), 1.0)
    down, across = square[:, :, apart:] - square[:, :, :-apart], square[..., apart:] - square[..., :-apart]
    return np.asarray((np.abs(down) > step).any(axis=(0, 2, 3)) | (np.abs(across) > step).any(axis=(0, 2, 3)))


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
