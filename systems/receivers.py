"""Receivers as entities: one per patch and representation that feels the wind."""

import numpy as np

from ..components.receivers import Receivers
from ..engine.world import World
from .field import Field
from .show.blades.pool import BladePool
from .show.seen import Shown
from .show.strips.pool import StripPool


class ReceiverEntities:
    """Keeps an entity with `Receivers` for every planted slot whose patch is shown.

    The arrays of an entity are slices of its pool, so that what systems write to the pool is what a game reads. A
    slot's entity goes when another patch is planted there, or the patch is no longer shown in that representation.
    """

    def __init__(self, world: World, field: Field) -> None:
        self._world = world
        self._field = field
        self._pools: list[BladePool | StripPool] = [field.blades, *field.strips]
        self._entity = [np.zeros(len(pool.stamp), np.int64) for pool in self._pools]
        self._owner = [np.zeros(len(pool.stamp), np.int64) for pool in self._pools]

    def follow(self, blades: Shown, strips: list[Shown]) -> None:
        """Create and delete entities so that they are those of the patches shown now."""
        table = self._field.table
        for number, shown in enumerate([blades, *strips]):
            owner = np.zeros_like(self._owner[number])
            owner[shown.slots] = table.entity[shown.rows]
            for slot in np.flatnonzero(owner != self._owner[number]).tolist():
                self._change(number, slot, int(owner[slot]))
            self._owner[number] = owner

    def release(self) -> None:
        """Delete all of its entities."""
        for entities in self._entity:
            for entity in entities[entities != 0].tolist():
                self._world.delete(entity)
            entities[:] = 0

    def _change(self, number: int, slot: int, owner: int) -> None:
        entities, pool = self._entity[number], self._pools[number]
        if entities[slot]:
            self._world.delete(int(entities[slot]))
        entities[slot] = 0
        if owner:
            place, message = pool.place[slot].reshape(-1, 2), pool.message[slot].reshape(-1, 2)
            entities[slot] = self._world.create(Receivers(place=place, message=message))
