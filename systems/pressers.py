"""The pressers of a prairie: whose entities they are, the ways they have come, and what grass feels of them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import ceil, floor, pi

import numpy as np
from numpy.typing import NDArray

from ..components.pose import Pose
from ..components.presser import Presser
from ..engine.declared.presser import PresserOnPath
from ..engine.declared.scene import Scene
from ..engine.world import World
from .around.outlook import Outlook
from .grow.record import Growth
from .press.footprint import discs_of
from .press.lie import laid_over, pressed, recoveries, touches
from .press.marks import UNTRODDEN, Memory, Trodden
from .press.trail import FASTEST, LEAP, Discs, Trail
from .wind.blow import ReceiverArrays

Floats = NDArray[np.float32]
Doubles = NDArray[np.float64]

REMEMBERED = 2.0
"""How long what was trodden is remembered, of how long grass takes to stand again: it counts for what comes next."""


RATE = 30
"""How often in a second those that a scene declares are asked where they are; between that they go straight."""


class Pressers:
    """The entities of one world that have a `Presser` and a `Pose`, and what they have trodden.

    Those that a scene declares are entities too, and go their ways from the beginning of time: what they have trodden
    does not depend on when pictures are drawn.
    """

    def __init__(self, world: World, scene: Scene, growths: Sequence[Growth]) -> None:
        self._world = world
        self._who: list[tuple[int, Presser]] = []
        self._discs, self._owner = np.zeros((0, 3)), np.zeros(0, np.intp)
        self._strength: Doubles = np.zeros(0)
        self._pose: Doubles = np.zeros((0, 3))
        self._declared: dict[int, PresserOnPath] = {}
        self._generation, self._noted = world.generation, 0.0
        self._trail = Trail()
        self._memory = Memory(self._trail, 0.0)
        self.trodden = UNTRODDEN
        """What has been trodden so far."""
        self.change(scene, growths)
        if self._declared:
            self.note(0.0)

    def change(self, scene: Scene, growths: Sequence[Growth]) -> None:
        """Take over the kinds of grass of a scene, at first or when it was read again, and those who walk in it."""
        self.recovery: Floats = recoveries(scene)
        swings = [growth.response.step * len(growth.response.fall) for growth in growths]
        self._memory.lasts = REMEMBERED * max(float(self.recovery.max()), *swings)
        self._scene = scene
        self._declare(scene.pressers)

    def note(self, time: float) -> Trodden:
        """Take note of where all pressers are at `time` [s], and return what has been trodden."""
        self._go(time)
        found = self._world.both(Presser, Pose)
        if not found and not self._who and not self.trodden:
            return self.trodden
        who = [(entity, presser) for entity, presser, _ in found]
        pose = np.array([(pose.x, pose.z, pose.yaw) for _, _, pose in found], np.float64).reshape(-1, 3)
        if who != self._who:
            self._take(who, pose, time)
        elif time == self.trodden.time and np.array_equal(pose, self._pose):
            return self.trodden  # asked again in the same frame
        elif self._declared:
            self._tread_between(pose, time)
        self._pose, self._noted = pose, time
        self._trail.tread(self._stood(pose), time)
        self.trodden = self._memory.at(time)
        return self.trodden

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
        """Let those be entities that a scene declares; one that has not changed goes on."""
        left = dict(self._declared)
        self._declared = {}
        for declared in pressers:
            entity = next((entity for entity, other in left.items() if other == declared), None)
            if entity is None:
                entity = self._world.create(declared.footprint(), _on_way(declared, self._noted))
            left.pop(entity, None)
            self._declared[entity] = declared
        for entity in left:
            if self._world.has(entity):
                self._world.delete(entity)

    def _go(self, time: float) -> None:
        """Put those that the scene declares where they are at `time` [s]; what a game has deleted stays away."""
        if not self._declared:
            return
        if self._generation != self._world.check():
            self._generation, self._declared = self._world.generation, {}  # their numbers may be others' by now
            self._declare(self._scene.pressers)
        for entity, declared in self._declared.items():
            if self._world.find(entity, Presser) is not None:
                self._world.add(entity, _on_way(declared, time))

    def _tread_between(self, pose: Doubles, time: float) -> None:
        """Tread at all instants since the last one at which those that a scene declares are asked where they are.

        All others go straight from where they were to their `pose` (n, 3) of now, unless they have jumped.
        """
        way = pose - self._pose
        way[:, 2] = (way[:, 2] + pi) % (2.0 * pi) - pi
        way[np.hypot(way[:, 0], way[:, 1]) > LEAP + FASTEST * (time - self._noted)] = 0.0
        rows = [row for row, (entity, _) in enumerate(self._who) if entity in self._declared]
        paths = [self._declared[self._who[row][0]] for row in rows]
        for number in range(floor(self._noted * RATE) + 1, ceil(time * RATE)):
            then = number / RATE
            between = self._pose + way * ((then - self._noted) / (time - self._noted))
            for row, path in zip(rows, paths, strict=True):
                at = path.pose(time=then)
                between[row] = at.x, at.z, at.yaw
            self._trail.tread(self._stood(between), then)

    def _take(self, who: list[tuple[int, Presser]], pose: Doubles, time: float) -> None:
        """Take over other pressers; those that stay go on where they are."""
        each = [discs_of(presser) for _, presser in who]
        first = {key: number for number, key in enumerate(self._who)}
        counts = np.array([len(discs) for discs in each], np.intp)
        starts, before_starts = np.cumsum(counts) - counts, np.flatnonzero(np.diff(self._owner, prepend=-1))
        before, after = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)]
        for number, key in enumerate(who):
            if key in first:
                before.append(before_starts[first[key]] + np.arange(counts[number]))
                after.append(starts[number] + np.arange(counts[number]))
        self._who, self._owner = who, np.repeat(np.arange(len(who)), counts)
        self._discs = np.concatenate([np.zeros((0, 3)), *each])
        self._strength = np.array([presser.strength for _, presser in who])[self._owner]
        self._trail.keep(np.concatenate(before), np.concatenate(after), self._stood(pose), time)

    def _stood(self, pose: Doubles) -> Discs:
        """Return where the discs of pressers with these poses (n, 3) are."""
        yaw, own = pose[self._owner, 2], self._discs
        sine, cosine = np.sin(yaw), np.cos(yaw)
        x = pose[self._owner, 0] + cosine * own[:, 0] - sine * own[:, 1]
        z = pose[self._owner, 1] + sine * own[:, 0] + cosine * own[:, 1]
        return Discs(np.stack([x, z], axis=1), np.stack([sine, -cosine], axis=1), own[:, 2], self._strength)


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
            outlook.trodden = self.note(outlook.viewer.time)
