"""Planting strips: a patch model's strips stood on the terrain of one cell (paper, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ....engine.terrain.sample import density_at, height_at
from ...around.ground import PRESENT, Ground, turned
from .grow import Strips
from .pool import StripPool

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]


def strip_edges(strips: Strips, columns: int, along: Ints, turn: Ints, /, *, patch: float) -> tuple[Floats, Ints]:
    """Return the feet of the strips' edges in patches turned by `turn` (m,) whose strips run along axis `along` (m,).

    The first array (m, strips, columns + 1, 2) holds positions in the patch, strips by rising place in their stack;
    the second (m, strips) says which of the model's planes each strip is.
    """
    reach = np.linspace(-strips.margin, patch + strips.margin, columns + 1, dtype=np.float32)
    u, plane = np.broadcast_arrays(reach[None, :], strips.plane[:, None])
    own = (along + turn) % 2
    local = np.where(own[:, None, None, None] == 0, np.stack([u, plane], -1), np.stack([plane, u], -1))
    spun = turned(local, turn[:, None, None], patch=patch)
    stack = np.take_along_axis(spun[:, :, 0, :], (1 - along)[:, None, None], axis=2)[..., 0]
    order = np.argsort(stack, axis=1).astype(np.int32)
    return np.take_along_axis(spun, order[:, :, None, None], axis=1), order


def plant_strips(
    pool: StripPool,
    slots: NDArray[np.int64],
    cell: Ints,
    model: Ints,
    turn: Ints,
    along: Ints,
    rings: list[Strips],
    first_layer: list[int],
    ground: Ground,
    /,
) -> None:
    """Stand the strips of each cell (m, 2), running along axis `along` (m,), in its slot of the pool.

    `rings[kind]` gives the strips' planes, `first_layer[kind]` where the kind's layers start in the texture array:
    models, then orientations, then strips.
    """
    pool.stamp[slots, :2], pool.stamp[slots, 2] = cell, along
    corner = cell.astype(np.float32) * np.float32(ground.patch)
    columns = pool.ground.shape[-1] - 1
    pool.least[slots] = 1.0
    for kind, strips in enumerate(rings):
        count = len(strips.plane)
        local, order = strip_edges(strips, columns, along, turn, patch=ground.patch)
        place = (local + corner[:, None, None, :]).astype(np.float32)
        flat = place.reshape(-1, 2)
        pool.place[slots, kind] = place
        pool.ground[slots, kind] = height_at(ground.terrain, flat).reshape(place.shape[:-1])
        pool.layer[slots, kind] = first_layer[kind] + ((model * 2 + (along + turn) % 2) * count)[:, None] + order
        dense = density_at(ground.density, flat)[kind].reshape(len(slots), -1)
        grows = dense.max(axis=1) > PRESENT
        pool.present[slots, kind] = grows
        pool.least[slots] = np.where(grows, np.minimum(pool.least[slots], dense.min(axis=1)), pool.least[slots])
