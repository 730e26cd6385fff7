"""The pressers of a prairie: their entities, their walks, and what grass feels of them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import compress
from math import ceil, floor, pi
from typing import Annotated

import moderngl
import numpy as np
from pydantic import Field

from ..components.arrays import Doubles, Floats
from ..components.declaration import Declaration, Number
from ..components.pose import Pose
from ..components.presser import Presser
from ..engine.declared.presser import PresserOnPath
from ..engine.declared.way import Waypoint
from ..engine.handed import as_places_of, is_somewhere
from ..engine.stored import AS_FIELDS, Stored, Time
from .around.outlook import Outlook
from .frame.block import FrameBlock
from .frame.feature import Feature, Start
from .press.card import PressPart
from .press.lie import combined_message, pressed, recoveries, touches
from .press.marks import UNTRODDEN, Memory, Trodden
from .press.trail import COLUMNS, FIRST_OF_SCENE, Stretches, Trail
from .press.walk import EntityPresser, Walk, WalkState, staying
from .space.grown import Grown
from .wearing import Wearing
from .wind.blow import ReceiverArrays

REMEMBERED = 2.0
"""Time for which marks are remembered, as a multiple of the grass's recovery time: they affect later marks."""

RATE = 30
"""Number of instants a second at which the poses of the scene's pressers are sampled; between them they go straight."""

EVERY = 60.0
"""Interval at which the scene's pressers begin new stretches [s]: a replay starts there, and skips forgotten ones."""


class Treading(Declaration):
    """State of all pressers and their marks, to continue from."""

    walks: tuple[WalkState, WalkState]
    """Walk of the scene's pressers, whose entities are -1, -2 and so on in its order; and walk of a game's own."""

    kept: Annotated[Stretches, Stored(np.float64, None, COLUMNS)]
    """Marks that have settled."""

    since: Annotated[float, Field(ge=-1.0, le=1e9)]
    """Time at which marks settled last [s]."""

    trodden: Time | None
    """Time of the marks trodden last [s]; None if there are none."""

    anew: bool
    """Whether the whole way of the scene's pressers is still to be replayed."""

    declared: list[Annotated[Presser, AS_FIELDS] | None]
    """Component of each of the scene's pressers; None for one that a game has deleted."""

    worn: dict[int, tuple[Number, Number]]
    """Place (x, z) [m] up to which the way of each of a game's pressers is worn, by its entity."""


class Pressers(Feature):
    """The entities of one world that have a `Presser` and a `Pose`, and what they have trodden.

    The pressers that a scene declares are entities too, and move from time 0 on: their marks do not depend on when
    pictures are drawn, nor on when the scene was read.
    """

    samplers = ("pressed",)

    def __init__(self, start: Start, /) -> None:
        self._world, self._grown, self._wearing = start.world, start.grown, Wearing()
        self._generation = start.world.generation
        self._declared: dict[int, PresserOnPath] = {}
        """The scene's pressers by their entities, in its order."""
        self._scene_walk, self._game_walk = _walk_of_scene(), Walk(Trail())
        """Walks of the scene's pressers, and of a game's own."""
        self._memory = Memory([self._scene_walk.trail, self._game_walk.trail])
        self._is_anew = True
        """Whether the whole way of the scene's pressers is still to be replayed."""
        self.trodden = UNTRODDEN
        """All marks so far."""
        self.settle(start.grown, start.grown, time=0.0)

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Take over a scene's kinds of grass and pressers, at first or when it was read again.

        If the pressers or the time that grass remembers have changed, all their marks are trodden again.
        """
        self.recovery: Floats = recoveries(grown.scene)
        swings = [growth.response.step * len(growth.response.fall) for growth in grown.growths]
        lasts = REMEMBERED * max(float(self.recovery.max()), *swings)
        self._grown = grown
        if before.scene.pressers != grown.scene.pressers or lasts != self._memory.lasts:
            self._memory.lasts = lasts
            self._declare(grown.scene.pressers)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> PressPart:
        """Return the part that uploads marks for passes over receivers."""
        return PressPart(ctx, units["pressed"])

    def note(self, time: float) -> Trodden:
        """Move all pressers to their poses at `time` [s], and return what has been trodden."""
        self._place_declared(time)
        found = self._world.both(Presser, Pose)
        if len(found) < len(self._world.rows(Presser)):
            self._log_without_pose()
        if not found and not self._scene_walk.pressers and not self._game_walk.pressers and not self.trodden:
            return self.trodden
        wearing = [row for row in found if row[1].wear and row[0] not in self._declared and is_somewhere(row[2])]
        self._wearing.go(wearing, self._grown.ground.density, elapsed=time - self._game_walk.time)
        pressers, poses = self._posed(found)
        is_declared = np.array([entity in self._declared for entity, _ in pressers], np.bool_)
        own, declared = ([*compress(pressers, which)] for which in (~is_declared, is_declared))
        is_new = self._game_walk.move(own, poses[~is_declared], time)
        if self._walk_declared(declared, poses[is_declared], time) or is_new:
            self.trodden = self._memory.at(time)
        return self.trodden

    def _log_without_pose(self) -> None:
        """Log the pressers that have no pose, each once."""
        bare = (entity for entity, _ in self._world.all(Presser) if self._world.find(entity, Pose) is None)
        self._world.standing([(entity, None) for entity in bare], "the presser")

    def _posed(self, found: list[tuple[int, Presser, Pose]]) -> tuple[list[EntityPresser], Doubles]:
        """Return the pressers whose pose is finite, and their poses (x, z, yaw), shape (n, 3)."""
        poses = as_places_of(pose for _, _, pose in found)
        if poses is None:
            is_posed = self._world.standing([(entity, pose) for entity, _, pose in found], "the presser")
            found = [*compress(found, is_posed)]
            poses = _pose_rows([pose for _, _, pose in found])
        return [row[:2] for row in found], poses

    def go_back(self) -> None:
        """Forget all marks, as time goes back: the scene's pressers will be replayed."""
        self._game_walk, self.trodden, self._wearing = Walk(Trail()), UNTRODDEN, Wearing()
        self._memory = Memory([self._scene_walk.trail, self._game_walk.trail], self._memory.lasts)
        self._begin_anew()

    def games(self) -> list[tuple[int, Presser, Pose]]:
        """Return a game's own pressers whose pose is finite: entity, presser and pose."""
        every = self._world.both(Presser, Pose)
        return [row for row in every if row[0] not in self._declared and is_somewhere(row[2])]

    @property
    def declared(self) -> list[int]:
        """Entities of the scene's pressers, in its order; a game may have deleted some."""
        return [*self._declared]

    def treading(self) -> Treading:
        """Return the present state, for `resume`."""
        numbers = {entity: -1 - number for number, entity in enumerate(self._declared)}
        scenes, games = self._scene_walk.state(), self._game_walk.state()
        numbered = [(numbers[entity], presser) for entity, presser in scenes.pressers]
        there = dict(self._world.all(Presser))
        return Treading(
            walks=(scenes.model_copy(update={"pressers": numbered}), games), kept=self._memory.kept,
            since=self._memory.since, trodden=self.trodden.time if self.trodden else None, anew=self._is_anew,
            declared=[there.get(entity) for entity in self._declared], worn=self._wearing.worn,
        )  # fmt: skip

    def begun_anew(self, treading: Treading) -> Treading:
        """Return a state in which the scene's pressers are as it declares them, and their ways still to be replayed."""
        declared, walks = [path.footprint() for path in self._grown.scene.pressers], treading.walks
        anew = {"declared": declared, "walks": (_walk_of_scene().state(), walks[1]), "anew": True}
        return treading.model_copy(update=anew)

    def resume(self, treading: Treading, entities: Mapping[int, int]) -> None:
        """Continue from a state of the same scene; `entities` maps the game's entities in it to those of now."""
        self._wearing = Wearing({entities.get(entity, entity): place for entity, place in treading.worn.items()})
        self._place_declared(0.0)  # so that the scene's pressers have entities, even if the world was cleared
        declared = dict[int, PresserOnPath]()
        for (entity, path), presser in zip(self._declared.items(), treading.declared, strict=True):
            is_there, now = self._world.has(entity), entity
            if presser is None and is_there:
                self._world.delete(entity)
            elif presser is not None:
                now = entity if is_there else self._world.create(path.pose(time=0.0))
                self._world.add(now, presser)
            declared[now] = path
        self._declared, numbers = declared, [*declared]
        self._scene_walk, self._game_walk = _walk_of_scene(), Walk(Trail())
        scenes, games = treading.walks
        self._scene_walk.resume(scenes, [(numbers[-1 - number], presser) for number, presser in scenes.pressers])
        self._game_walk.resume(games, [(entities.get(entity, entity), presser) for entity, presser in games.pressers])
        self._memory = Memory([self._scene_walk.trail, self._game_walk.trail], self._memory.lasts)
        self._memory.resume(treading.kept, treading.since)
        self._is_anew = treading.anew
        self.trodden = UNTRODDEN if treading.trodden is None else self._memory.at(treading.trodden)

    def over(self, message: Floats, receivers: ReceiverArrays, /) -> Floats:
        """Lay the messages of pressers over the wind's messages (n, 2) to receivers, in place, and return these.

        Receivers without small oscillations stand for whole patches: their messages stay as they are.
        """
        moving = len(message) - receivers.still
        place = receivers.place[:moving]
        if not any(touches(marks, place) for marks in (self.trodden.settled, self.trodden.fresh)):
            return message
        grass = receivers.grass.at(np.arange(moving))
        message[:moving] = combined_message(message[:moving], pressed(self.trodden, place, grass, self.recovery))
        return message

    def _declare(self, pressers: Sequence[PresserOnPath]) -> None:
        """Make a scene's pressers entities, and begin their walk anew; an unchanged presser keeps its entity."""
        left = dict(self._declared)
        self._declared = {}
        for declared in pressers:
            entity = next((entity for entity, other in left.items() if other == declared), None)
            if entity is None:
                entity = self._world.create(declared.footprint(), declared.pose(time=0.0))
            left.pop(entity, None)
            self._declared[entity] = declared
        for entity in left:
            if self._world.has(entity):
                self._world.delete(entity)
        self._begin_anew()

    def _begin_anew(self) -> None:
        self._scene_walk, self._is_anew = _walk_of_scene(), True
        self._memory.replace(self._scene_walk.trail)

    def _place_declared(self, time: float) -> None:
        """Put the scene's pressers at their poses of `time` [s]; those that a game has deleted stay away."""
        if not self._grown.scene.pressers:
            return
        if self._generation != self._world.check():
            self._declared = {}  # other entities may have their numbers by now
            self._declare(self._grown.scene.pressers)
            self._generation = self._world.generation
        for entity, declared in self._declared.items():
            if self._world.find(entity, Presser) is not None:
                self._world.add(entity, _pose_at(declared, time))

    def _walk_declared(self, pressers: list[EntityPresser], poses: Doubles, time: float) -> bool:
        """Move the scene's pressers along their paths to their `poses` (n, 3) at `time` [s].

        Their poses are sampled at all instants since the last call. Instants before all paths begin and after all have
        ended are skipped. Returns whether anything is new.
        """
        if time - self._scene_walk.time > self._memory.lasts + EVERY:
            self._begin_anew()  # what they trod before is forgotten
        walk, is_anew = self._scene_walk, self._is_anew
        if is_anew:
            declared = [self._declared[entity] for entity, _ in pressers]
            for number in _replay_instants(declared, _replay_start(declared, floor(time) - self._memory.lasts)):
                walk.move(pressers, self._poses_at(pressers, number / RATE), number / RATE)
            self._is_anew = False
        stay = staying(walk.pressers, pressers)
        for number in _instants([self._declared[entity].path for entity, _ in stay], walk.time, time):
            walk.move(stay, self._poses_at(stay, number / RATE), number / RATE)
        return walk.move(pressers, poses, time) or is_anew

    def _poses_at(self, pressers: list[EntityPresser], time: float) -> Doubles:
        """Return the poses (x, z, yaw) of some of the scene's pressers at `time` [s], shape (n, 3)."""
        return _pose_rows([self._declared[entity].pose(time=time) for entity, _ in pressers])


def _walk_of_scene() -> Walk:
    return Walk(Trail(begun=FIRST_OF_SCENE, every=EVERY))


def _pose_rows(poses: Sequence[Pose]) -> Doubles:
    return np.array([(pose.x, pose.z, pose.yaw) for pose in poses], np.float64).reshape(-1, 3)


def _replay_start(pressers: Sequence[PresserOnPath], latest: float) -> float:
    """Return the latest time [s] from which a replay of all paths leaves the same marks after `latest` [s].

    It is a multiple of `EVERY` at which each presser moves, has not set out yet, or has arrived.
    """

    def is_possible(presser: PresserOnPath, then: float) -> bool:
        return _can_begin(presser, then) or presser.path[-1].at <= then

    starts = (EVERY * number for number in range(floor(latest / EVERY), 0, -1))
    return next((then for then in starts if all(is_possible(presser, then) for presser in pressers)), 0.0)


def _replay_instants(pressers: Sequence[PresserOnPath], start: float) -> list[int]:
    """Return the numbers of the instants up to `start` [s] that a replay samples, in ascending order.

    For pressers that have arrived by then, it samples the end of their path, from a multiple of `EVERY` on.
    """
    numbers = {round(start * RATE)}
    for presser in pressers:
        if not _can_begin(presser, start):
            arrived = presser.path[-1].at
            since = next(then for then in range(floor(arrived / EVERY), -1, -1) if _can_begin(presser, EVERY * then))
            numbers |= {*range(round(EVERY * since * RATE), ceil(arrived * RATE) + 1)}
    return sorted(numbers)


def _can_begin(presser: PresserOnPath, then: float) -> bool:
    """Return whether a replay from `then` [s] leaves the same later marks: if the presser moves, or has not set out."""
    if not presser.path or then <= presser.path[0].at:
        return True
    here, there = presser.pose(time=then), presser.pose(time=then + 1.0 / RATE)
    return (here.x, here.z) != (there.x, there.z)


def _instants(paths: Sequence[Sequence[Waypoint]], since: float, until: float) -> range:
    """Return the numbers of the instants between `since` and `until` [s], excluded, at which a presser may move."""
    moving = [path for path in paths if path]
    if not moving:
        return range(0)
    first = floor(min(path[0].at for path in moving) * RATE)
    last = ceil(max(path[-1].at for path in moving) * RATE)
    return range(max(floor(since * RATE) + 1, first), min(ceil(until * RATE), last + 1))


def _pose_at(declared: PresserOnPath, time: float) -> Pose:
    """Return the pose of a presser at `time` [s], interpolated between the two instants around it."""
    before, after = (declared.pose(time=at / RATE) for at in (floor(time * RATE), ceil(time * RATE)))
    fraction = time * RATE - floor(time * RATE)
    turned = (after.yaw - before.yaw + pi) % (2.0 * pi) - pi
    return Pose(
        before.x + fraction * (after.x - before.x),
        before.z + fraction * (after.z - before.z),
        before.yaw + fraction * turned,
    )


@dataclass(slots=True)
class Press:
    """The system `press`: notes what has been trodden so far."""

    outlooks: Iterable[Outlook]
    note: Callable[[float], Trodden]
    """Moves all pressers to a time [s], and returns what has been trodden."""

    def run(self) -> None:
        """Press for every viewer that looks."""
        for outlook in self.outlooks:
            outlook.note(self.note(outlook.viewer.time))
