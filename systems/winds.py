"""The winds of a prairie: their entities, their poses, and their messages."""

import logging
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import count
from math import inf
from reprlib import repr as shortened

import numpy as np

from ..components.arrays import Floats
from ..components.pose import Pose
from ..components.wind import WindPrimitive, WindSource, must_be_name, must_be_wind, on_course
from ..engine.handed import SOMEWHERE, is_somewhere
from ..engine.plugins import wind_kinds
from ..engine.terrain.sample import height_at
from .bodies.fly import foot, hover_of, hovering
from .frame.feature import Feature, Start
from .space.ground import densest_kind
from .space.grown import Grown
from .wind.blow import Blowing, ReceiverArrays, blowing, hear, lone_receivers, mean_index, mean_yaw
from .wind.card import SAMPLERS
from .wind.grass import grass_of
from .wind.quarantine import QuarantinedError

log = logging.getLogger("tallgrass")


KEPT = 60.0
"""Time for which an added wind is kept after its end [s], for questions about an earlier time."""


@dataclass(frozen=True, slots=True)
class _Record:
    """A wind's entity as it was in the last frame."""

    source: WindSource

    wind: WindPrimitive
    """The source's primitive, with the course of its phases."""

    end: float
    """Time at which it is over for good [s]."""


class Winds(Feature):
    """All winds in one world: a scene's, those that a game adds, and a game's own entities."""

    pass_samplers = SAMPLERS

    def __init__(self, start: Start, /) -> None:
        self._world = start.world
        self._generation = start.world.generation
        self._declared: list[int] = []
        self._added: dict[int, int] = {}
        """Generation of the world in which each wind was added, by its handle."""
        self.quarantine = start.quarantine
        self._clock = 0.0
        self._records: dict[int, _Record] = {}
        self.change(start.grown)

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Take over another site: its winds too, unless they and the ground are the same objects."""
        if grown.scene.wind is before.scene.wind and grown.ground is before.ground:
            self._grown = grown
        else:
            self.change(grown)

    def change(self, grown: Grown, /) -> None:
        """Take over the winds that a scene declares, at first or when it was read again.

        An unchanged wind keeps its entity and its random numbers. A changed wind keeps its name, which gives it the
        same random numbers. Winds that a game added are not touched.
        """
        self._grown = grown
        there = dict(self._world.all(WindSource))
        before = {entity: there[entity] for entity in self._declared if entity in there}
        after = matched(list(before.values()), grown.scene.wind)
        entities = {source: entity for entity, source in before.items()}
        self._declared = [self._declare(source, old, entities) for source, old in after]
        for entity in set(before) - set(self._declared):
            self._world.delete(entity)

    def _declare(self, source: WindSource, old: WindSource | None, entities: dict[WindSource, int]) -> int:
        """Return the entity of a declared wind: a new one, or that of the `old` wind, which it replaces."""
        if old is None:
            return self._world.create(source)
        if source is not old:
            self._world.add(entities[old], source)
        return entities[old]

    def add(self, primitive: WindPrimitive, name: str | None = None, pose: Pose | None = None) -> int:
        """Add a game's wind and return its entity; its default name is its kind.

        Raises TypeError for anything but a wind, a name and a pose, ValueError for a pose that is not finite.
        """
        must_be_wind(primitive, "add takes")
        if name is not None:
            must_be_name(name)
        if pose is not None:
            _must_be_pose(pose)
        entity = self._world.create(WindSource(primitive, name or primitive.kind), *([pose] if pose else []))
        self._added[entity] = self._world.check()
        return entity

    def move(self, handle: int, pose: Pose) -> None:
        """Move an added wind to a pose.

        Raises TypeError for anything but a handle and a pose, ValueError for an unknown handle, for a pose that is not
        finite, and for a wind that is over or that a game has deleted.
        """
        _must_be_pose(pose)
        if not self._is_there(handle):
            raise ValueError(f"wind {handle} is over, or the game has deleted its entity: add it again to move it")
        self._world.add(handle, pose)

    def remove(self, handle: int) -> None:
        """Remove an added wind; the game may have deleted it already.

        Raises TypeError for anything but a handle, ValueError for an unknown one.
        """
        if self._is_there(handle):
            self._world.delete(handle)
        del self._added[handle]

    def _is_there(self, handle: object) -> bool:
        """Return whether an added wind still exists; raises TypeError and ValueError for anything but its handle."""
        if not isinstance(handle, int | np.integer):
            raise TypeError(f"winds are moved and removed by the handle that add returned, not by {shortened(handle)}")
        if handle not in self._added:
            raise ValueError(f"no wind has the handle {handle}: it was removed before, or add never returned it")
        entity, generation = int(handle), self._added[int(handle)]
        if generation != self._world.check() or not self._world.has(entity):
            return False
        return self._world.find(entity, WindSource) is not None

    def set_clock(self, time: float) -> None:
        """Set the prairie's clock to `time` [s], at which a game's next changes of winds take effect."""
        self._clock = time
        self.quarantine.let_back(time)

    @property
    def declared(self) -> list[int]:
        """Entities of the winds that the scene declares, in its order; a game may have deleted some."""
        return [*self._declared]

    @property
    def added(self) -> list[int]:
        """Entities of the added winds that still exist."""
        return [entity for entity in self._added if self._is_there(entity)]

    def runs(self) -> dict[int, WindPrimitive]:
        """Return the winds whose rates a game has changed, with the courses of their phases, by entity."""
        self._ongoing(self._clock)
        return {entity: record.wind for entity, record in self._records.items() if record.wind.course is not None}

    def resume(self, declared: Sequence[int], added: Sequence[int], runs: Mapping[int, WindPrimitive]) -> None:
        """Take over entities as the scene's declared winds and a game's added winds.

        `runs` are the winds, by entity, whose rates a game has changed, with the courses of their phases.
        """
        generation = self._world.check()
        self._declared, self._added = [*declared], dict.fromkeys(added, generation)
        there = dict(self._world.all(WindSource))
        self._records = {
            entity: replace(self._record_of(there[entity], None), wind=wind) for entity, wind in runs.items()
        }

    def sources(self) -> list[WindSource]:
        """Return all winds."""
        self._revive()
        return [source for _, source in self._world.all(WindSource)]

    def samples(self) -> list[WindPrimitive]:
        """Return all winds, and one of each installed kind whose fields all have defaults."""
        found = [source.primitive for source in self.sources()]
        for name in wind_kinds().names():
            try:
                found.append(wind_kinds().find(name)(kind=name))
            except (Exception, SystemExit) as error:  # a plugin may raise anything, or ask for a field
                log.debug("kind '%s' is not prepared", name, exc_info=error)
        return found

    def acting(self, time: float) -> list[Blowing]:
        """Return the winds that act at `time` [s], the strongest claim first.

        A wind is at the `Pose` of its entity, if it has one; else where the jet of its hovering body meets the ground,
        if it has one; else at its own pose.
        """
        grown, top_at = self._grown, self._grown.top_at
        sources, poses, winds = list[WindSource](), list[Pose | None](), list[WindPrimitive]()
        for entity, record in self._ongoing(time):
            source, pose = record.source, self._world.find(entity, Pose)
            if pose is not None and not self._world.stands(entity, pose, "the wind"):
                continue
            with suppress(QuarantinedError):
                if pose is not None:
                    hover_of(source, self.quarantine)  # if it fails, the wind is left out of this frame already
                elif (body := hovering(source, top_at, self.quarantine, time=time)) is not None:
                    pose = foot(body, partial(height_at, grown.ground.terrain))
            sources.append(source)
            poses.append(pose)
            winds.append(record.wind)
        return blowing(sources, self.quarantine, time=time, seed=grown.scene.seed, poses=poses, winds=winds)

    def _ongoing(self, time: float) -> list[tuple[int, _Record]]:
        """Return the winds that are not over at `time` [s], after noting what a game has changed.

        Added winds are deleted `KEPT` seconds after their end.
        """
        self._revive()
        found, records = self._world.all(WindSource), self._records
        if len(records) > len(found):
            there = {entity for entity, _ in found}
            self._records = records = {entity: record for entity, record in records.items() if entity in there}
        ongoing: list[tuple[int, _Record]] = []
        for entity, source in found:
            if entity not in records or records[entity].source is not source:
                records[entity] = self._record_of(source, records.get(entity))
            record = records[entity]
            if time < record.end:
                ongoing.append((entity, record))
            elif record.end + KEPT < self._clock and self._added.get(entity) == self._generation:
                self._world.delete(entity)
        return ongoing

    def _record_of(self, source: WindSource, before: _Record | None) -> _Record:
        """Return the new record of a source; `before` is the last one of the same entity."""
        wind = source.primitive
        try:
            last = before.wind if before is not None and type(before.wind) is type(wind) else None
            go_on = (lambda: wind) if last is None else partial(on_course, wind, last, time=self._clock)
            wind = self.quarantine.ask_rates(source, go_on)
            end = self.quarantine.ask_end(source, wind.ends)
        except QuarantinedError:
            return _Record(source, wind, inf)
        return _Record(source, wind, end)

    def bent(self, time: float) -> float:
        """Return the mean posture index to which the winds bend grass everywhere at `time` [s]."""
        return mean_index([record.source for _, record in self._ongoing(time)], self.quarantine, time=time)

    def messages_to(self, receivers: ReceiverArrays, /, *, time: float) -> Floats:
        """Return the messages (n, 2) of all winds together to receivers at `time` [s]."""
        scene, acting = self._grown.scene, self.acting(time)
        yaw = mean_yaw(scene.wind)
        return hear(acting, receivers, self.quarantine, time=time, seed=scene.seed, mixing=scene.mixing, yaw=yaw)

    def messages_at(self, place: Floats, /, *, time: float, kind: int | None = None) -> Floats:
        """Return the messages (n, 2) at ground positions (n, 2) [m] to a kind of grass, or to the densest there."""
        return self.messages_to(self.receivers_at(place, kind=kind), time=time)

    def receivers_at(self, place: Floats, /, *, kind: int | None) -> ReceiverArrays:
        """Return receivers of a kind of grass, or of the densest there, at ground positions (n, 2) [m]."""
        kinds = densest_kind(self._grown.ground.density, place) if kind is None else np.full(len(place), kind, np.intp)
        return lone_receivers(place, grass_of(self._grown.growths, kinds))

    def _revive(self) -> None:
        """Make the scene's winds entities again after the game has cleared its world, and log that once."""
        if self._generation == self._world.check():
            return
        self._declared, self._records = [], {}  # other entities may have their numbers by now
        self.change(self._grown)  # raises if the world is gone, or another is current
        self._generation = self._world.generation
        log.warning("the esper world was cleared: what the scene declares is there again, added winds are gone")


def matched(
    before: Sequence[WindSource], winds: Sequence[WindPrimitive], /
) -> list[tuple[WindSource, WindSource | None]]:
    """Return the source of each of a scene's winds, and the source `before` that it replaces, if any.

    A wind with the same values keeps its source, wherever in the scene it stands now. Each other wind takes the name of
    the source of its kind with which it has most values in common, or a new name.
    """
    left = list(before)
    found: dict[int, WindSource] = {}
    for least in (inf, 0.0):
        for number, wind in enumerate(winds):
            alike = [source for source in left if _likeness(source.primitive, wind) >= least]
            if number not in found and alike:
                found[number] = max(alike, key=lambda source: _likeness(source.primitive, wind))
                left.remove(found[number])
    taken = {source.name for source in found.values()}
    rows: list[tuple[WindSource, WindSource | None]] = []
    for number, wind in enumerate(winds):
        old = found.get(number)
        name = old.name if old else next(name for k in count(number) if (name := f"wind[{k}] {wind.kind}") not in taken)
        taken.add(name)
        same = old is not None and _likeness(old.primitive, wind) == inf
        rows.append((old if old and same else WindSource(wind, name), old))
    return rows


def _must_be_pose(thing: object) -> None:
    if not isinstance(thing, Pose):
        raise TypeError(f"a wind is put at a Pose such as Pose(x=3.0, z=-5.0), not at {shortened(thing)}")
    if not is_somewhere(thing):
        raise ValueError(f"a wind is put where {SOMEWHERE}, not at {thing}")


def _likeness(one: WindPrimitive, other: WindPrimitive) -> float:
    """Return the number of values that two winds have in common, infinity for equal winds, -1 for two kinds."""
    if type(one) is not type(other) or one.kind != other.kind:
        return -1.0
    try:
        if one == other:
            return inf
        return float(sum(bool(getattr(one, name) == getattr(other, name)) for name in type(one).model_fields))
    except Exception:  # noqa: BLE001 - a plugin's own values may compare as they like
        return 0.0
