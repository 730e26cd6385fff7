"""The entities of patches: made a batch at a time; a patch whose entity a game deletes is cleared."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain, zip_longest

import numpy as np
from numpy.typing import NDArray

from ..components.patch import Cell, Clearings, Lod, Patch
from ..engine.world import World
from .around.outlook import Outlook
from .around.patches import PatchTable
from .space.window import window_rows

BATCH = 200
"""Maximum number of entities made, and as many deleted, in one frame: more would make it long when a viewer leaps."""


@dataclass(slots=True)
class PatchEntities:
    """Keeps an entity with `Patch` and `Lod` for every patch around a viewer.

    Where somebody else has deleted one, its patch is cleared.
    """

    world: World
    clearings: Clearings
    everyone: Callable[[], Iterable[Outlook]] = tuple
    """Returns the outlooks of all viewers, also of those that do not look in this frame."""

    def notice_deleted(self, looking: Iterable[Outlook], /) -> None:
        """Clear the patches, of all viewers, whose entities somebody else has deleted since the frame before."""
        lost = self.world.lost()
        for outlook in dict.fromkeys((*looking, *self.everyone())):
            self.clear(outlook, lost)

    def clear(self, outlook: Outlook, lost: list[int], /) -> None:
        """Clear the patches whose entities are in `lost`; forget all entities if the whole world was cleared."""
        patches = outlook.patches
        if outlook.generation != self.world.generation:
            outlook.generation = self.world.generation
            patches.entity[:] = 0
            outlook.entity_changes += 1
            outlook.left_behind.clear()
            for kept in outlook.kept.values():
                kept.lose()
        for row in np.flatnonzero(np.isin(patches.entity, lost)).tolist() if lost else ():
            patches.entity[row] = 0
            outlook.entity_changes += 1
            self.clearings.clear(_cell(patches, row))

    def update(self, outlook: Outlook, fresh: NDArray[np.int32], /) -> None:
        """Give up the entities of `fresh` rows, whose patches are new, and look up which patches are cleared.

        Patches without an entity get one, the nearest first. At most `BATCH` are made, and as many deleted.
        """
        patches = outlook.patches
        if fresh.size:
            left = patches.entity[fresh]
            outlook.left_behind.extend(left[left != 0].tolist())
            patches.entity[fresh] = 0
            outlook.entity_changes += 1
            for kept in outlook.kept.values():
                kept.leave(fresh)
        if fresh.size or outlook.cleared != self.clearings.version:
            patches.grows[:] = self.clearings.spare(patches.cell)
            outlook.cleared = self.clearings.version
        self._make_and_delete(outlook)

    def _make_and_delete(self, outlook: Outlook) -> None:
        """Make entities and delete given-up ones alternately.

        Many more objects made than deleted would start Python's garbage collector, which scans the whole game.
        """
        if outlook.complete_at == outlook.entity_changes:
            return
        patches = outlook.patches
        without = (patches.alive & (patches.entity == 0)).nonzero()[0]
        if not (without.size or outlook.left_behind):
            outlook.complete_at = outlook.entity_changes
            return
        rows = without[np.argsort(patches.distance[without], kind="stable")[:BATCH]].tolist()
        left, outlook.left_behind[:] = outlook.left_behind[:BATCH], outlook.left_behind[BATCH:]
        with self.world.exchanging():
            for _, entity in zip_longest(self._make(outlook, rows), left):
                if entity is not None:
                    self.world.delete(entity)

    def _make(self, outlook: Outlook, rows: list[int]) -> Iterator[int]:
        """Make and yield the entities of the patches in some rows, one after another."""
        patches, outlook.entity_changes = outlook.patches, outlook.entity_changes + len(rows)
        carried = components(outlook, rows)
        stand = zip(patches.cell[rows].tolist(), patches.model[rows].tolist(), patches.turn[rows].tolist(), strict=True)
        for row, ((i, j), model, turn), parts in zip(rows, stand, carried, strict=True):
            patch, lod = Patch((i, j), model, turn, self.clearings), Lod(patches, row, (i, j))
            patches.entity[row] = entity = self.world.create(patch, lod, *parts)
            yield entity

    def at(self, outlook: Outlook, cells: NDArray[np.int32], /) -> NDArray[np.int64]:
        """Return the entity of each cell (n, 2), made if it is missing, shape (n,); 0 for cells without a patch."""
        self.world.check()
        self.clear(outlook, [])  # the world may have been cleared since this viewer looked
        patches = outlook.patches
        rows = window_rows(cells, side=patches.side)
        there = patches.alive[rows] & (patches.cell[rows] == cells).all(axis=1)
        with self.world.exchanging():
            for _ in self._make(outlook, np.unique(rows[there & (patches.entity[rows] == 0)]).tolist()):
                pass
        return np.where(there, patches.entity[rows], 0)


def components(outlook: Outlook, rows: list[int], /) -> list[list[object]]:
    """Return the components that the representations add to the entity of the patch in each of some rows."""
    given = zip(rows, *(kept.components(rows) for kept in outlook.kept.values()), strict=True)
    return [[*chain.from_iterable(parts)] for _, *parts in given]


def _cell(patches: PatchTable, row: int) -> Cell:
    i, j = patches.cell[row].tolist()
    return i, j
