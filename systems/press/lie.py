"""Pressed grass, which lies down and stands up again; `press.glsl` is the twin."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Ints
from ...components.wind import Grass
from ...engine.declared.scene import Scene
from .marks import Marks, Trodden, square_of
from .trail import BEGUN, CAME, FIRST, HEADING, LAST, LEFT, REACH, STRENGTH

TREAD_FRACTION, FLAT = 0.75, 0.9
"""Fraction of the remaining way to `FLAT` by which each touch treads grass right underfoot. Flat for good is 1."""

PUSH_ALONG = 0.5
"""Push along the way in the middle of a disc, relative to the push aside at its edge."""

SAME_TOUCH = 1e-3
"""Longest gap between touches that count as one [s]."""

_LONG_AGO = -1e6

_LEAST = np.float32(1e-6)
"""Length below which a way counts as none [m]."""

_TOGETHER = 2**17
"""Number of pairs of a receiver and a mark whose distances are computed together: 6 MB of marks."""

GLSL = {
    "TREAD_FRACTION": TREAD_FRACTION,
    "FLAT": FLAT,
    "PUSH_ALONG": PUSH_ALONG,
    "SAME_TOUCH": SAME_TOUCH,
    "LONG_AGO": _LONG_AGO,
}


@dataclass(frozen=True, slots=True, eq=False)
class Lying:
    """State of receivers after the marks so far, in the order of time; arrays of shape (n,) or (n, 2)."""

    index: Floats
    """Posture index at the beginning of the last touch."""

    trodden: Floats
    """Trodden amount at the beginning of the last touch, in [0, 1]. It falls linearly with time."""

    direction: Floats
    """Direction in which grass lay at the beginning of the last touch: a unit vector, or 0."""

    depth: Floats
    """Posture index to which the last touch presses."""

    push: Floats
    """Direction in which the last touch pushes, a unit vector."""

    until: Floats
    """End of the last touch [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Touches:
    """Marks that reach receivers, one a row; arrays of shape (m,) or (m, 2)."""

    rows: NDArray[np.intp]
    """Index of each one's receiver."""

    mark: Floats
    """Marks, shape (m, COLUMNS)."""

    offset: Floats
    """Offset of the receiver from the mark's way [m]."""

    distance: Floats
    """Length of the offset [m]."""

    begun: Floats
    ended: Floats
    """Begin and end of the touch [s]."""

    def at(self, which: NDArray[np.intp], /) -> "Touches":
        """Return some of them."""
        return Touches(
            self.rows[which], self.mark[which], self.offset[which], self.distance[which],
            self.begun[which], self.ended[which],
        )  # fmt: skip


def pressed(trodden: Trodden, place: Floats, grass: Grass, recovery: Floats, /) -> Floats:
    """Return the bending of pressed grass at ground positions (n, 2) [m]: vectors (n, 2), as long as the posture index.

    Grass that swings past rest has a negative index: its vector points the other way. `recovery` has each kind's time
    to stand up again [s].
    """
    lying = _untouched(len(place))
    square = square_of(place)
    for marks in (trodden.settled, trodden.fresh):
        first, count = marks.first[square], marks.count[square]
        most = int(count.max(initial=0))
        together = max(_TOGETHER // max(len(place), 1), 1)
        for k in range(0, most, together):
            rows, after = np.nonzero(count[:, None] > np.arange(k, min(k + together, most)))
            touching = _touching(marks.marks, marks.listed[first[rows] + k + after], place, rows)
            for each in _by_rank(touching):
                _apply_marks(lying, each, grass, recovery)
    now = np.float32(trodden.time - trodden.since)
    index, _, towards = _state_at(lying, np.full(len(place), now), grass, recovery)
    return np.asarray(index[:, None] * towards, np.float32)


def combined_message(message: Floats, pressing: Floats, /) -> Floats:
    """Add the bending of pressed grass (n, 2) to messages of the wind (n, 2), which its posture index weakens."""
    index = np.minimum(np.hypot(pressing[:, 0], pressing[:, 1]), np.float32(1.0))
    total = message * (np.float32(1.0) - index)[:, None] + pressing
    return np.asarray(total / np.maximum(np.hypot(total[:, 0], total[:, 1]), np.float32(1.0))[:, None], np.float32)


def touches(marks: Marks, place: Floats, /) -> bool:
    """Return whether any ground position (n, 2) is in a square with marks."""
    return bool(marks.count[square_of(place)].any())


def recoveries(scene: Scene, /) -> Floats:
    """Return the time in which each kind of grass stands up again from trodden flat [s], shape (kinds,)."""
    return np.array([kind.recovery for kind in scene.grass.values()], np.float32)


def _untouched(count: int) -> Lying:
    """Return the state of receivers that nothing has touched."""
    index, trodden, depth = np.zeros((3, count), np.float32)
    direction, push = np.zeros((2, count, 2), np.float32)
    return Lying(index, trodden, direction, depth, push, np.full(count, _LONG_AGO, np.float32))


def _touching(marks: Floats, which: Ints, place: Floats, rows: NDArray[np.intp]) -> Touches:
    """Return those pairs of marks, of indices `which` (m,), and places, of indices `rows` (m,), that touch."""
    mark = marks[which]
    offset, distance = _offset(mark, place[rows])
    near = np.flatnonzero(distance < mark[:, REACH])
    rows, mark = rows[near], mark[near]
    return Touches(rows, mark, offset[near], distance[near], *_touch_times(mark, place[rows]))


def _by_rank(touches: Touches) -> Iterator[Touches]:
    """Yield the first touch of each row, then the second of each, and so on; rows ascend."""
    rank = np.arange(len(touches.rows)) - np.searchsorted(touches.rows, touches.rows)
    order = np.argsort(rank, kind="stable")
    begin = 0
    for count in np.bincount(rank).tolist():
        yield touches.at(order[begin : begin + count])
        begin += count


def _apply_marks(lying: Lying, touches: Touches, grass: Grass, recovery: Floats) -> None:
    """Apply touches of one mark each to different rows."""
    rows, mark, begun = touches.rows, touches.mark, touches.begun
    separate = np.flatnonzero(begun > lying.until[rows] + np.float32(SAME_TOUCH))
    if len(separate):
        touched = rows[separate]
        old = Lying(
            lying.index[touched], lying.trodden[touched], lying.direction[touched],
            lying.depth[touched], lying.push[touched], lying.until[touched],
        )  # fmt: skip
        index, trodden, towards = _state_at(old, begun[separate], grass.at(touched), recovery)
        lying.index[touched], lying.trodden[touched] = np.maximum(index, np.float32(0.0)), trodden
        lying.direction[touched] = towards
        lying.depth[touched], lying.until[touched] = 0.0, _LONG_AGO
    fraction = touches.distance / mark[:, REACH]
    depth = mark[:, STRENGTH] * (np.float32(1.0) - fraction * fraction * fraction * fraction)
    deeper = np.flatnonzero(depth > lying.depth[rows])
    lying.depth[rows[deeper]] = depth[deeper]
    lying.push[rows[deeper]] = _push_direction(touches.offset[deeper], fraction[deeper], mark[deeper])
    lying.until[rows] = np.maximum(lying.until[rows], touches.ended)


def _offset(mark: Floats, place: Floats) -> tuple[Floats, Floats]:
    """Return the offsets (n, 2) [m] of places from the ways of marks, and their lengths."""
    from_first, along, length, ahead = _ahead(mark, place)
    offset = from_first - np.clip(ahead, np.float32(0.0), length)[:, None] * along
    return offset, np.sqrt(offset[:, 0] * offset[:, 0] + offset[:, 1] * offset[:, 1])


def _ahead(mark: Floats, place: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the offsets (n, 2) [m] of places from where marks begin, and their parts along the marks' ways.

    Between the two are the directions (n, 2) and the lengths of these ways.
    """
    from_first, way = place - mark[:, FIRST], mark[:, LAST] - mark[:, FIRST]
    length = np.sqrt(way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1])
    along = way / np.maximum(length, _LEAST)[:, None]
    return from_first, along, length, from_first[:, 0] * along[:, 0] + from_first[:, 1] * along[:, 1]


def _touch_times(mark: Floats, place: Floats) -> tuple[Floats, Floats]:
    """Return begin and end of each touch: from the arrival of the disc's edge at a place (n, 2) until it leaves [s]."""
    from_first, along, length, ahead = _ahead(mark, place)
    lateral = from_first[:, 0] * along[:, 1] - from_first[:, 1] * along[:, 0]
    is_still, safe_length = length < _LEAST, np.maximum(length, _LEAST)
    half = np.sqrt(np.maximum(mark[:, REACH] * mark[:, REACH] - lateral * lateral, np.float32(0.0)))
    enters, leaves = (ahead - half) / safe_length, (ahead + half) / safe_length
    duration = mark[:, CAME] - mark[:, BEGUN]
    entered = np.clip(enters, np.float32(0.0), np.float32(1.0))
    begun = mark[:, BEGUN] + np.where(is_still, np.float32(0.0), entered * duration)
    ended = np.where(is_still | (leaves >= np.float32(1.0)), mark[:, LEFT], mark[:, BEGUN] + leaves * duration)
    return begun, ended


def _push_direction(offset: Floats, fraction: Floats, mark: Floats) -> Floats:
    """Return the direction of the push, unit vectors (n, 2): aside at the disc's edge, along the way in its middle."""
    along = np.float32(PUSH_ALONG) * (np.float32(1.0) - fraction)
    towards = offset / mark[:, REACH, None] + along[:, None] * mark[:, HEADING]
    return _normalised(np.asarray(towards, np.float32))


def _state_at(lying: Lying, then: Floats, grass: Grass, recovery: Floats) -> tuple[Floats, Floats, Floats]:
    """Return posture index, trodden amount and direction (n, 2) of grass at the instants `then` (n,) [s]."""
    elapsed = np.maximum(then - lying.until, np.float32(0.0))
    index_before = np.maximum(lying.index, _lasting_index(lying.trodden))
    flat = np.float32(FLAT) * (lying.depth * lying.depth) * (lying.depth * lying.depth)
    step = np.float32(TREAD_FRACTION) * np.maximum(flat - lying.trodden, np.float32(0.0))
    trodden = np.asarray(lying.trodden + step, np.float32)
    left = np.maximum(trodden - elapsed / recovery[grass.kind], np.float32(0.0))
    swinging = np.maximum(lying.depth, index_before) - _lasting_index(trodden)
    index = swinging * grass.after_stop(elapsed) + _lasting_index(left)
    towards = lying.depth[:, None] * lying.push + index_before[:, None] * lying.direction
    return np.asarray(index, np.float32), np.asarray(left, np.float32), _normalised(np.asarray(towards, np.float32))


def _lasting_index(trodden: Floats) -> Floats:
    """Return the posture index at which trodden grass lies for now: near flat, it falls slowly."""
    return np.asarray(trodden * (np.float32(2.0) - trodden), np.float32)


def _normalised(vector: Floats) -> Floats:
    """Return vectors (n, 2) scaled to length 1; 0 stays 0."""
    length = np.sqrt(vector[:, 0] * vector[:, 0] + vector[:, 1] * vector[:, 1])
    return np.asarray(vector / np.maximum(length, np.float32(1e-9))[:, None], np.float32)
