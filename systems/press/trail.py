"""Trails: the way of every disc that presses, cut into stretches of the same length whatever the steps in time."""

from dataclasses import dataclass, field
from math import inf

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles

Stretches = NDArray[np.float64]
"""Stretches of the ways of discs, one a row, shape (n, NUMBERS)."""

FIRST, LAST = slice(0, 2), slice(2, 4)
"""Where the disc's middle was at the beginning of a stretch and at its end (x, z) [m]."""

BEGUN, CAME, LEFT = 4, 5, 6
"""When it was at the beginning; when it came to the end, and when it left it, later where it has stood there [s]."""

REACH, STRENGTH, HEADING = 7, 8, slice(9, 11)
"""How far from its middle grass bends aside [m]; the message there; where it went, or looked if it only stood."""

SERIAL = 11
"""The number of its way, in the order in which ways began; those of a scene's own pressers are below 0."""

SCENES = -(2**40)
"""The number of the first way of a scene's own pressers: so many never begin that it comes to 0."""

NUMBERS = 12
"""What a stretch is made of."""

BESIDE = 1.5
"""How far from the middle grass bends aside, in radii."""

LEAST, PART = 0.3, 0.75
"""Length of a stretch: this much at least [m], or this part of the radius."""

STAYS = 0.25
"""How long a disc stands in a place before a stretch ends there [s]."""

JUMP, FASTEST = 2.0, 40.0
"""What moves farther than `JUMP` [m] and as far as this speed brings it [m/s] has jumped, and trod on nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class Discs:
    """The discs of all pressers at one instant, in a fixed order."""

    place: Doubles
    """Middles (x, z) [m], shape (n, 2)."""

    facing: Doubles
    """Where their pressers look, unit vectors, shape (n, 2)."""

    radius: Doubles
    """Radii [m], shape (n,)."""

    strength: Doubles
    """Messages in their middles, shape (n,)."""

    def __len__(self) -> int:
        return len(self.radius)


@dataclass(slots=True, eq=False)
class Trail:
    """The open stretches of discs that press, and those that have been closed since they were last taken."""

    open: Stretches = field(default_factory=lambda: np.zeros((0, NUMBERS)))
    """The stretch that each disc is on, which ends where it is now."""

    closed: list[Stretches] = field(default_factory=list)
    """Stretches that are over, in the order in which they ended."""

    begun: int = 0
    """The number of the way that begins next."""

    every: float = inf
    """At multiples of this each way begins a new stretch [s]: from there on nothing depends on what was before."""

    way: Doubles = field(default_factory=lambda: np.zeros(0))
    """How far each has come on its stretch [m]."""

    def keep(self, before: NDArray[np.intp], after: NDArray[np.intp], discs: Discs, time: float) -> None:
        """Take over other discs: those numbered `before` (m,) are numbered `after` (m,) now, all others are new."""
        gone = np.ones(len(self.open), np.bool_)
        gone[before] = False
        if gone.any():
            self.closed.append(self.open[gone])
        opened, way = self._begun(discs, np.arange(len(discs)), time), np.zeros(len(discs))
        opened[after], way[after] = self.open[before], self.way[before]
        self.open, self.way = opened, way

    def resume(self, opened: Stretches, way: Doubles, closed: Stretches, begun: int) -> None:
        """Go on from stretches that discs were on, how far each had come, those that are over, and their number."""
        self.open, self.way, self.closed, self.begun = opened.copy(), way.copy(), [closed], begun

    def over(self) -> Stretches:
        """Return the stretches that have been closed, in one array."""
        if len(self.closed) != 1:
            self.closed = [np.concatenate([np.zeros((0, NUMBERS)), *self.closed])]
        return self.closed[0]

    def tread(self, discs: Discs, time: float) -> None:
        """Bring all discs to where they are at `time` [s]; on the way there they are taken to have gone straight."""
        on = self.open
        gone = discs.place - on[:, LAST]
        far, took = np.hypot(gone[:, 0], gone[:, 1]), time - on[:, LEFT]
        jumped, moved = far > JUMP + FASTEST * took, far > 0.0
        stood = moved & ~jumped & (on[:, LEFT] - on[:, CAME] > STAYS)
        stood |= moved & ~jumped & (on[:, LEFT] % self.every == 0.0) & (on[:, BEGUN] < on[:, LEFT])
        self._close(jumped | stood)
        on[stood, FIRST], on[stood, BEGUN], self.way[stood] = on[stood, LAST], on[stood, LEFT], 0.0
        past = np.flatnonzero(moved & ~jumped & (self.way + far >= _length(on[:, REACH])))
        if len(past):
            self._mark(past, gone[past], far[past], time)
        moved &= ~jumped
        on[moved, LAST], on[moved, CAME] = discs.place[moved], time
        on[moved, HEADING] = gone[moved] / far[moved, None]
        self.way[moved] += far[moved]
        on[:, LEFT] = time
        if jumped.any():
            rows = np.flatnonzero(jumped)
            on[rows], self.way[rows] = self._begun(discs, rows, time), 0.0

    def _mark(self, rows: NDArray[np.intp], gone: Doubles, far: Doubles, time: float) -> None:
        """Close the stretches of some discs (n,) on their way of one step (n, 2) [m]; the last ones stay open."""
        on, length = self.open, _length(self.open[rows, REACH])
        start, since, at = on[rows, LAST], on[rows, LEFT], length - self.way[rows]
        on[rows, HEADING] = gone / far[:, None]
        left = np.flatnonzero(at <= far)
        while len(left):
            part, these = at[left] / far[left], rows[left]
            on[these, LAST] = place = start[left] + part[:, None] * gone[left]
            then = since[left] + part * (time - since[left])
            on[these, CAME] = on[these, LEFT] = then
            self.closed.append(on[these])
            on[these, FIRST], on[these, BEGUN] = place, then
            at[left] += length[left]
            left = left[at[left] <= far[left]]
        self.way[rows] = -(at - length)  # `tread` adds the whole of the step

    def _close(self, which: NDArray[np.bool_]) -> None:
        if which.any():
            self.closed.append(self.open[which])

    def _begun(self, discs: Discs, rows: NDArray[np.intp], time: float) -> Stretches:
        begun = np.zeros((len(rows), NUMBERS))
        begun[:, FIRST] = begun[:, LAST] = discs.place[rows]
        begun[:, BEGUN] = begun[:, CAME] = begun[:, LEFT] = time
        begun[:, REACH], begun[:, STRENGTH] = BESIDE * discs.radius[rows], discs.strength[rows]
        begun[:, HEADING] = discs.facing[rows]
        begun[:, SERIAL] = self.begun + np.arange(len(rows))
        self.begun += len(rows)
        return begun


def _length(reach: Doubles) -> Doubles:
    return np.maximum(LEAST, PART / BESIDE * reach)
