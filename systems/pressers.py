"""The pressers of a prairie: whose entities they are, the ways they have come, and what grass feels of them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import compress
from math import ceil, floor, pi
from typing import Self

import moderngl
import numpy as np

from ..components.arrays import Doubles, Floats
from ..components.pose import Pose
from ..components.presser import Presser
from ..engine.declared.presser import PresserOnPath
from ..engine.declared.scene import Scene
from ..engine.declared.way import Waypoint
from ..engine.handed import as_places_of, is_somewhere
from ..engine.terrain.record import Density
from ..engine.world import World
from .around.outlook import Outlook
from .frame.block import FrameBlock
from .frame.feature import Feature, Start
from .grow.record import Growth
from .press.card import PressPart
from .press.lie import laid_over, pressed, recoveries, touches
from .press.marks import UNTRODDEN, Memory, Trodden
from .press.trail import SCENES, Stretches, Trail
from .press.walk import Stand, Walk, Who, staying
from .space.grown import Grown
from .wearing import Wearing
from .wind.blow import ReceiverArrays

REMEMBERED = 2.0
"""How long what was trodden is remembered, of how long grass takes to stand again: it counts for what comes next."""


RATE = 30
"""How often in a second those that a scene declares are asked where they are; between that they go straight."""


EVERY = 60.0
"""How often the ways of those that a scene declares begin new stretches [s]: what is forgotten is not gone again."""


@dataclass(frozen=True, slots=True, eq=False)
class Treading:
    """What pressers have done so far, to go on from."""

    walks: tuple[Stand, Stand]
    """Those that the scene declares, whose entities are -1, -2 and so on in its order; and a game's own."""

    kept: Stretches
    since: float
    """The marks that have settled, and when they did so last [s]."""

    trodden: float | None
    """The instant of what was trodden last [s], if anything was."""

    anew: bool
    """Whether those that the scene declares have their whole way still to go."""

    declared: list[Presser | None]
    """What those press with that the scene declares; None of one that a game has deleted."""


class Pressers(Feature):
    """The entities of one world that have a `Presser` and a `Pose`, and what they have trodden.

    Those that a scene declares are entities too, and go their ways from the beginning of time: what they have trodden
    does not depend on when pictures are drawn, nor on when the scene was read.
    """

    samplers = ("pressed",)

    def __init__(self, world: World, scene: Scene, growths: Sequence[Growth], density: Density) -> None:
        self._world, self._density, self._wearing = world, density, Wearing()
        self._generation = world.generation
        self._declared: dict[int, PresserOnPath] = {}
        self._scenes, self._games = Walk(Trail(begun=SCENES, every=EVERY)), Walk(Trail())
        """Those that the scene declares, and all others."""
        self._memory = Memory([self._scenes.trail, self._games.trail])
        self._is_anew = True
        """Whether those that the scene declares have their whole way still to go."""
        self._scene = scene
        self.trodden = UNTRODDEN
        """What has been trodden so far."""
        self.change(scene, growths)

    @classmethod
    def begin(cls, start: Start, /) -> Self:
        """Return those of a prairie's world."""
        return cls(start.world, start.grown.scene, start.grown.growths, start.grown.ground.density)

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Take over a scene that was read again."""
        del before, time
        self._density = grown.ground.density
        self.change(grown.scene, grown.growths)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> PressPart:
        """Return what they tread, for passes over receivers."""
        del block
        return PressPart(ctx, units["pressed"])

    def change(self, scene: Scene, growths: Sequence[Growth]) -> None:
        """Take over the kinds of grass of a scene, at first or when it was read again, and those who walk in it.

        If others walk in it or grass remembers for longer, all that it declares have trodden is trodden anew.
        """
        self.recovery: Floats = recoveries(scene)
        swings = [growth.response.step * len(growth.response.fall) for growth in growths]
        lasts, before = REMEMBERED * max(float(self.recovery.max()), *swings), self._scene
        self._scene = scene
        if before.pressers != scene.pressers or lasts != self._memory.lasts:
            self._memory.lasts = lasts
            self._declare(scene.pressers)

    def note(self, time: float) -> Trodden:
        """Take note of where all pressers are at `time` [s], and return what has been trodden."""
        self._go(time)
        found = self._world.both(Presser, Pose)
        if len(found) < len(self._world.rows(Presser)):
            self._miss()
        if not found and not self._scenes.who and not self._games.who and not self.trodden:
            return self.trodden
        wearing = [row for row in found if row[1].wear and row[0] not in self._declared and is_somewhere(row[2])]
        self._wearing.go(wearing, self._density)
        who, rows = self._standing(found)
        is_scenes = np.array([entity in self._declared for entity, _ in who], np.bool_)
        games, scenes = ([who[number] for number in np.flatnonzero(which)] for which in (~is_scenes, is_scenes))
        is_new = self._games.come(games, rows[~is_scenes], time)
        if self._come(scenes, rows[is_scenes], time) or is_new:
            self.trodden = self._memory.at(time)
        return self.trodden

    def _miss(self) -> None:
        """Say of whom nobody knows where they press."""
        every = (entity for entity, _ in self._world.all(Presser))
        self._world.standing([(each, None) for each in every if self._world.find(each, Pose) is None], "the presser")

    def _standing(self, found: list[tuple[int, Presser, Pose]]) -> tuple[list[Who], Doubles]:
        """Return who of those that press is anywhere, and where they are and look (x, z, yaw), shape (n, 3)."""
        rows = as_places_of(pose for _, _, pose in found)
        if rows is None:
            found = [*compress(found, self._world.standing([(who, pose) for who, _, pose in found], "the presser"))]
            rows = _rows([pose for _, _, pose in found])
        return [row[:2] for row in found], rows

    def go_back(self) -> None:
        """Forget what has been trodden, as time goes back: those that the scene declares tread it anew."""
        self._games, self.trodden, self._wearing = Walk(Trail()), UNTRODDEN, Wearing()
        self._memory = Memory([self._scenes.trail, self._games.trail], self._memory.lasts)
        self._begin_anew()

    def games(self) -> list[tuple[int, Presser, Pose]]:
        """Return a game's own pressers that are somewhere: their entities, and what these carry."""
        every = self._world.both(Presser, Pose)
        return [row for row in every if row[0] not in self._declared and is_somewhere(row[2])]

    @property
    def declared(self) -> list[int]:
        """The entities of those that the scene declares, in its order; a game may have deleted some."""
        return [*self._declared]

    def treading(self) -> Treading:
        """Return what has been done so far."""
        numbers = {entity: -1 - number for number, entity in enumerate(self._declared)}
        scenes, games = self._scenes.stand(), self._games.stand()
        scenes = replace(scenes, who=[(numbers[entity], presser) for entity, presser in scenes.who])
        there = dict(self._world.all(Presser))
        return Treading(
            (scenes, games), self._memory.kept, self._memory.since, self.trodden.time if self.trodden else None,
            self._is_anew, [there.get(entity) for entity in self._declared],
        )  # fmt: skip

    def resume(self, treading: Treading, entities: Mapping[int, int]) -> None:
        """Go on from what was done in a prairie of the same scene; `entities` are the game's own, by what they were."""
        self._wearing = Wearing()
        self._go(0.0)  # what the scene declares are entities, though the world was cleared
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
        self._scenes, self._games = Walk(Trail(begun=SCENES, every=EVERY)), Walk(Trail())
        scenes, games = treading.walks
        self._scenes.resume(scenes, [(numbers[-1 - number], presser) for number, presser in scenes.who])
        self._games.resume(games, [(entities.get(entity, entity), presser) for entity, presser in games.who])
        self._memory = Memory([self._scenes.trail, self._games.trail], self._memory.lasts)
        self._memory.resume(treading.kept, treading.since)
        self._is_anew = treading.anew
        self.trodden = UNTRODDEN if treading.trodden is None else self._memory.at(treading.trodden)

    def over(self, message: Floats, receivers: ReceiverArrays, /) -> Floats:
        """Return messages of the wind (n, 2) to receivers where grass is pressed as well, shape (n, 2).

        Those that are without the small oscillations stand for whole patches, and are left as they are.
        """
        moving = len(message) - receivers.still
        place = receivers.place[:moving]
        if not any(touches(marks, place) for marks in (self.trodden.settled, self.trodden.fresh)):
            return message
        grass = receivers.grass.at(np.arange(moving))
        message[:moving] = laid_over(message[:moving], pressed(self.trodden, place, grass, self.recovery))
        return message

    def _declare(self, pressers: Sequence[PresserOnPath]) -> None:
        """Let those be entities that a scene declares, and begin their walk anew; one that has not changed stays."""
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
        self._scenes, self._is_anew = Walk(Trail(begun=SCENES, every=EVERY)), True
        self._memory.replace(self._scenes.trail)

    def _go(self, time: float) -> None:
        """Put those that the scene declares where they are at `time` [s]; what a game has deleted stays away."""
        if not self._scene.pressers:
            return
        if self._generation != self._world.check():
            self._declared = {}  # their numbers may be others' by now
            self._declare(self._scene.pressers)
            self._generation = self._world.generation
        for entity, declared in self._declared.items():
            if self._world.find(entity, Presser) is not None:
                self._world.add(entity, _on_way(declared, time))

    def _come(self, who: list[Who], pose: Doubles, time: float) -> bool:
        """Let those that the scene declares go their ways to their poses (n, 3) of `time` [s].

        They are asked where they are at all instants since the last one. Nobody moves before all paths begin and after
        all have ended: these instants are left out. Returns whether anything is new.
        """
        if time - self._scenes.time > self._memory.lasts + EVERY:
            self._begin_anew()  # what they trod before is forgotten
        walk, is_anew = self._scenes, self._is_anew
        if is_anew:
            declared = [self._declared[entity] for entity, _ in who]
            for number in _lead(declared, _start(declared, floor(time) - self._memory.lasts)):
                walk.come(who, self._where(who, number / RATE), number / RATE)
            self._is_anew = False
        stay = staying(walk.who, who)
        for number in _instants([self._declared[entity].path for entity, _ in stay], walk.time, time):
            walk.come(stay, self._where(stay, number / RATE), number / RATE)
        return walk.come(who, pose, time) or is_anew

    def _where(self, who: list[Who], time: float) -> Doubles:
        """Return where the paths of some of those that the scene declares lead at `time` [s], shape (n, 3)."""
        return _rows([self._declared[entity].pose(time=time) for entity, _ in who])


def _rows(poses: Sequence[Pose]) -> Doubles:
    return np.array([(pose.x, pose.z, pose.yaw) for pose in poses], np.float64).reshape(-1, 3)


def _start(pressers: Sequence[PresserOnPath], latest: float) -> float:
    """Return the latest time [s] from which a replay of all pressers' ways treads the same after `latest` [s].

    It is a multiple of `EVERY` at which each of them is on its way, has not set out yet, or has arrived.
    """

    def may(presser: PresserOnPath, then: float) -> bool:
        return _is_due(presser, then) or presser.path[-1].at <= then

    starts = (EVERY * number for number in range(floor(latest / EVERY), 0, -1))
    return next((then for then in starts if all(may(presser, then) for presser in pressers)), 0.0)


def _lead(pressers: Sequence[PresserOnPath], start: float) -> list[int]:
    """Return the numbers of the instants up to `start` [s] at which pressers are asked, rising.

    Those that have arrived by then go the way that led them there, from where they were on it at a multiple of `EVERY`.
    """
    numbers = {round(start * RATE)}
    for presser in pressers:
        if not _is_due(presser, start):
            arrived = presser.path[-1].at
            since = next(then for then in range(floor(arrived / EVERY), -1, -1) if _is_due(presser, EVERY * then))
            numbers |= {*range(round(EVERY * since * RATE), ceil(arrived * RATE) + 1)}
    return sorted(numbers)


def _is_due(presser: PresserOnPath, then: float) -> bool:
    """Return whether a presser treads the same after `then` [s] if it begins there: on its way, or before it."""
    if not presser.path or then <= presser.path[0].at:
        return True
    here, there = presser.pose(time=then), presser.pose(time=then + 1.0 / RATE)
    return (here.x, here.z) != (there.x, there.z)


def _instants(paths: Sequence[Sequence[Waypoint]], since: float, until: float) -> range:
    """Return the numbers of the instants after `since` and before `until` [s] at which somebody may move."""
    moving = [path for path in paths if path]
    if not moving:
        return range(0)
    first = floor(min(path[0].at for path in moving) * RATE)
    last = ceil(max(path[-1].at for path in moving) * RATE)
    return range(max(floor(since * RATE) + 1, first), min(ceil(until * RATE), last + 1))


def _on_way(declared: PresserOnPath, time: float) -> Pose:
    """Return where a presser is at `time` [s]: between two instants of `RATE` it goes straight."""
    before, after = (declared.pose(time=at / RATE) for at in (floor(time * RATE), ceil(time * RATE)))
    part = time * RATE - floor(time * RATE)
    turned = (after.yaw - before.yaw + pi) % (2.0 * pi) - pi
    return Pose(
        before.x + part * (after.x - before.x), before.z + part * (after.z - before.z), before.yaw + part * turned
    )


@dataclass(slots=True)
class Press:
    """The system `press`: what has been trodden since the frame before."""

    outlooks: Iterable[Outlook]
    note: Callable[[float], Trodden]
    """Takes note of where all are at a time [s]."""

    def run(self) -> None:
        """Press for every viewer that looks."""
        for outlook in self.outlooks:
            outlook.note(self.note(outlook.viewer.time))
