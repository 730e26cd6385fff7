"""The entities of one prairie, inside whatever esper world is current: the only module that imports esper."""

import gc
import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import count
from operator import itemgetter
from typing import TypeVar
from weakref import WeakSet, ref

import esper

from ..components.pose import Pose
from ..components.resident import Resident
from .handed import NUMBERS, SOMEWHERE, is_somewhere

Component = TypeVar("Component")
Other = TypeVar("Other")

PRIORITY = 100
"""Priority of the processor that `install` adds. A game's own of lower numbers, 0 without more, run after it."""

log = logging.getLogger("tallgrass")

_worlds: WeakSet["World"] = WeakSet()
_private = count()


class Residents:
    """The entities of one prairie, and which of them somebody else has deleted."""

    __slots__ = ("lost", "marks")

    def __init__(self) -> None:
        self.marks: dict[int, int] = {}
        """By entity, what tells its mark from that of another of the same number."""
        self.lost: list[int] = []

    def note_gone(self, resident: Resident, /) -> None:
        """Take note that an entity has been deleted, unless its number is another one's by now."""
        if self.marks.get(resident.entity) == id(resident):
            del self.marks[resident.entity]
            self.lost.append(resident.entity)


class World:
    """A prairie's own entities among a game's.

    It lives in the world that was current when it was made, as a guest, and `release` removes exactly what it created.
    Worlds number their entities alike, so while the game has another world current, everything but `release` raises
    RuntimeError. `advance` is what the processor of `install` calls with each step of time [s].
    """

    def __init__(self, advance: Callable[[float], None] | None = None) -> None:
        self.name = esper.current_world
        self.advance = advance
        self.generation = 0
        """How often everything of ours was deleted at once, as by `esper.clear_database`."""
        self._home: ref[Resident] | None = None
        self._mine = Residents()
        self._told: set[int] = set()
        """Entities of which it was said that their pose is nowhere."""
        _worlds.add(self)

    def create(self, *components: object) -> int:
        """Return a new entity that has `components`."""
        self._must_be_current()
        self.check()
        if self._home is None:  # an entity that nobody has a reason to delete: it goes when all go
            home = Resident(self._mine)
            self._home = ref(home)
            esper.create_entity(home)
        mark = Resident(self._mine)
        mark.entity = entity = esper.create_entity(*components, mark)
        self._mine.marks[entity] = id(mark)
        return entity

    def give(self, *components: object) -> int:
        """Return a new entity of the game's own that has `components`: it outlives the prairie."""
        self._must_be_current()
        return esper.create_entity(*components)

    def check(self) -> int:
        """Return `generation`, raised if the whole world was cleared since this was asked before."""
        if self._home is not None and self._home() is None:
            self._home = None
            self._mine.lost.clear()
            self.generation += 1
        return self.generation

    def lost(self) -> list[int]:
        """Return the entities of ours that somebody has deleted one by one since this was asked before."""
        self.check()
        lost = self._mine.lost.copy()
        self._mine.lost.clear()
        return lost

    def delete(self, entity: int) -> None:
        """Delete an entity of ours at once; one that the game has deleted already is no error."""
        self._must_be_current()
        self._mine.marks.pop(entity, None)
        if self.has(entity):
            esper.delete_entity(entity, immediate=True)

    def has(self, entity: int) -> bool:
        """Return whether an entity of ours is there; one that the game has deleted is not, even if esper waits."""
        self._must_be_current()
        # A game that clears its world counts entities from 1 again: the number alone does not say whose one is.
        return esper.entity_exists(entity) and self._owner(entity) is self._mine

    def add(self, entity: int, component: object) -> None:
        """Give an entity a component, in place of one of the same type."""
        self._must_be_current()
        esper.add_component(entity, component)

    def drop(self, entity: int, kind: type[object]) -> None:
        """Take an entity's component of exactly this type away, if it has one."""
        self._must_be_current()
        if esper.has_component(entity, kind):
            esper.remove_component(entity, kind)

    def uproot(self, entity: int, kind: type[object]) -> None:
        """Take an entity's component of exactly this type away, and the entity where it has nothing but a pose left."""
        self.drop(entity, kind)
        left: tuple[object, ...] = esper.components_for_entity(entity)
        if all(isinstance(each, Pose | Resident) for each in left):
            self._mine.marks.pop(entity, None)
            esper.delete_entity(entity, immediate=True)

    def get(self, entity: int, kind: type[Component]) -> Component:
        """Return an entity's component of exactly this type; KeyError if it has none."""
        self._must_be_current()
        return esper.component_for_entity(entity, kind)

    def find(self, entity: int, kind: type[Component]) -> Component | None:
        """Return an entity's component of exactly this type, None if it has none."""
        self._must_be_current()
        return esper.try_component(entity, kind)

    def all(self, kind: type[Component]) -> list[tuple[int, Component]]:
        """Return every entity with a component of exactly this type, by rising entity number.

        The game's own entities are among them, those of other prairies in the same world are not. The order is fixed
        so that nothing that follows from it depends on how a set is laid out.
        """
        self._must_be_current()
        rows = esper.get_component(kind)
        if not rows:
            return []
        mine, part_of, found = self._mine, esper.try_component, list[tuple[int, Component]]()
        for row in rows:
            mark = part_of(row[0], Resident)
            if mark is None or mark.owner is mine:  # the game's, and our own
                found.append(row)
        return sorted(found, key=itemgetter(0))

    def rows(self, kind: type[Component]) -> list[tuple[int, Component]]:
        """Return every entity with a component of exactly this type, in any order and whosever it is.

        It is quick: who keeps it sees by comparing it whether any of them has become another. But it is made anew
        whenever any entity comes or goes: many are to be exchanged `uncollected`.
        """
        self._must_be_current()
        return esper.get_component(kind)

    def both(self, kind: type[Component], other: type[Other]) -> list[tuple[int, Component, Other]]:
        """Return every entity with components of exactly these two types, in the order and as far as `all` does."""
        self._must_be_current()
        rows = esper.get_component(kind)
        if not rows:
            return []
        mine, part_of, found = self._mine, esper.try_component, list[tuple[int, Component, Other]]()
        for entity, one in rows:
            two, mark = part_of(entity, other), part_of(entity, Resident)
            if two is not None and (mark is None or mark.owner is mine):
                found.append((entity, one, two))
        return sorted(found, key=itemgetter(0))

    def stands(self, entity: int, pose: Pose | None, what: str) -> bool:
        """Return whether an entity has a pose that is somewhere; where not, say once `what` is left out meanwhile."""
        return self.standing([(entity, pose)], what)[0]

    def standing(self, poses: Sequence[tuple[int, Pose | None]], what: str) -> list[bool]:
        """Return the same of several entities; one sentence tells of all that are left out since now."""
        stand = [pose is not None and is_somewhere(pose) for _, pose in poses]
        lost = [one for one, there in zip(poses, stand, strict=True) if not there and one[0] not in self._told]
        if lost:
            self._told.update(entity for entity, _ in lost)
            (entity, pose), more = lost[0], f", and {len(lost) - 1} more likewise" if len(lost) > 1 else ""
            have = pose or "no Pose"
            log.warning("%s of entity %d is left out while it has %s%s: %s", what, entity, have, more, SOMEWHERE)
        return stand

    def _owner(self, entity: int) -> object | None:
        mark = esper.try_component(entity, Resident)
        return None if mark is None else mark.owner

    def __contains__(self, entity: object) -> bool:
        return entity in self._mine.marks

    def __len__(self) -> int:
        return len(self._mine.marks)

    def release(self) -> None:
        """Delete every entity created here that still exists, and with the world's last prairie its processor.

        Where the game has another world current, this one is made current for that moment.
        """
        if self.name in esper.list_worlds():
            with _current(self.name):
                for entity in list(self._mine.marks):
                    self.delete(entity)
                for entity, mark in esper.get_component(Resident):
                    if mark.owner is self._mine:
                        esper.delete_entity(entity, immediate=True)
                if not _residents(self.name, but=self) and self in _worlds:
                    esper.remove_processor(Advance)
        self._mine.marks.clear()
        self._home = None
        self.advance = None
        _worlds.discard(self)

    def come_back(self) -> str:
        """Make this world current again where somebody left another one so; return which, in words, or nothing."""
        left = esper.current_world
        if left == self.name or self.name not in esper.list_worlds():
            return ""
        esper.switch_world(self.name)
        return f"run left esper world '{left}' current in place of '{self.name}'"

    def _must_be_current(self) -> None:
        if esper.current_world != self.name:
            if self.name not in esper.list_worlds():
                raise RuntimeError(f"esper world '{self.name}', where this prairie lived, was deleted: load it again")
            raise RuntimeError(
                f"this prairie lives in esper world '{self.name}', but '{esper.current_world}' is current"
            )


class Advance(esper.Processor):
    """Moves the time of every prairie in its world on; `install` adds it."""

    def process(self, dt: object = None, *args: object, **options: object) -> None:
        """Advance by `dt` [s]; without it, time stands still. What else a game hands its processors is left alone."""
        del args, options
        if dt is None:
            return
        if not isinstance(dt, NUMBERS):
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


def _residents(name: str, *, but: World | None = None) -> list[World]:
    return [world for world in _worlds if world.name == name and world is not but]


@contextmanager
def _current(name: str) -> Iterator[None]:
    """Make another of the game's worlds current for a moment.

    Meanwhile nothing is collected: a handler of the game's that went now would leave its reference in its world.
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
    """Let Python's collector rest meanwhile: what is made and let go again by then never sets it off."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


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
