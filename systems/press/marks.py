"""Marks: stretches of trails, sorted into squares of the ground, so that a receiver looks at a few alone."""

from dataclasses import dataclass
from math import floor

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Ints
from .trail import BEGUN, FIRST, LAST, LEFT, NUMBERS, REACH, SERIAL, Stretches, Trail

SQUARE = 2.0
"""Side of a square [m]."""

SIDE = 128
"""Squares along the ground after which they are counted from 0 again: what lies so far apart shares a list."""

GLSL = {"SQUARE": SQUARE, "SIDE": SIDE}

MOST = 96
"""Marks that a square has at most: the latest."""


ROUNDED = 1e-6
"""Instants so near to one another count as the same [s]."""

APART = 0.0917
"""At a full second those marks settle that ended at least so long before it [s].

The number is odd so that hardly a mark ends just then, and rounding decides about none."""


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """Marks in the order in which they began, and those of each square."""

    marks: Floats
    """One a row, as stretches are, but for their times, which count from some instant; shape (n, NUMBERS)."""

    first: Ints
    """Where the list of each square begins, shape (SIDE * SIDE,)."""

    count: Ints
    """How many marks it has, shape (SIDE * SIDE,)."""

    listed: Ints
    """The lists, one after the other: numbers of marks, shape (m,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Trodden:
    """All that presses or has pressed at one instant."""

    settled: Marks
    """Marks of before `since`; the same object until marks settle again."""

    fresh: Marks
    """The marks since then."""

    since: float
    """The instant that times of marks count from [s]."""

    time: float
    """The instant itself [s]."""

    def __bool__(self) -> bool:
        return bool(len(self.settled.marks) or len(self.fresh.marks))


@dataclass(frozen=True, slots=True, eq=False)
class Listed:
    """Stretches, and which of the squares each of them touches."""

    stretches: Stretches
    number: Ints
    """Numbers of stretches, rising, shape (m,)."""

    square: NDArray[np.uint16]
    """The square that each touches, shape (m,)."""

    @classmethod
    def of(cls, stretches: Stretches) -> "Listed":
        """Return stretches (n, NUMBERS) in the order in which they began, and then of their ways."""
        ordered = stretches[np.lexsort((stretches[:, SERIAL], np.round(stretches[:, BEGUN] / ROUNDED)))]
        return cls(ordered, *_touched(ordered))

    def after(self, time: float) -> "Listed":
        """Return those that were left after `time` [s]."""
        stays = self.stretches[:, LEFT] > time
        if stays.all():
            return self
        number, those = np.cumsum(stays, dtype=np.int32) - 1, stays[self.number]
        return Listed(self.stretches[stays], number[self.number[those]], self.square[those])

    def and_then(self, other: "Listed") -> "Listed":
        """Return these, and others after them."""
        number = other.number + np.int32(len(self.stretches))
        return Listed(
            np.concatenate([self.stretches, other.stretches]),
            np.concatenate([self.number, number]),
            np.concatenate([self.square, other.square]),
        )

    def marks(self, *, since: float) -> Marks:
        """Return them as marks; times count from `since` [s]."""
        times = slice(BEGUN, LEFT + 1)
        marks = self.stretches.astype(np.float32)
        marks[:, times] = self.stretches[:, times] - since
        count = np.bincount(self.square, minlength=SIDE * SIDE)
        fewer = np.minimum(count, MOST)
        first = np.cumsum(count) - fewer
        listed = self.number[np.argsort(self.square, kind="stable")]
        return Marks(marks, first.astype(np.int32), fewer.astype(np.int32), listed)


def square_of(place: Floats, /) -> Ints:
    """Return the number of the square of each ground position (n, 2), shape (n,)."""
    at = np.floor(place / np.float32(SQUARE)).astype(np.int32) & (SIDE - 1)
    return np.asarray(at[:, 1] * SIDE + at[:, 0], np.int32)


def _touched(stretches: Stretches) -> tuple[Ints, NDArray[np.uint16]]:
    """Return which stretches touch which squares: their numbers, in order, and the squares', each of shape (m,)."""
    reach = stretches[:, REACH, None]
    low = np.floor((np.minimum(stretches[:, FIRST], stretches[:, LAST]) - reach) / SQUARE).astype(np.int32)
    high = np.floor((np.maximum(stretches[:, FIRST], stretches[:, LAST]) + reach) / SQUARE).astype(np.int32)
    wide, deep = (high - low + 1).T
    each = wide * deep
    number = np.repeat(np.arange(len(stretches), dtype=np.int32), each)
    begins = np.cumsum(each, dtype=np.int32) - each
    own, across = np.arange(len(number), dtype=np.int32) - begins[number], wide[number]
    row = own // across
    x, z = low[:, 0][number] + own - row * across, low[:, 1][number] + row
    return number, ((z & (SIDE - 1)) * SIDE + (x & (SIDE - 1))).astype(np.uint16)


NOTHING = Listed.of(np.zeros((0, NUMBERS))).marks(since=0.0)
"""No marks at all."""

UNTRODDEN = Trodden(NOTHING, NOTHING, 0.0, 0.0)
"""What has been trodden where nobody goes."""


class Memory:
    """What is remembered of trails: for as long as it counts, and no longer.

    Marks settle at each full second of the scene's time, so that when they do depends on no frame.
    """

    def __init__(self, trails: list[Trail], lasts: float = 0.0) -> None:
        self.trails, self.lasts = trails, lasts
        """The trail of a scene's own pressers and that of a game's, and how long a mark is remembered [s]."""
        self._kept = Listed.of(np.zeros((0, NUMBERS)))
        self._settled, self._since = NOTHING, 0.0

    def replace(self, trail: Trail) -> None:
        """Take another trail for that of the scene's own: what the old one has left is as if it had never been."""
        self.trails[0] = trail
        kept = self._kept.stretches
        self.trails[1].closed.append(kept[kept[:, SERIAL] >= 0.0])  # they settle again, among those of the other trail
        self._kept, self._since = Listed.of(kept[:0]), -1.0

    @property
    def kept(self) -> Stretches:
        """The stretches that have settled, in the order in which they count."""
        return self._kept.stretches

    @property
    def since(self) -> float:
        """When marks settled last [s]."""
        return self._since

    def resume(self, kept: Stretches, since: float) -> None:
        """Remember just these stretches, in this order, which settled last at `since` [s]."""
        self._kept, self._since = Listed(kept, *_touched(kept)), since
        self._settled = self._kept.marks(since=since) if len(kept) else NOTHING

    def at(self, time: float) -> Trodden:
        """Return what has been trodden by `time` [s], to which the trail has come."""
        if floor(time) != self._since:
            self._settle(float(floor(time)))
        found = np.concatenate([part for trail in self.trails for part in (trail.over(), trail.open)])
        fresh = Listed.of(found).marks(since=self._since) if len(found) else NOTHING
        return Trodden(self._settled, fresh, self._since, time)

    def _settle(self, since: float) -> None:
        self._since = since
        found = []
        for trail in self.trails:
            over = trail.over()
            then = over[:, LEFT] <= since - APART
            trail.closed = [over[~then]]
            found.append(over[then])
        self._kept = self._kept.and_then(Listed.of(np.concatenate(found))).after(since - self.lasts)
        self._settled = self._kept.marks(since=since) if len(self._kept.stretches) else NOTHING
