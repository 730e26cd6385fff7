"""Tiling: patches come and go around each viewer (paper, section 2.2)."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..components.patch import Cell, Lod, Patch
from ..engine.random import hash3
from ..engine.terrain.record import Terrain
from ..engine.terrain.sample import height_at, slope_at
from ..engine.world import World
from .around.clearing import Clearings
from .around.cone import discrete_distance
from .around.outlook import Outlook
from .around.patches import PatchTable
from .around.window import cell_of, window_cells, window_rows

Ints = NDArray[np.int32]


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


def tile(patches: PatchTable, centre: Ints, terrain: Terrain, /, *, patch: float, seed: int, models: int) -> Ints:
    """Move the window of patches to `centre` and return the rows whose patch is new, shape (n,)."""
    half = patches.side // 2
    corners = np.array([centre - half, centre - half + patches.side - 1], np.int32)
    if (patches.cell[window_rows(corners, side=patches.side)] == corners).all():
        return np.zeros(0, np.int32)
    cells = window_cells(centre, side=patches.side)
    changed = np.flatnonzero((cells != patches.cell).any(axis=1)).astype(np.int32)
    fresh = cells[changed]
    patches.cell[changed] = fresh
    patches.alive[changed] = cells_on(terrain, fresh, patch=patch)
    patches.model[changed], patches.turn[changed] = patch_models(fresh, seed=seed, models=models)
    middle = patches.middles(changed, patch=patch)
    patches.height[changed], patches.slope[changed] = height_at(terrain, middle), slope_at(terrain, middle)
    patches.empty(changed)
    return changed


@dataclass(slots=True)
class Tile:
    """The system `tile`: patches come and go around each viewer that looks, and so do their entities.

    A patch whose entity somebody has deleted is cleared of its grass. Entities are made the nearest first, `BATCH` in
    a frame, so that a viewer who leaps is no hitch.
    """

    BATCH: ClassVar[int] = 200

    outlooks: Iterable[Outlook]
    world: World
    terrain: Terrain
    clearings: Clearings
    patch: float
    """Side of a patch [m]."""

    seed: int
    models: int
    """Patch models of each kind."""

    components: Callable[[Outlook, int], tuple[object, ...]] = lambda _outlook, _row: ()
    """Gives what the entity of a row carries beside `Patch` and `Lod`."""

    def run(self) -> None:
        """Tile around every viewer that looks."""
        lost = self.world.lost()
        for outlook in self.outlooks:
            self._tile(outlook, lost)

    def _tile(self, outlook: Outlook, lost: list[int]) -> None:
        patches, viewer = outlook.patches, outlook.viewer
        if outlook.generation != self.world.generation:
            outlook.generation = self.world.generation
            patches.entity[:] = 0
            for kept in outlook.kept.values():
                kept.lose()
        viewer.centre = cell_of(np.array([viewer.eye[0], viewer.eye[2]], np.float32), patch=self.patch)
        for row in np.flatnonzero(np.isin(patches.entity, lost)).tolist() if lost else ():
            patches.entity[row] = 0
            self.clearings.clear(_cell(patches, row))
        fresh = tile(patches, viewer.centre, self.terrain, patch=self.patch, seed=self.seed, models=self.models)
        for entity in patches.entity[fresh[patches.entity[fresh] != 0]].tolist():
            self.world.delete(entity)
        patches.entity[fresh] = 0
        if fresh.size or outlook.cleared != self.clearings.version:
            patches.grows[:] = self.clearings.spare(patches.cell)
            outlook.cleared = self.clearings.version
        patches.distance[:] = discrete_distance(patches.cell, viewer.centre)
        self._enlist(outlook)

    def _enlist(self, outlook: Outlook) -> None:
        patches = outlook.patches
        without = np.flatnonzero(patches.alive & (patches.entity == 0))
        if not without.size:
            return
        nearest = without[np.argsort(patches.distance[without], kind="stable")[: self.BATCH]]
        for row in nearest.tolist():
            cell = _cell(patches, row)
            patch = Patch(cell, int(patches.model[row]), int(patches.turn[row]), self.clearings)
            lod = Lod(patches, row, cell)
            patches.entity[row] = self.world.create(patch, lod, *self.components(outlook, row))


def _cell(patches: PatchTable, row: int) -> Cell:
    i, j = patches.cell[row].tolist()
    return i, j
