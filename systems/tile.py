"""Tiling: patches come and go around the viewer (paper, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ..engine.random import hash3
from ..engine.terrain.record import Terrain
from ..engine.terrain.sample import height_at, slope_at
from ..engine.world import World
from .patches import PatchTable

Ints = NDArray[np.int32]


def cell_of(place: NDArray[np.float32], /, *, patch: float) -> Ints:
    """Return the cells (i, j) that ground positions (x, z) lie in, both of shape (..., 2)."""
    return np.floor(np.asarray(place, np.float64) / patch).astype(np.int32)


def window_rows(cell: Ints, /, *, side: int) -> NDArray[np.int64]:
    """Return the row of each cell (n, 2) in a window of `side` by `side` that wraps round, shape (n,)."""
    wrapped = np.mod(cell, side).astype(np.int64)
    rows: NDArray[np.int64] = wrapped[:, 1] * side + wrapped[:, 0]
    return rows


def window_cells(centre: Ints, /, *, side: int) -> Ints:
    """Return the cell at each row of a window around `centre`, shape (side * side, 2)."""
    low = np.asarray(centre, np.int64) - side // 2
    line = np.arange(side, dtype=np.int64)
    i, j = (corner + np.mod(line - corner, side) for corner in low)
    cells: Ints = np.stack(np.meshgrid(i, j), axis=-1).reshape(-1, 2).astype(np.int32)
    return cells


def cells_on(terrain: Terrain, cell: Ints, /, *, patch: float) -> NDArray[np.bool_]:
    """Return whether the middle of each cell (n, 2) lies on the terrain, shape (n,)."""
    half = np.asarray(terrain.size) / 2
    inside: NDArray[np.bool_] = (np.abs((cell + 0.5) * patch) <= half).all(axis=-1)
    return inside


def patch_models(cell: Ints, /, *, seed: int, models: int) -> tuple[Ints, Ints]:
    """Return which patch model stands on each cell (n, 2) and how many quarter turns it is given, each (n,)."""
    drawn = hash_cells(seed, cell)
    return (drawn % np.uint32(models)).astype(np.int32), ((drawn >> np.uint32(16)) % np.uint32(4)).astype(np.int32)


def hash_cells(seed: int, cell: Ints) -> NDArray[np.uint32]:
    """Return a well mixed number for each cell (n, 2)."""
    return hash3(seed, cell[..., 0], cell[..., 1])


def tile(
    table: PatchTable, centre: Ints, terrain: Terrain, world: World, /, *, patch: float, seed: int, models: int
) -> Ints:
    """Move the window of patches to `centre` and return the rows whose patch is new, shape (n,).

    Patches that leave the window lose their entity; those that come have one with `Patch` and `Lod`.
    """
    half = table.side // 2
    corners = np.array([centre - half, centre - half + table.side - 1], np.int32)
    if (table.cell[window_rows(corners, side=table.side)] == corners).all():
        return np.zeros(0, np.int32)
    cells = window_cells(centre, side=table.side)
    changed = np.flatnonzero((cells != table.cell).any(axis=1)).astype(np.int32)
    if not changed.size:
        return changed
    fresh = cells[changed]
    table.cell[changed] = fresh
    table.alive[changed] = cells_on(terrain, fresh, patch=patch)
    table.model[changed], table.turn[changed] = patch_models(fresh, seed=seed, models=models)
    middle = (fresh.astype(np.float32) + np.float32(0.5)) * np.float32(patch)
    table.height[changed], table.slope[changed] = height_at(terrain, middle), slope_at(terrain, middle)
    table.representation[changed] = table.previous[changed] = -1
    table.sublevel[:, changed] = table.sublevel_before[:, changed] = -1
    table.progress[changed], table.sublevel_progress[:, changed] = 1.0, 1.0
    table.visible[changed] = False
    for row in changed.tolist():
        if table.entity[row]:
            world.delete(int(table.entity[row]))
        table.entity[row] = world.create(table.patch(row), table.lod(row)) if table.alive[row] else 0
    return changed
