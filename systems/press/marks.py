"""Marks: stretches of trails, sorted into squares of the ground, so that a receiver looks at few of them."""

from dataclasses import dataclass
from itertools import islice
from math import floor

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Ints
from ...engine.pair import cells_between
from .trail import BEGUN, COLUMNS, FIRST, LAST, LEFT, REACH, SERIAL, Stretches, Trail

SQUARE = 2.0
"""Side of a square [m]."""

SIDE = 128
"""Squares along x and along z after which their numbers repeat; squares that far apart share a list."""

GLSL = {"SQUARE": SQUARE, "SIDE": SIDE}

MOST_MARKS = 96
"""Largest number of marks in a square: the latest. A mark that is in no square's list any more is forgotten."""

TIME_STEP = 1e-6
"""Step to which times are rounded for ordering [s]."""

SETTLE_AFTER = 0.0917
"""Smallest time from the end of a mark to the full second at which it settles [s].

It is an odd number so that hardly a mark ends just then, where rounding would decide."""


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """Marks in the order in which they began, and a list of them for each square."""

    marks: Floats
    """Marks, one a row, laid out as stretches, with times from `Trodden.since`; shape (n, COLUMNS)."""

    first: Ints
    """Start of each square's list in `listed`, shape (SIDE * SIDE,)."""

    count: Ints
    """Length of each square's list, shape (SIDE * SIDE,)."""

    listed: Ints
    """All lists, concatenated: indices of marks, shape (m,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Trodden:
    """All marks at one instant."""

    settled: Marks
    """Marks from before `since`; the same object until marks settle again."""

    fresh: Marks
    """Marks after `since`."""

    since: float
    """Time from which times of marks count [s]."""

    time: float
    """The instant [s]."""

    def __bool__(self) -> bool:
        return bool(len(self.settled.marks) or len(self.fresh.marks))


@dataclass(frozen=True, slots=True, eq=False)
class Listing:
    """Stretches, and all pairs of a stretch and a square that it touches."""

    stretches: Stretches
    stretch_of_pair: Ints
    """Index of each pair's stretch, rising, shape (m,)."""

    square_of_pair: NDArray[np.uint16]
    """Number of each pair's square, shape (m,)."""

    @classmethod
    def of(cls, stretches: Stretches) -> "Listing":
        """Sort stretches (n, COLUMNS) by the time at which they began, then by way, and list their squares."""
        ordered = stretches[np.lexsort((stretches[:, SERIAL], np.round(stretches[:, BEGUN] / TIME_STEP)))]
        return cls(ordered, *touched_squares(ordered))

    def kept_after(self, time: float, counts: NDArray[np.bool_]) -> "Listing":
        """Return the stretches that discs left after `time` [s], with the pairs where `counts` (m,); others go."""
        stays = self.stretches[:, LEFT] > time
        if stays.all() and counts.all():
            return self
        stays &= np.bincount(self.stretch_of_pair[counts], minlength=len(stays)) > 0
        new_index, pairs = np.cumsum(stays, dtype=np.int32) - 1, counts & stays[self.stretch_of_pair]
        return Listing(self.stretches[stays], new_index[self.stretch_of_pair[pairs]], self.square_of_pair[pairs])

    def and_then(self, other: "Listing") -> "Listing":
        """Return these stretches followed by others."""
        stretch_of_pair = other.stretch_of_pair + np.int32(len(self.stretches))
        return Listing(
            np.concatenate([self.stretches, other.stretches]),
            np.concatenate([self.stretch_of_pair, stretch_of_pair]),
            np.concatenate([self.square_of_pair, other.square_of_pair]),
        )

    def marks(self, *, since: float) -> Marks:
        """Return the stretches as marks, with times from `since` [s]."""
        return _marks(as_marks(self.stretches, since), *self.lists())

    def lists(self) -> tuple[NDArray[np.intp], Ints]:
        """Return the lengths of the squares' lists, and the lists, concatenated."""
        count = np.bincount(self.square_of_pair, minlength=SIDE * SIDE)
        return count, self.stretch_of_pair[np.argsort(self.square_of_pair, kind="stable")]


def as_marks(stretches: Stretches, since: float) -> Floats:
    """Return stretches (n, COLUMNS) as float32 rows of marks, with times from `since` [s]."""
    times = slice(BEGUN, LEFT + 1)
    marks = stretches.astype(np.float32)
    marks[:, times] = stretches[:, times] - since
    return marks


def _marks(marks: Floats, count: NDArray[np.intp], listed: Ints) -> Marks:
    """Return marks with their lists, each limited to its last `MOST_MARKS`."""
    limited = np.minimum(count, MOST_MARKS)
    first = np.cumsum(count) - limited
    return Marks(marks, first.astype(np.int32), limited.astype(np.int32), listed)


def _first_counting(settled: Marks) -> Ints:
    """Return the index of the first mark that counts in each square, shape (SIDE * SIDE,)."""
    begins, full = np.zeros(SIDE * SIDE, np.int32), settled.count == MOST_MARKS
    begins[full] = settled.listed[settled.first[full]]
    return begins


def square_of(place: Floats, /) -> Ints:
    """Return the number of the square of each ground position (n, 2), shape (n,)."""
    cell = np.floor(place / np.float32(SQUARE)).astype(np.int32) & (SIDE - 1)
    return np.asarray(cell[:, 1] * SIDE + cell[:, 0], np.int32)


def touched_squares(stretches: Stretches) -> tuple[Ints, NDArray[np.uint16]]:
    """Return all pairs of a stretch and a square that it touches: indices in order, and squares, each of shape (m,)."""
    reach = stretches[:, REACH, None]
    low = np.floor((np.minimum(stretches[:, FIRST], stretches[:, LAST]) - reach) / SQUARE).astype(np.int32)
    high = np.floor((np.maximum(stretches[:, FIRST], stretches[:, LAST]) + reach) / SQUARE).astype(np.int32)
    stretch_of_pair, x, z = cells_between(low, high)
    return stretch_of_pair, ((z & (SIDE - 1)) * SIDE + (x & (SIDE - 1))).astype(np.uint16)


NO_STRETCHES = np.zeros((0, COLUMNS))
NO_LISTS = np.zeros(SIDE * SIDE, np.intp), np.zeros(0, np.int32)

NOTHING = Listing.of(np.zeros((0, COLUMNS))).marks(since=0.0)
"""No marks."""

UNTRODDEN = Trodden(NOTHING, NOTHING, 0.0, 0.0)
"""An instant without marks."""


PIECES_AT_A_TIME = 2
"""Number of pieces that are converted together."""

FULL_PIECE = 512
"""Number of stretches from which on a piece is full: later stretches begin another one."""

READY_BY = 0.8
"""Fraction of a second within which all pieces are converted for the next second."""


class Conversion:
    """Conversion of kept stretches to marks with times from the coming second `since` [s], spread over frames."""

    def __init__(self, kept: list[Listing], settled: Marks, since: float, lasts: float) -> None:
        self.since, self.lasts = since, lasts
        self._pieces_left, self._stretches_seen, self._first_counting = iter(kept), 0, _first_counting(settled)
        self._steps, self._steps_done = 1 + -(-len(kept) // PIECES_AT_A_TIME), 0
        self.kept: list[Listing] = []
        """Stretches that still count then, in pieces."""
        self._converted: list[Floats] = []
        self._count, self._listed = NO_LISTS

    def convert_to(self, fraction: float) -> None:
        """Convert until this fraction, 0 to 1, of all pieces is done."""
        while self._steps_done < min(fraction, 1.0) * self._steps:
            self._steps_done += 1
            for piece in islice(self._pieces_left, PIECES_AT_A_TIME):
                counts = self._stretches_seen + piece.stretch_of_pair >= self._first_counting[piece.square_of_pair]
                self._stretches_seen += len(piece.stretches)
                self._add(piece.kept_after(self.since - self.lasts, counts))
            if self._steps_done == self._steps:
                self._count, self._listed = concatenated(self.kept).lists()

    def settle(self, stretches: Stretches) -> Marks:
        """Finish; return all stretches as marks, followed by new ones (n, COLUMNS), which are kept from now on."""
        self.convert_to(1.0)
        fresh = Listing.of(stretches)
        fresh = fresh.kept_after(self.since - self.lasts, np.ones(len(fresh.stretch_of_pair), np.bool_))
        count, listed = fresh.lists()
        listed = listed + np.int32(sum(map(len, self._converted)))
        both = np.empty(len(self._listed) + len(listed), np.int32)
        both[np.repeat(np.cumsum(count) - count, self._count) + np.arange(len(self._listed))] = self._listed
        both[np.repeat(np.cumsum(self._count), count) + np.arange(len(listed))] = listed
        self._add(fresh)
        return _marks(np.concatenate(self._converted), self._count + count, both) if self._converted else NOTHING

    def _add(self, piece: Listing) -> None:
        """Append a piece, or join it to the last one while that is not full."""
        if not len(piece.stretches):
            return
        if self.kept and len(self.kept[-1].stretches) < FULL_PIECE:
            piece = self.kept.pop().and_then(piece)
            self._converted.pop()
        self.kept.append(piece)
        self._converted.append(as_marks(piece.stretches, self.since))


def concatenated(pieces: list[Listing], /) -> Listing:
    """Concatenate pieces."""
    begins = np.cumsum([0, *(len(piece.stretches) for piece in pieces)], dtype=np.int32)[:-1]
    return Listing(
        np.concatenate([NO_STRETCHES, *(piece.stretches for piece in pieces)]),
        np.concatenate(
            [NO_LISTS[1], *(piece.stretch_of_pair + begin for piece, begin in zip(pieces, begins, strict=True))]
        ),
        np.concatenate([np.zeros(0, np.uint16), *(piece.square_of_pair for piece in pieces)]),
    )


class Memory:
    """The stretches of trails, kept for as long as they count.

    They settle at each full second of the scene's time, which does not depend on frames.
    """

    def __init__(self, trails: list[Trail], lasts: float = 0.0) -> None:
        self.trails, self.lasts = trails, lasts
        """The trails of the scene's pressers and of the game's; time for which a mark is kept [s]."""
        self._kept: list[Listing] = []
        self._conversion: Conversion | None = None
        self._settled, self.since = NOTHING, 0.0
        """Settled marks, and the second at which marks last settled [s]."""

    def replace(self, trail: Trail) -> None:
        """Replace the trail of the scene's pressers, and forget all that the old one has left."""
        self.trails[0] = trail
        kept = self.kept
        self.trails[1].closed.append(kept[kept[:, SERIAL] >= 0.0])  # they settle again, with the new trail's
        self._kept, self._conversion, self.since = [], None, -1.0

    @property
    def kept(self) -> Stretches:
        """The stretches that have settled, in the order in which they count."""
        return np.concatenate([NO_STRETCHES, *(piece.stretches for piece in self._kept)])

    def resume(self, kept: Stretches, since: float) -> None:
        """Restore these stretches, in this order, as settled at `since` [s]."""
        all_of_it = Listing(kept, *touched_squares(kept))
        self._kept, self._conversion, self.since = [all_of_it], None, since
        self._settled = all_of_it.marks(since=since) if len(kept) else NOTHING

    def at(self, time: float) -> Trodden:
        """Return all marks at `time` [s], the present time of the trails."""
        now = float(floor(time))
        if now != self.since:
            self._settle(now)
        self._conversion_for(now + 1.0).convert_to((time - now) / READY_BY)
        fresh_stretches = np.concatenate([part for trail in self.trails for part in (trail.over(), trail.open)])
        fresh = Listing.of(fresh_stretches).marks(since=self.since) if len(fresh_stretches) else NOTHING
        return Trodden(self._settled, fresh, self.since, time)

    def _conversion_for(self, since: float) -> Conversion:
        """Return the conversion for a second, as far as it has come, or a new one."""
        conversion = self._conversion
        if conversion is None or conversion.since != since or conversion.lasts != self.lasts:
            self._conversion = conversion = Conversion(self._kept, self._settled, since, self.lasts)
        return conversion

    def _settle(self, since: float) -> None:
        """Settle the closed stretches that ended at least `SETTLE_AFTER` before the full second `since` [s]."""
        self.since = since
        settling = []
        for trail in self.trails:
            closed = trail.over()
            is_settling = closed[:, LEFT] <= since - SETTLE_AFTER
            trail.closed = [closed[~is_settling]]
            settling.append(closed[is_settling])
        conversion = self._conversion_for(since)
        self._settled = conversion.settle(np.concatenate(settling))
        self._kept, self._conversion = conversion.kept, None
