"""The entities of one prairie, inside whatever esper world is current: the only module that imports esper."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from typing import TypeVar
from weakref import WeakSet

import esper

Component = TypeVar("Component")

_worlds: WeakSet["World"] = WeakSet()
_private = count()


class World:
    """A prairie's own entities among a game's.

    It never switches, clears or processes worlds: it lives in the world that was current when it was made, as
    a guest, and `release` removes exactly what it created. Worlds number their entities alike, so while the game has
    another world current, everything but `release` raises RuntimeError.
    """

    def __init__(self) -> None:
        self.name = esper.current_world
        self._entities: set[int] = set()
        _worlds.add(self)

    def create(self, *components: object) -> int:
        """Return a new entity that has `components`."""
        self._must_be_current()
        entity = esper.create_entity(*components)
        self._entities.add(entity)
        return entity

    def delete(self, entity: int) -> None:
        """Delete an entity at once; one that the game has deleted already is no error."""
        self._must_be_current()
        self._entities.discard(entity)
        if esper.entity_exists(entity):
            esper.delete_entity(entity, immediate=True)

    def add(self, entity: int, component: object) -> None:
        """Give an entity a component, in place of one of the same type."""
        self._must_be_current()
        esper.add_component(entity, component)

    def get(self, entity: int, kind: type[Component]) -> Component:
        """Return an entity's component of exactly this type; KeyError if it has none."""
        self._must_be_current()
        return esper.component_for_entity(entity, kind)

    def all(self, kind: type[Component]) -> list[tuple[int, Component]]:
        """Return every entity with a component of exactly this type, by rising entity number.

        The game's own entities are among them, those of other prairies in the same world are not. The order is fixed
        so that nothing that follows from it depends on how a set is laid out.
        """
        self._must_be_current()
        others = [world for world in _worlds if world is not self and world.name == self.name]
        found = esper.get_component(kind)
        return sorted((row for row in found if not any(row[0] in world for world in others)), key=lambda row: row[0])

    def __contains__(self, entity: object) -> bool:
        return entity in self._entities

    def __len__(self) -> int:
        return len(self._entities)

    def release(self) -> None:
        """Delete every entity created here that still exists; while another world is current, just forget them."""
        if esper.current_world == self.name:
            for entity in list(self._entities):
                self.delete(entity)
        self._entities.clear()

    def _must_be_current(self) -> None:
        if esper.current_world != self.name:
            raise RuntimeError(
                f"this prairie lives in esper world '{self.name}', but '{esper.current_world}' is current"
            )


@contextmanager
def private_world() -> Iterator[World]:
    """Make an empty esper world the current one, and in the end the host's again; the private one is deleted then.

    Whatever the body creates in esper stays inside: entities, processors, handlers. It yields a `World` for those that
    create entities as tallgrass does.
    """
    host, name = esper.current_world, f"tallgrass-private-{next(_private)}"
    esper.switch_world(name)
    try:
        yield World()
    finally:
        esper.switch_world(host)
        if name in esper.list_worlds():
            esper.delete_world(name)
