"""Pressed grass, which lies down and stands up again; `press.glsl` is the twin."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
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


def pressed(trodden: Trodden, place: Floats, grass: Grass, recovery: Floats, /) -> Floats:
    """Return the bending of pressed grass at ground positions (n, 2) [m]: vectors (n, 2), as long as the posture index.

    Grass that swings past rest has a negative index: its vector points the other way. `recovery` has each kind's time
    to stand up again [s].
    """
    lying = _untouched(len(place))
    square = square_of(place)
    for marks in (trodden.settled, trodden.fresh):
        first, count = marks.first[square], marks.count[square]
        for k in range(int(count.max(initial=0))):
            rows = np.flatnonzero(count > k)
            _apply_mark(lying, rows, marks.marks[marks.listed[first[rows] + k]], place[rows], grass.at(rows), recovery)
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


def _apply_mark(
    lying: Lying, rows: NDArray[np.intp], mark: Floats, place: Floats, grass: Grass, recovery: Floats
) -> None:
    """Apply one mark (n, COLUMNS) to each of these rows that it reaches."""
    offset, distance, begun, ended = _contact(mark, place)
    near = distance < mark[:, REACH]
    if not near.any():
        return
    rows, mark, offset = rows[near], mark[near], offset[near]
    distance, begun, ended = distance[near], begun[near], ended[near]
    separate = np.flatnonzero(begun > lying.until[rows] + np.float32(SAME_TOUCH))
    if len(separate):
        touched = rows[separate]
        old = Lying(
            lying.index[touched], lying.trodden[touched], lying.direction[touched],
            lying.depth[touched], lying.push[touched], lying.until[touched],
        )  # fmt: skip
        touched_grass = grass.at(np.flatnonzero(near)[separate])
        index, trodden, towards = _state_at(old, begun[separate], touched_grass, recovery)
        lying.index[touched], lying.trodden[touched] = np.maximum(index, np.float32(0.0)), trodden
        lying.direction[touched] = towards
        lying.depth[touched], lying.until[touched] = 0.0, _LONG_AGO
    fraction = distance / mark[:, REACH]
    depth = mark[:, STRENGTH] * (np.float32(1.0) - fraction * fraction * fraction * fraction)
    deeper = np.flatnonzero(depth > lying.depth[rows])
    lying.depth[rows[deeper]] = depth[deeper]
    lying.push[rows[deeper]] = _push_direction(offset[deeper], fraction[deeper], mark[deeper])
    lying.until[rows] = np.maximum(lying.until[rows], ended)


def _contact(mark: Floats, place: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the offsets (n, 2) [m] of places from a mark, their lengths, and begin and end of the touch.

    The touch lasts from the arrival of the disc's edge until it leaves [s], shape (n,).
    """
    from_first, way = place - mark[:, FIRST], mark[:, LAST] - mark[:, FIRST]
    length = np.sqrt(way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1])
    safe_length = np.maximum(length, np.float32(1e-6))
    along = way / safe_length[:, None]
    ahead = from_first[:, 0] * along[:, 0] + from_first[:, 1] * along[:, 1]
    lateral = from_first[:, 0] * along[:, 1] - from_first[:, 1] * along[:, 0]
    offset = from_first - np.clip(ahead, np.float32(0.0), length)[:, None] * along
    distance = np.sqrt(offset[:, 0] * offset[:, 0] + offset[:, 1] * offset[:, 1])
    is_still = length < np.float32(1e-6)
    half = np.sqrt(np.maximum(mark[:, REACH] * mark[:, REACH] - lateral * lateral, np.float32(0.0)))
    enters, leaves = (ahead - half) / safe_length, (ahead + half) / safe_length
    duration = mark[:, CAME] - mark[:, BEGUN]
    entered = np.clip(enters, np.float32(0.0), np.float32(1.0))
    begun = mark[:, BEGUN] + np.where(is_still, np.float32(0.0), entered * duration)
    ended = np.where(is_still | (leaves >= np.float32(1.0)), mark[:, LEFT], mark[:, BEGUN] + leaves * duration)
    return offset, distance, begun, ended


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
