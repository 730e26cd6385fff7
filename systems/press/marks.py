"""Marks: stretches of trails, sorted into squares of the ground, so that a receiver looks at a few alone."""

from dataclasses import dataclass
from itertools import islice
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

MOST_MARKS = 96
"""Marks that a square has at most: the latest. What none of its squares has any more is forgotten."""

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
        return cls(ordered, *touched(ordered))

    def after(self, time: float, counts: NDArray[np.bool_]) -> "Listed":
        """Return those that were left after `time` [s], in the squares where they still count, (m,); others go."""
        stays = self.stretches[:, LEFT] > time
        if stays.all() and counts.all():
            return self
        stays &= np.bincount(self.number[counts], minlength=len(stays)) > 0
        number, those = np.cumsum(stays, dtype=np.int32) - 1, counts & stays[self.number]
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
        return _marks(told(self.stretches, since), *self.lists())

    def lists(self) -> tuple[NDArray[np.intp], Ints]:
        """Return how many touch each square, and the lists of the squares one after the other."""
        count = np.bincount(self.square, minlength=SIDE * SIDE)
        return count, self.number[np.argsort(self.square, kind="stable")]


def told(stretches: Stretches, since: float) -> Floats:
    """Return stretches (n, NUMBERS) as marks are told, whose times count from `since` [s]."""
    times = slice(BEGUN, LEFT + 1)
    marks = stretches.astype(np.float32)
    marks[:, times] = stretches[:, times] - since
    return marks


def _marks(marks: Floats, count: NDArray[np.intp], listed: Ints) -> Marks:
    fewer = np.minimum(count, MOST_MARKS)
    first = np.cumsum(count) - fewer
    return Marks(marks, first.astype(np.int32), fewer.astype(np.int32), listed)


def _begins(settled: Marks) -> Ints:
    """Return the number of the first mark that counts in each square, shape (SIDE * SIDE,)."""
    begins, full = np.zeros(SIDE * SIDE, np.int32), settled.count == MOST_MARKS
    begins[full] = settled.listed[settled.first[full]]
    return begins


def square_of(place: Floats, /) -> Ints:
    """Return the number of the square of each ground position (n, 2), shape (n,)."""
    at = np.floor(place / np.float32(SQUARE)).astype(np.int32) & (SIDE - 1)
    return np.asarray(at[:, 1] * SIDE + at[:, 0], np.int32)


def touched(stretches: Stretches) -> tuple[Ints, NDArray[np.uint16]]:
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


NO_STRETCHES = np.zeros((0, NUMBERS))
NO_LISTS = np.zeros(SIDE * SIDE, np.intp), np.zeros(0, np.int32)

NOTHING = Listed.of(np.zeros((0, NUMBERS))).marks(since=0.0)
"""No marks at all."""

UNTRODDEN = Trodden(NOTHING, NOTHING, 0.0, 0.0)
"""What has been trodden where nobody goes."""


AT_A_TIME = 2
"""Pieces of what is kept that are told again at a time."""

WHOLE = 512
"""Stretches from which on a piece is whole: what settles next begins another one."""

READY = 0.8
"""Part of a second within which all that is kept is told again for the next one."""


class Telling:
    """What is kept, told for a second `since` [s] that comes: bit by bit, so that no frame has all of it to do."""

    def __init__(self, kept: list[Listed], settled: Marks, since: float, lasts: float) -> None:
        self.since, self.lasts = since, lasts
        self._left, self._passed, self._begins = iter(kept), 0, _begins(settled)
        self._turns, self._done = 1 + -(-len(kept) // AT_A_TIME), 0
        self.kept: list[Listed] = []
        """Those that still count then, in pieces."""
        self._told: list[Floats] = []
        self._count, self._listed = NO_LISTS

    def go_on(self, part: float) -> None:
        """Have this part of it done."""
        while self._done < min(part, 1.0) * self._turns:
            self._done += 1
            for piece in islice(self._left, AT_A_TIME):
                counts = self._passed + piece.number >= self._begins[piece.square]
                self._passed += len(piece.stretches)
                self._add(piece.after(self.since - self.lasts, counts))
            if self._done == self._turns:
                self._count, self._listed = whole(self.kept).lists()

    def settle(self, stretches: Stretches) -> Marks:
        """Return all of it as marks, with others (n, NUMBERS) after them that are kept from now on."""
        self.go_on(1.0)
        fresh = Listed.of(stretches)
        fresh = fresh.after(self.since - self.lasts, np.ones(len(fresh.number), np.bool_))
        count, listed = fresh.lists()
        listed = listed + np.int32(sum(map(len, self._told)))
        both = np.empty(len(self._listed) + len(listed), np.int32)
        both[np.repeat(np.cumsum(count) - count, self._count) + np.arange(len(self._listed))] = self._listed
        both[np.repeat(np.cumsum(self._count), count) + np.arange(len(listed))] = listed
        self._add(fresh)
        return _marks(np.concatenate(self._told), self._count + count, both) if self._told else NOTHING

    def _add(self, piece: Listed) -> None:
        if not len(piece.stretches):
            return
        if self.kept and len(self.kept[-1].stretches) < WHOLE:
            piece = self.kept.pop().and_then(piece)
            self._told.pop()
        self.kept.append(piece)
        self._told.append(told(piece.stretches, self.since))


def whole(pieces: list[Listed], /) -> Listed:
    """Return pieces, one after the other, as one."""
    begins = np.cumsum([0, *(len(piece.stretches) for piece in pieces)], dtype=np.int32)[:-1]
    return Listed(
        np.concatenate([NO_STRETCHES, *(piece.stretches for piece in pieces)]),
        np.concatenate([NO_LISTS[1], *(piece.number + begin for piece, begin in zip(pieces, begins, strict=True))]),
        np.concatenate([np.zeros(0, np.uint16), *(piece.square for piece in pieces)]),
    )


class Memory:
    """What is remembered of trails: for as long as it counts, and no longer.

    Marks settle at each full second of the scene's time, so that when they do depends on no frame.
    """

    def __init__(self, trails: list[Trail], lasts: float = 0.0) -> None:
        self.trails, self.lasts = trails, lasts
        """The trail of a scene's own pressers and that of a game's, and how long a mark is remembered [s]."""
        self._kept: list[Listed] = []
        self._telling: Telling | None = None
        self._settled, self.since = NOTHING, 0.0
        """What has settled, and when it did last [s]."""

    def replace(self, trail: Trail) -> None:
        """Take another trail for that of the scene's own: what the old one has left is as if it had never been."""
        self.trails[0] = trail
        kept = self.kept
        self.trails[1].closed.append(kept[kept[:, SERIAL] >= 0.0])  # they settle again, among those of the other trail
        self._kept, self._telling, self.since = [], None, -1.0

    @property
    def kept(self) -> Stretches:
        """The stretches that have settled, in the order in which they count."""
        return np.concatenate([NO_STRETCHES, *(piece.stretches for piece in self._kept)])

    def resume(self, kept: Stretches, since: float) -> None:
        """Remember just these stretches, in this order, which settled last at `since` [s]."""
        all_of_it = Listed(kept, *touched(kept))
        self._kept, self._telling, self.since = [all_of_it], None, since
        self._settled = all_of_it.marks(since=since) if len(kept) else NOTHING

    def at(self, time: float) -> Trodden:
        """Return what has been trodden by `time` [s], to which the trail has come."""
        now = float(floor(time))
        if now != self.since:
            self._settle(now)
        self._due(now + 1.0).go_on((time - now) / READY)
        found = np.concatenate([part for trail in self.trails for part in (trail.over(), trail.open)])
        fresh = Listed.of(found).marks(since=self.since) if len(found) else NOTHING
        return Trodden(self._settled, fresh, self.since, time)

    def _due(self, since: float) -> Telling:
        """Return what is kept, told for a second: as far as that has come, if it was begun."""
        found = self._telling
        if found is None or found.since != since or found.lasts != self.lasts:
            self._telling = found = Telling(self._kept, self._settled, since, self.lasts)
        return found

    def _settle(self, since: float) -> None:
        self.since = since
        found = []
        for trail in self.trails:
            over = trail.over()
            then = over[:, LEFT] <= since - APART
            trail.closed = [over[~then]]
            found.append(over[then])
        telling = self._due(since)
        self._settled = telling.settle(np.concatenate(found))
        self._kept, self._telling = telling.kept, None
