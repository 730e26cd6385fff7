"""Walking: pressers that move from pose to pose together, and the trail of their footprints."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...components.presser import Presser
from .footprint import discs_of
from .trail import Discs, Stretches, Trail

EntityPresser = tuple[int, Presser]
"""An entity and its presser: with another footprint it counts as a new walker."""


@dataclass(frozen=True, slots=True, eq=False)
class WalkState:
    """State of a walk, with its trail."""

    pressers: list[EntityPresser]
    pose: Doubles
    """Pose of each presser, shape (n, 3)."""

    time: float
    """Time of these poses [s]."""

    open: Stretches
    way: Doubles
    closed: Stretches
    begun: int
    """Fields of its `Trail`, of the same names."""


class Walk:
    """Pressers and their present poses, in a fixed order."""

    def __init__(self, trail: Trail) -> None:
        self.trail, self.time = trail, 0.0
        """Trail of all their discs, and its present time [s]."""
        self.pressers: list[EntityPresser] = []
        self._pose: Doubles = np.zeros((0, 3))
        self._discs, self._presser_of_disc = np.zeros((0, 3)), np.zeros(0, np.intp)
        self._strength: Doubles = np.zeros(0)

    def move(self, pressers: list[EntityPresser], pose: Doubles, time: float) -> bool:
        """Move pressers straight to their poses (n, 3) at `time` [s]; return whether anything has changed.

        New pressers begin there. Missing ones let go of the grass.
        """
        if pressers != self.pressers:
            self._replace_pressers(pressers, pose, time)
        elif time == self.time and np.array_equal(pose, self._pose):
            return False  # asked again in the same frame
        self._pose, self.time = pose, time
        self.trail.tread(self._discs_at(pose), time)
        return True

    def state(self) -> WalkState:
        """Return the walk's state."""
        trail = self.trail
        return WalkState(
            self.pressers, self._pose, self.time, trail.open.copy(), trail.way.copy(), trail.over(), trail.begun
        )

    def resume(self, state: WalkState, pressers: list[EntityPresser]) -> None:
        """Restore a walk's state, with the pressers `pressers` in place of its own."""
        self._set_pressers(pressers)
        self._pose, self.time = state.pose, state.time
        self.trail.resume(state.open, state.way, state.closed, state.begun)

    def _replace_pressers(self, pressers: list[EntityPresser], pose: Doubles, time: float) -> None:
        """Take over other pressers; those that stay continue their stretches."""
        first = {key: number for number, key in enumerate(self.pressers)}
        before_starts = np.flatnonzero(np.diff(self._presser_of_disc, prepend=-1))
        counts = self._set_pressers(pressers)
        starts = np.cumsum(counts) - counts
        before, after = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)]
        for number, key in enumerate(pressers):
            if key in first:
                before.append(before_starts[first[key]] + np.arange(counts[number]))
                after.append(starts[number] + np.arange(counts[number]))
        self.trail.keep(np.concatenate(before), np.concatenate(after), self._discs_at(pose), time)

    def _set_pressers(self, pressers: list[EntityPresser]) -> NDArray[np.intp]:
        """Set the pressers; return each one's number of discs, shape (n,)."""
        discs = [discs_of(presser) for _, presser in pressers]
        counts = np.array([len(each) for each in discs], np.intp)
        self.pressers, self._presser_of_disc = pressers, np.repeat(np.arange(len(pressers)), counts)
        self._discs = np.concatenate([np.zeros((0, 3)), *discs])
        self._strength = np.array([presser.strength for _, presser in pressers])[self._presser_of_disc]
        return counts

    def _discs_at(self, pose: Doubles) -> Discs:
        """Return the discs of the pressers at these poses (n, 3)."""
        yaw, local = pose[self._presser_of_disc, 2], self._discs
        sine, cosine = np.sin(yaw), np.cos(yaw)
        x = pose[self._presser_of_disc, 0] + cosine * local[:, 0] - sine * local[:, 1]
        z = pose[self._presser_of_disc, 1] + sine * local[:, 0] + cosine * local[:, 1]
        return Discs(np.stack([x, z], axis=1), np.stack([sine, -cosine], axis=1), local[:, 2], self._strength)


def staying(before: Sequence[EntityPresser], now: Sequence[EntityPresser], /) -> list[EntityPresser]:
    """Return the entries of `before` that are in `now`, in their order."""
    present = set(now)
    return [key for key in before if key in present]
