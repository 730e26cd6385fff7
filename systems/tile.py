"""Tiling: patches come and go around each viewer (paper, section 2.2)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import floor

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Ints
from ..engine.random import hash3
from ..engine.terrain.plots import CELL
from ..engine.terrain.record import Terrain
from ..engine.terrain.rectangle import Rectangle
from ..engine.terrain.sample import height_at, slope_at
from .around.outlook import Outlook
from .around.patches import PatchTable
from .entities import PatchEntities
from .room import make_room
from .show.representation import Representation
from .space.cone import discrete_distance, nearness, seen_from
from .space.ground import Ground
from .space.window import between, cell_of, window_cells

EDGE = 1e-4
"""Distance beyond its edge up to which a cell stays the one that a viewer stands in [patch sides]."""


def cells_on(terrain: Terrain, cell: Ints, /, *, patch: float) -> NDArray[np.bool_]:
    """Return whether the middle of each cell (n, 2) lies on the terrain, shape (n,)."""
    half = np.asarray(terrain.whole) / 2
    inside: NDArray[np.bool_] = (np.abs((cell + 0.5) * patch) <= half).all(axis=-1)
    return inside


def cells_over(terrain: Terrain, part: Rectangle, /, *, patch: float) -> tuple[Ints, Ints]:
    """Return the first and the last cell (i, j) of the patches on a part of a terrain, each (2,)."""
    ends = np.array([(part.column - 1, part.row - 1), (part.column + part.columns, part.row + part.rows)])
    first, last = np.floor((ends * terrain.cell + terrain.origin) / patch).astype(np.int32)
    return first, last


def cells_touching(cells: Ints, parts: NDArray[np.int64], /, *, patch: float) -> Ints:
    """Return those of `cells` (n, 2) that parts of the density map touch, each a cell of the map wider on all sides.

    `parts` are (row, column, rows, columns) in the map's cells, shape (m, 4).
    """
    first, last = parts[:, 1::-1], parts[:, 1::-1] + parts[:, :1:-1]  # each (column, row)
    ends = cell_of((np.stack([first - 1, last + 1], axis=1) * CELL).astype(np.float32), patch=patch)
    cells = cells[between(cells, ends[:, 0].min(axis=0), ends[:, 1].max(axis=0))]  # leaves few, mostly
    rectangles = np.array(sorted({tuple(corners) for corners in ends.reshape(-1, 4).tolist()}))
    i, j = cells.T[..., None]
    left, far, right, near = rectangles.T
    touching: Ints = cells[((i >= left) & (i <= right) & (j >= far) & (j <= near)).any(axis=1)]
    return touching


def patch_models(cell: Ints, /, *, seed: int, models: int) -> tuple[Ints, Ints]:
    """Return the index of the patch model on each cell (n, 2), and its number of quarter turns, each (n,)."""
    hashed = hash3(seed, cell[..., 0], cell[..., 1])
    return (hashed % np.uint32(models)).astype(np.int32), ((hashed >> np.uint32(16)) % np.uint32(4)).astype(np.int32)


def cell_stood_in(eye: tuple[float, float, float], before: Ints, /, *, patch: float) -> Ints:
    """Return the cell (i, j) that a viewer stands in, shape (2,), given the cell of the frame `before`.

    On its very edge that cell is kept: rounding alone must not move a whole line of patches to and fro.
    """
    (x, z), (i, j) = (eye[0] / patch, eye[2] / patch), before.tolist()
    if abs(x - i - 0.5) <= 0.5 + EDGE and abs(z - j - 0.5) <= 0.5 + EDGE:
        return before
    return np.array([floor(x), floor(z)], np.int32)


def tile(patches: PatchTable, centre: Ints, terrain: Terrain, /, *, patch: float, seed: int, models: int) -> Ints:
    """Move the window of patches to `centre` and return the rows whose patch is new, shape (n,)."""
    if _is_around(patches, centre):
        return np.zeros(0, np.int32)
    cells = window_cells(centre, side=patches.side)
    moved = cells != patches.cell
    changed = np.flatnonzero(moved[:, 0] | moved[:, 1]).astype(np.int32)
    fresh = cells[changed]
    patches.cell[changed] = fresh
    patches.alive[changed] = cells_on(terrain, fresh, patch=patch)
    patches.model[changed], patches.turn[changed] = patch_models(fresh, seed=seed, models=models)
    patches.middle[changed] = (fresh + 0.5) * patch
    middle = patches.middle[changed].astype(np.float32)
    patches.height[changed], patches.slope[changed] = height_at(terrain, middle), slope_at(terrain, middle)
    patches.empty(changed)
    patches.distance[:] = discrete_distance(cells, centre)
    patches.nearness[:] = nearness(cells, centre)
    return changed


def _is_around(patches: PatchTable, centre: Ints) -> bool:
    """Return whether the window is around `centre` already: its two opposite corners are then in their rows."""
    i, j = (centre - patches.side // 2).tolist()
    for step in (0, patches.side - 1):
        row = (j + step) % patches.side * patches.side + (i + step) % patches.side
        if patches.cell[row].tolist() != [i + step, j + step]:
            return False
    return True


@dataclass(slots=True)
class Tile:
    """The system `tile`: moves the window of patches with each viewer that looks, and their entities with them."""

    outlooks: Iterable[Outlook]
    entities: PatchEntities
    representations: Sequence[Representation]
    ground: Ground
    seed: int
    models: int
    """Number of patch models of each kind."""

    def run(self) -> None:
        """Tile around every viewer that looks."""
        self.entities.notice_deleted(self.outlooks)
        for outlook in self.outlooks:
            make_room(outlook, self.representations, self.entities.world)
            patches, viewer = outlook.patches, outlook.viewer
            patch, terrain = self.ground.patch, self.ground.terrain
            viewer.centre = cell_stood_in(viewer.eye, viewer.centre, patch=patch)
            if outlook.heights != terrain.changes.count:
                self._update_heights(outlook)
            if outlook.sown != self.ground.density.sown.count:
                self._update_densities(outlook)
            fresh = tile(patches, viewer.centre, terrain, patch=patch, seed=self.seed, models=self.models)
            seen = viewer.eye[1], outlook.heights
            if fresh.size or outlook.away_inputs != seen:
                outlook.away_inputs = seen
                patches.away[:] = seen_from(patches.distance, patches.height, viewer.eye[1], patch=patch)
            self.entities.update(outlook, fresh)

    def _update_heights(self, outlook: Outlook) -> None:
        terrain, patches, patch = self.ground.terrain, outlook.patches, self.ground.patch
        rows, columns = terrain.heights.shape
        for part in terrain.changes.since(outlook.heights) or [Rectangle(0, 0, rows, columns)]:
            first, last = cells_over(terrain, part, patch=patch)
            on = np.flatnonzero(between(patches.cell, first, last))
            middle = patches.middle[on].astype(np.float32)
            patches.height[on], patches.slope[on] = height_at(terrain, middle), slope_at(terrain, middle)
            heights = terrain.heights[part.around]
            for kept in outlook.kept.values():
                kept.planted += 1
                kept.stand_on(first, last, (float(heights.min()), float(heights.max())))
            if self.ground.density.slopes or terrain.holes is not None:
                self._replant(outlook, patches.cell[on])
        outlook.heights = terrain.changes.count

    def _update_densities(self, outlook: Outlook) -> None:
        sown, cells = self.ground.density.sown, outlook.patches.cell
        changed = sown.since(outlook.sown)
        if changed is not None:
            cells = cells_touching(cells, np.array(changed), patch=self.ground.patch)
        self._replant(outlook, cells)
        outlook.sown = sown.count

    def _replant(self, outlook: Outlook, cells: Ints) -> None:
        for kept in outlook.kept.values():
            kept.planted += 1
            kept.sow_on(cells)
