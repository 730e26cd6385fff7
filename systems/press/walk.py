"""Walking: pressers that go together, from pose to pose, and the trail that their footprints leave."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...components.presser import Presser
from .footprint import discs_of
from .trail import Discs, Stretches, Trail

Who = tuple[int, Presser]
"""An entity, and what it presses with: with another footprint it counts as somebody else."""


@dataclass(frozen=True, slots=True, eq=False)
class Stand:
    """How far a walk has come, with its trail."""

    who: list[Who]
    pose: Doubles
    """Their poses, shape (n, 3)."""

    time: float
    """The instant of those [s]."""

    open: Stretches
    way: Doubles
    closed: Stretches
    begun: int
    """What its trail is made of, as `Trail` has it."""


class Walk:
    """Pressers and the poses that they have come to, in a fixed order."""

    def __init__(self, trail: Trail) -> None:
        self.trail, self.time = trail, 0.0
        """The trail of all their discs, and the instant to which it has come [s]."""
        self.who: list[Who] = []
        self._pose: Doubles = np.zeros((0, 3))
        self._discs, self._owner = np.zeros((0, 3)), np.zeros(0, np.intp)
        self._strength: Doubles = np.zeros(0)

    def come(self, who: list[Who], pose: Doubles, time: float) -> bool:
        """Let pressers come straight to their poses (n, 3) of `time` [s]; return whether anything is new.

        Those that are new begin there. Those that were among them before and are not now let go of the grass.
        """
        if who != self.who:
            self._take(who, pose, time)
        elif time == self.time and np.array_equal(pose, self._pose):
            return False  # asked again in the same frame
        self._pose, self.time = pose, time
        self.trail.tread(self._stood(pose), time)
        return True

    def stand(self) -> Stand:
        """Return how far it has come."""
        trail = self.trail
        return Stand(self.who, self._pose, self.time, trail.open.copy(), trail.way.copy(), trail.over(), trail.begun)

    def resume(self, stand: Stand, who: list[Who]) -> None:
        """Go on from where a walk stood, with these in the place of those who went."""
        self._arrange(who)
        self._pose, self.time = stand.pose, stand.time
        self.trail.resume(stand.open, stand.way, stand.closed, stand.begun)

    def _take(self, who: list[Who], pose: Doubles, time: float) -> None:
        """Take over other pressers; those that stay go on where they are."""
        first = {key: number for number, key in enumerate(self.who)}
        before_starts = np.flatnonzero(np.diff(self._owner, prepend=-1))
        counts = self._arrange(who)
        starts = np.cumsum(counts) - counts
        before, after = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)]
        for number, key in enumerate(who):
            if key in first:
                before.append(before_starts[first[key]] + np.arange(counts[number]))
                after.append(starts[number] + np.arange(counts[number]))
        self.trail.keep(np.concatenate(before), np.concatenate(after), self._stood(pose), time)

    def _arrange(self, who: list[Who]) -> NDArray[np.intp]:
        """Let these be who go, and return how many discs each has, shape (n,)."""
        each = [discs_of(presser) for _, presser in who]
        counts = np.array([len(discs) for discs in each], np.intp)
        self.who, self._owner = who, np.repeat(np.arange(len(who)), counts)
        self._discs = np.concatenate([np.zeros((0, 3)), *each])
        self._strength = np.array([presser.strength for _, presser in who])[self._owner]
        return counts

    def _stood(self, pose: Doubles) -> Discs:
        """Return where the discs of pressers with these poses (n, 3) are."""
        yaw, own = pose[self._owner, 2], self._discs
        sine, cosine = np.sin(yaw), np.cos(yaw)
        x = pose[self._owner, 0] + cosine * own[:, 0] - sine * own[:, 1]
        z = pose[self._owner, 1] + sine * own[:, 0] + cosine * own[:, 1]
        return Discs(np.stack([x, z], axis=1), np.stack([sine, -cosine], axis=1), own[:, 2], self._strength)


def staying(before: Sequence[Who], now: Sequence[Who], /) -> list[Who]:
    """Return those of `before` that are there `now`."""
    there = set(now)
    return [key for key in before if key in there]
