"""Trails: the ways of pressing discs, cut into stretches of a length that does not depend on the time step."""

from dataclasses import dataclass, field
from math import inf

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles

Stretches = NDArray[np.float64]
"""Stretches of the ways of discs, one a row, shape (n, COLUMNS)."""

FIRST, LAST = slice(0, 2), slice(2, 4)
"""Columns of the disc's middle at the beginning and at the end of a stretch (x, z) [m]."""

BEGUN, CAME, LEFT = 4, 5, 6
"""Columns of times [s]: at the beginning, of arrival at the end, and of departure, later if the disc stood there."""

REACH, STRENGTH, HEADING = 7, 8, slice(9, 11)
"""Columns of the radius within which grass bends aside [m]; the message's length in the middle; the direction of the
way, or of the presser if it only stood."""

SERIAL = 11
"""Column of the way's number, in the order in which ways began; below 0 for a scene's own pressers."""

FIRST_OF_SCENE = -(2**40)
"""Number of the first way of a scene's own pressers: low enough never to count up to 0."""

COLUMNS = 12
"""Number of columns of a stretch."""

REACH_RADII = 1.5
"""Radius within which grass bends aside, relative to the disc's."""

LEAST_STRETCH, STRETCH_RADII = 0.3, 0.75
"""Length of a stretch: at least `LEAST_STRETCH` [m], or `STRETCH_RADII` of the disc's radius."""

LONGEST_STAND = 0.25
"""Longest time that a disc stands still without its stretch ending there [s]."""

JUMP, FASTEST = 2.0, 40.0
"""Distance [m] and speed [m/s]: a move farther than `JUMP` plus the way at `FASTEST` is a jump, which treads
nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class Discs:
    """The discs of all pressers at one instant, in a fixed order."""

    place: Doubles
    """Middles (x, z) [m], shape (n, 2)."""

    facing: Doubles
    """Directions in which their pressers face, unit vectors, shape (n, 2)."""

    radius: Doubles
    """Radii [m], shape (n,)."""

    strength: Doubles
    """Lengths of the messages in their middles, shape (n,)."""

    def __len__(self) -> int:
        return len(self.radius)


@dataclass(slots=True, eq=False)
class Trail:
    """The open stretches of pressing discs, and the closed ones that have not been taken yet."""

    open: Stretches = field(default_factory=lambda: np.zeros((0, COLUMNS)))
    """Present stretch of each disc; it ends at the disc."""

    closed: list[Stretches] = field(default_factory=list)
    """Finished stretches, in the order in which they ended."""

    begun: int = 0
    """Number of the next way."""

    every: float = inf
    """Period at whose multiples all ways begin new stretches [s]: later stretches do not depend on earlier ones."""

    way: Doubles = field(default_factory=lambda: np.zeros(0))
    """Length that each disc has covered on its present stretch [m]."""

    def keep(self, before: NDArray[np.intp], after: NDArray[np.intp], discs: Discs, time: float) -> None:
        """Take over other discs: those with indices `before` (m,) now have `after` (m,), the others begin new ways."""
        is_gone = np.ones(len(self.open), np.bool_)
        is_gone[before] = False
        if is_gone.any():
            self.closed.append(self.open[is_gone])
        opened, way = self._new_stretches(discs, np.arange(len(discs)), time), np.zeros(len(discs))
        opened[after], way[after] = self.open[before], self.way[before]
        self.open, self.way = opened, way

    def resume(self, opened: Stretches, way: Doubles, closed: Stretches, begun: int) -> None:
        """Restore open stretches, the lengths covered on them, closed stretches, and the number of the next way."""
        self.open, self.way, self.closed, self.begun = opened.copy(), way.copy(), [closed], begun

    def over(self) -> Stretches:
        """Return the closed stretches as one array."""
        if len(self.closed) != 1:
            self.closed = [np.concatenate([np.zeros((0, COLUMNS)), *self.closed])]
        return self.closed[0]

    def tread(self, discs: Discs, time: float) -> None:
        """Move all discs on straight ways to their positions at `time` [s]."""
        stretches = self.open
        step = discs.place - stretches[:, LAST]
        distance, elapsed = np.hypot(step[:, 0], step[:, 1]), time - stretches[:, LEFT]
        jumped, moved = distance > JUMP + FASTEST * elapsed, distance > 0.0
        stood = moved & ~jumped & (stretches[:, LEFT] - stretches[:, CAME] > LONGEST_STAND)
        stood |= moved & ~jumped & (stretches[:, LEFT] % self.every == 0.0) & (stretches[:, BEGUN] < stretches[:, LEFT])
        if (ended := jumped | stood).any():
            self.closed.append(self.open[ended])
        stretches[stood, FIRST], stretches[stood, BEGUN] = stretches[stood, LAST], stretches[stood, LEFT]
        self.way[stood] = 0.0
        completing = np.flatnonzero(moved & ~jumped & (self.way + distance >= _stretch_length(stretches[:, REACH])))
        if len(completing):
            self._close_passed(completing, step[completing], distance[completing], time)
        moved &= ~jumped
        stretches[moved, LAST], stretches[moved, CAME] = discs.place[moved], time
        stretches[moved, HEADING] = step[moved] / distance[moved, None]
        self.way[moved] += distance[moved]
        stretches[:, LEFT] = time
        if jumped.any():
            rows = np.flatnonzero(jumped)
            stretches[rows], self.way[rows] = self._new_stretches(discs, rows, time), 0.0

    def _close_passed(self, rows: NDArray[np.intp], step: Doubles, distance: Doubles, time: float) -> None:
        """Close the stretches that some discs (n,) complete in a step (n, 2) [m]; the last stay open."""
        stretches, length = self.open, _stretch_length(self.open[rows, REACH])
        start, began, end = stretches[rows, LAST], stretches[rows, LEFT], length - self.way[rows]
        stretches[rows, HEADING] = step / distance[:, None]
        rows_left = np.flatnonzero(end <= distance)
        while len(rows_left):
            part, passed = end[rows_left] / distance[rows_left], rows[rows_left]
            stretches[passed, LAST] = place = start[rows_left] + part[:, None] * step[rows_left]
            moment = began[rows_left] + part * (time - began[rows_left])
            stretches[passed, CAME] = stretches[passed, LEFT] = moment
            self.closed.append(stretches[passed])
            stretches[passed, FIRST], stretches[passed, BEGUN] = place, moment
            end[rows_left] += length[rows_left]
            rows_left = rows_left[end[rows_left] <= distance[rows_left]]
        self.way[rows] = -(end - length)  # `tread` adds the whole step

    def _new_stretches(self, discs: Discs, rows: NDArray[np.intp], time: float) -> Stretches:
        """Return new stretches of length 0 for some discs, each on a new way."""
        stretches = np.zeros((len(rows), COLUMNS))
        stretches[:, FIRST] = stretches[:, LAST] = discs.place[rows]
        stretches[:, BEGUN] = stretches[:, CAME] = stretches[:, LEFT] = time
        stretches[:, REACH], stretches[:, STRENGTH] = REACH_RADII * discs.radius[rows], discs.strength[rows]
        stretches[:, HEADING] = discs.facing[rows]
        stretches[:, SERIAL] = self.begun + np.arange(len(rows))
        self.begun += len(rows)
        return stretches


def _stretch_length(reach: Doubles) -> Doubles:
    """Return the lengths at which stretches end [m], by their reach [m]."""
    return np.maximum(LEAST_STRETCH, STRETCH_RADII / REACH_RADII * reach)
