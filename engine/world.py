"""The entities of one prairie in an esper world; the only module that imports esper."""

import gc
import logging
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
from operator import itemgetter
from typing import Any, TypeVar
from weakref import WeakMethod, WeakSet, ref

import esper

from ..components.pose import Pose
from .handed import NUMBER_TYPES, SOMEWHERE, is_somewhere

Component = TypeVar("Component")
Other = TypeVar("Other")
Row = TypeVar("Row", bound=tuple[Any, ...])

PRIORITY = 100
"""Priority of the processor that `install` adds. Those of lower priority, 0 by default, run after it."""

log = logging.getLogger("tallgrass")

_worlds: WeakSet["World"] = WeakSet()
_private = count()


class Residents:
    """The entities of one prairie, and those of them that the game has deleted."""

    __slots__ = ("lost", "marks")

    def __init__(self) -> None:
        self.marks: dict[int, int] = {}
        """Identity of each entity's `Resident` component: entity numbers may be used again."""
        self.lost: list[int] = []

    def note_gone(self, resident: "Resident", /) -> None:
        """Record that an entity has been deleted, unless a new entity has its number."""
        if self.marks.get(resident.entity) == id(resident):
            del self.marks[resident.entity]
            self.lost.append(resident.entity)


@dataclass(slots=True, eq=False, weakref_slot=True)
class Resident:
    """A component of every entity that a prairie created.

    A game that deletes its entities leaves those with this component alone; the prairie deletes them itself.
    """

    owner: Residents

    entity: int = 0
    """Entity that it marks."""

    def __del__(self) -> None:
        """Notify the owner: only esper refers to a mark, so it is freed as soon as its entity is deleted."""
        self.owner.note_gone(self)


class _Never:
    """A component that no entity has. Esper caches the list of those that do until any entity or component changes."""


class World:
    """A prairie's own entities among a game's.

    They live in the esper world that was current when this was made, and `release` removes exactly what this created.
    While the game has another world current, everything but `release` raises RuntimeError, as all worlds use the same
    entity numbers. The processor of `install` calls `advance` with each step of time [s].
    """

    def __init__(self, advance: Callable[[float], None] | None = None) -> None:
        self.name = esper.current_world
        self.advance = None if advance is None else _weakly(advance)
        self.generation = 0
        """Number of times that all our entities were deleted at once, as by `esper.clear_database`."""
        self._home: ref[Resident] | None = None
        self._mine = Residents()
        self._changes, self._cached, self._deferred = 0, esper.get_component(_Never), 0
        self._logged: set[int] = set()
        """Entities whose unusable pose has been logged."""
        self.warned: set[str] = set()
        """Warnings about a prairie's entities that are logged once for all of them, and have been."""
        _worlds.add(self)

    def create(self, *components: object) -> int:
        """Return a new entity that has `components`."""
        self._must_be_current()
        self.check()
        if self._home is None:  # an entity that no game has a reason to delete: it is gone only if all are
            home = Resident(self._mine)
            self._home = ref(home)
            esper.create_entity(home)
        mark = Resident(self._mine)
        mark.entity = entity = esper.create_entity(*components, mark)
        self._mine.marks[entity] = id(mark)
        return entity

    def give(self, *components: object) -> int:
        """Return a new entity with `components` that belongs to the game, and outlives the prairie."""
        self._must_be_current()
        return esper.create_entity(*components)

    def check(self) -> int:
        """Return `generation`, incremented if the whole world was cleared since the last call."""
        if self._home is not None and self._home() is None:
            self._home = None
            self._mine.lost.clear()
            self.generation += 1
        return self.generation

    def changes(self) -> int:
        """Return a number that rises when entities or components have come or gone other than while `exchanging`.

        It also rises when the game deletes an entity and esper defers that.
        """
        self._must_be_current()
        cached, deferred = esper.get_component(_Never), len(_deferred())
        if cached is not self._cached or deferred != self._deferred:
            self._changes, self._cached, self._deferred = self._changes + 1, cached, deferred
        return self._changes

    @contextmanager
    def exchanging(self) -> Iterator[None]:
        """Let entities come and go that concern nobody who asks for `changes`, as patches do in every frame."""
        self.changes()
        yield
        self._cached = esper.get_component(_Never)

    def lost(self) -> list[int]:
        """Return our entities that the game has deleted one by one since the last call, even if esper defers that."""
        self.check()
        mine = self._mine
        lost = mine.lost + [entity for entity in sorted(_deferred()) if mine.marks.pop(entity, None) is not None]
        mine.lost.clear()
        return lost

    def delete(self, entity: int) -> None:
        """Delete an entity of ours at once; one that the game has deleted already is no error."""
        self._must_be_current()
        self._mine.marks.pop(entity, None)
        if self.has(entity):
            esper.delete_entity(entity, immediate=True)

    def has(self, entity: int) -> bool:
        """Return whether an entity of ours exists; not if the game has deleted it, even if esper still defers that."""
        self._must_be_current()
        # After a game clears its world, numbers start at 1 again: a number alone does not tell whose the entity is.
        return esper.entity_exists(entity) and self._owner(entity) is self._mine

    def add(self, entity: int, component: object) -> None:
        """Give an entity a component, replacing one of the same type."""
        self._must_be_current()
        esper.add_component(entity, component)

    def drop(self, entity: int, kind: type[object]) -> None:
        """Remove an entity's component of exactly this type, if it has one."""
        self._must_be_current()
        if esper.has_component(entity, kind):
            esper.remove_component(entity, kind)

    def uproot(self, entity: int, kind: type[object]) -> None:
        """Remove an entity's component of exactly this type, and the entity if only a pose is left."""
        self.drop(entity, kind)
        left: tuple[object, ...] = esper.components_for_entity(entity)
        if all(isinstance(each, Pose | Resident) for each in left):
            self._mine.marks.pop(entity, None)
            esper.delete_entity(entity, immediate=True)

    def find(self, entity: int, kind: type[Component]) -> Component | None:
        """Return an entity's component of exactly this type, None if it has none."""
        self._must_be_current()
        return esper.try_component(entity, kind)

    def all(self, kind: type[Component]) -> list[tuple[int, Component]]:
        """Return every entity with a component of exactly this type, by rising entity number.

        The game's own entities are among them, those of other prairies in the same world are not, nor those that the
        game has deleted, even if esper still defers that. The order is fixed, so that results do not depend on a set's
        order.
        """
        self._must_be_current()
        return self.own(esper.get_component(kind))

    def own(self, rows: Sequence[Row], /) -> list[Row]:
        """Return those rows that begin with an entity of `all`, by rising entity number."""
        mine, component_of, exists, found = self._mine, esper.try_component, esper.entity_exists, list[Row]()
        for row in rows:
            mark = component_of(row[0], Resident)
            if (mark is None or mark.owner is mine) and exists(row[0]):  # the game's, and our own
                found.append(row)
        return sorted(found, key=itemgetter(0))

    def rows(self, kind: type[Component]) -> list[tuple[int, Component]]:
        """Return every entity with a component of exactly this type, in any order, those of other prairies too.

        Deleted ones are not among them, even if esper still defers that. It caches the list until any entity comes or
        goes: ask for `changes` first. Compare it with a kept one to see what has changed, and exchange many entities
        `uncollected`.
        """
        self._must_be_current()
        rows, deferred = esper.get_component(kind), _deferred()
        return [row for row in rows if row[0] not in deferred] if deferred else rows

    def beside(self, rows: list[tuple[int, Component]], other: type[Other]) -> list[Other | None]:
        """Return the component of exactly the type `other` of each entity in some rows, None where it has none."""
        find = esper.try_component
        return [find(entity, other) for entity, _ in rows]

    def both(self, kind: type[Component], other: type[Other]) -> list[tuple[int, Component, Other]]:
        """Return every entity with components of exactly these two types, of the same owners and order as `all`."""
        rows = self.all(kind)
        found = zip(rows, self.beside(rows, other), strict=True)
        return [(entity, one, two) for (entity, one), two in found if two is not None]

    def stands(self, entity: int, pose: Pose | None, what: str) -> bool:
        """Return whether an entity has a usable pose; if not, log once that its `what` is left out."""
        return self.standing([(entity, pose)], what)[0]

    def standing(self, poses: Sequence[tuple[int, Pose | None]], what: str, *, high: bool = False) -> list[bool]:
        """Return whether each entity has a usable pose; log in one message the `what` of those newly left out.

        If they are `high`, as lamps are, a pose needs a height, too.
        """
        usable = [pose is not None and is_somewhere(pose) and not (high and pose.y is None) for _, pose in poses]
        lost = [row for row, there in zip(poses, usable, strict=True) if not there and row[0] not in self._logged]
        if lost:
            self._logged.update(entity for entity, _ in lost)
            (entity, pose), more = lost[0], f", and {len(lost) - 1} more likewise" if len(lost) > 1 else ""
            have, due = pose or "no Pose", f"{SOMEWHERE}, and a lamp's pose has a height y" if high else SOMEWHERE
            log.warning("%s of entity %d is left out while it has %s%s: %s", what, entity, have, more, due)
        return usable

    def _owner(self, entity: int) -> Residents | None:
        mark = esper.try_component(entity, Resident)
        return None if mark is None else mark.owner

    def __contains__(self, entity: object) -> bool:
        return entity in self._mine.marks

    def __len__(self) -> int:
        return len(self._mine.marks)

    def release(self) -> None:
        """Delete every entity created here that still exists; with the world's last prairie, also the processor.

        If the game has another world current, this one is made current meanwhile.
        """
        if self.name in esper.list_worlds():
            with _current(self.name):
                for entity in list(self._mine.marks):
                    self.delete(entity)
                for entity, mark in esper.get_component(Resident):
                    if mark.owner is self._mine and esper.entity_exists(entity):  # esper fails if one is gone twice
                        esper.delete_entity(entity, immediate=True)
                if not _residents(self.name, but=self) and self in _worlds:
                    esper.remove_processor(Advance)
        self._mine.marks.clear()
        self._home = None
        self.advance = None
        _worlds.discard(self)

    def come_back(self) -> str:
        """Make this world current again if other code left another one current; return what it did, or ""."""
        left = esper.current_world
        if left == self.name or self.name not in esper.list_worlds():
            return ""
        esper.switch_world(self.name)
        return f"left esper world '{left}' current in place of '{self.name}'"

    def _must_be_current(self) -> None:
        if esper.current_world != self.name:
            if self.name not in esper.list_worlds():
                raise RuntimeError(f"esper world '{self.name}', where this prairie lived, was deleted: load it again")
            raise RuntimeError(
                f"this prairie lives in esper world '{self.name}', but '{esper.current_world}' is current"
            )


class Advance(esper.Processor):
    """Advances every prairie in its world; `install` adds it."""

    def process(self, dt: object = None, *args: object, **options: object) -> None:
        """Advance by `dt` [s]; without it, time stands still. A game's other arguments are ignored."""
        if dt is None:
            return
        if not isinstance(dt, NUMBER_TYPES):
            raise TypeError(
                f"esper.process hands its arguments to every processor, and tallgrass needs dt [s] first, not {dt!r}"
            )
        for world in _residents(esper.current_world):
            if world.advance is not None:
                world.advance(float(dt))


def install() -> None:
    """Let `esper.process(dt)` advance the prairies of the current esper world; a second time does nothing.

    It adds one processor, of priority 100, which draws nothing and leaves with the world's last prairie. Whoever calls
    this does not call `Prairie.advance`. A prairie lives in the world that was current when it was loaded, installed
    or not: its patches, its receivers and its winds are entities there, for a game's own processors to read and write.
    """
    if esper.get_processor(Advance) is None:
        esper.add_processor(Advance(), PRIORITY)


def _weakly(method: Callable[[float], None]) -> Callable[[float], None]:
    """Return a function that calls a method unless its owner was dropped: the owner's entities refer to its world."""
    found = WeakMethod(method)

    def call(dt: float) -> None:
        kept = found()
        if kept is not None:
            kept(dt)

    return call


def _deferred() -> Collection[int]:
    """Return the entities whose deletion esper defers; esper tells of them only one by one, in `entity_exists`."""
    return getattr(esper, "_dead_entities", ())


def _residents(name: str, *, but: World | None = None) -> list[World]:
    return [world for world in _worlds if world.name == name and world is not but]


@contextmanager
def _current(name: str) -> Iterator[None]:
    """Make another of the game's worlds current inside.

    Garbage collection is off there: an event handler of the game that were collected now would leave its reference in
    its own world.
    """
    before = esper.current_world
    if before == name:
        yield
        return
    with uncollected():
        esper.switch_world(name)
        try:
            yield
        finally:
            esper.switch_world(before)


@contextmanager
def uncollected() -> Iterator[None]:
    """Turn garbage collection off inside: objects that are made and dropped there never trigger it."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


@contextmanager
def private_world() -> Iterator[World]:
    """Make a new empty esper world current inside, and delete it in the end; then the host's world is current again.

    Entities, processors and handlers that the body creates stay in the new world. Yields a `World` for creating
    entities as a prairie does.
    """
    host, name = esper.current_world, f"tallgrass-private-{next(_private)}"
    esper.switch_world(name)
    try:
        yield World()
    finally:
        esper.switch_world(host)
        if name in esper.list_worlds():
            esper.delete_world(name)
