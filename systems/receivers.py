"""Receivers as entities: one per patch and representation that feels the wind."""

import numpy as np

from ..components.receivers import BladePool, StripPool
from ..components.wind import Receivers
from ..engine.world import World
from .field import Field
from .receive import Shown


class ReceiverEntities:
    """Keeps an entity with `Receivers` for every planted slot whose patch is shown.

    The arrays of an entity are slices of its pool, so that what systems write to the pool is what a game reads. A
    slot's entity goes when another patch is planted there, or the patch is no longer shown in that representation.
    """

    def __init__(self, world: World, field: Field) -> None:
        self._world = world
        self._field = field
        self._pools: list[BladePool | StripPool] = [field.blades, *field.strips]
        self._entity = [np.zeros(pool.side * pool.side, np.int64) for pool in self._pools]
        self._owner = [np.zeros(pool.side * pool.side, np.int64) for pool in self._pools]

    def follow(self, blades: list[Shown], strips: list[Shown]) -> None:
        """Create and delete entities so that they are those of the patches shown now."""
        table = self._field.table
        near = np.concatenate([ring.slots for ring in blades]), np.concatenate([ring.rows for ring in blades])
        for number, (slots, rows) in enumerate([near, *((ring.slots, ring.rows) for ring in strips)]):
            owner = np.zeros_like(self._owner[number])
            owner[slots] = table.entity[rows]
            for slot in np.flatnonzero(owner != self._owner[number]).tolist():
                self._change(number, slot, int(owner[slot]))
            self._owner[number] = owner

    def _change(self, number: int, slot: int, owner: int) -> None:
        entities, pool = self._entity[number], self._pools[number]
        if entities[slot]:
            self._world.delete(int(entities[slot]))
        entities[slot] = 0
        if owner:
            place, message = pool.place[slot].reshape(-1, 2), pool.message[slot].reshape(-1, 2)
            entities[slot] = self._world.create(Receivers(place=place, message=message))
