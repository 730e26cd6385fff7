"""Walking: pressers that move from pose to pose together, and the trail of their footprints."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ...components.arrays import Doubles
from ...components.declaration import Declaration
from ...components.presser import Presser
from ...engine.stored import AS_FIELDS, Stored, Time
from .footprint import discs_of
from .trail import COLUMNS, FIRST_OF_SCENE, Discs, Stretches, Trail

EntityPresser = tuple[int, Presser]
"""An entity and its presser: with another footprint it counts as a new walker."""


class WalkState(Declaration):
    """State of a walk, with its trail."""

    pressers: list[tuple[int, Annotated[Presser, AS_FIELDS]]]
    pose: Annotated[Doubles, Stored(np.float64, None, 3)]
    """Pose of each presser, shape (n, 3)."""

    time: Time
    """Time of these poses [s]."""

    open: Annotated[Stretches, Stored(np.float64, None, COLUMNS)]
    way: Annotated[Doubles, Stored(np.float64, None)]
    closed: Annotated[Stretches, Stored(np.float64, None, COLUMNS)]
    begun: Annotated[int, Field(ge=FIRST_OF_SCENE, le=-FIRST_OF_SCENE)]
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
            pressers=self.pressers, pose=self._pose, time=self.time, open=trail.open.copy(), way=trail.way.copy(),
            closed=trail.over(), begun=trail.begun,
        )  # fmt: skip

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
