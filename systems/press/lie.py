"""How pressed grass lies and stands up again; `press.glsl` is the twin."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.wind import Grass
from ...engine.declared.scene import Scene
from .marks import Marks, Trodden, square_of
from .trail import BEGUN, CAME, FIRST, HEADING, LAST, LEFT, REACH, STRENGTH

TREADS, FLAT = 0.75, 0.9
"""Fraction of the remaining way to `FLAT` by which each touch treads grass right underfoot. Flat for good is 1."""

AHEAD = 0.5
"""Push along the way in the middle of a disc, relative to the push aside at its edge."""

SAME = 1e-3
"""Longest gap between touches that count as one [s]."""

_LONG_AGO = -1e6

GLSL = {"TREADS": TREADS, "FLAT": FLAT, "AHEAD": AHEAD, "SAME": SAME, "LONG_AGO": _LONG_AGO}


@dataclass(frozen=True, slots=True, eq=False)
class Lying:
    """State of receivers after the marks so far, in the order of time; arrays of shape (n,) or (n, 2)."""

    was: Floats
    """Posture index at the beginning of the last touch."""

    trod: Floats
    """Trodden amount at the beginning of the last touch, in [0, 1]. It falls linearly with time."""

    lay: Floats
    """Direction in which grass lay at the beginning of the last touch: a unit vector, or 0."""

    deep: Floats
    """Posture index to which the last touch presses."""

    aside: Floats
    """Direction in which the last touch pushes, a unit vector."""

    until: Floats
    """End of the last touch [s]."""


def pressed(trodden: Trodden, place: Floats, grass: Grass, recovery: Floats, /) -> Floats:
    """Return the bending of pressed grass at ground positions (n, 2) [m]: vectors (n, 2) as long as the posture index.

    Grass that swings past rest has a negative index: its vector points the other way. `recovery` has each kind's time
    to stand up again [s].
    """
    lying = _at_rest(len(place))
    square = square_of(place)
    for marks in (trodden.settled, trodden.fresh):
        first, count = marks.first[square], marks.count[square]
        for k in range(int(count.max(initial=0))):
            rows = np.flatnonzero(count > k)
            _touch(lying, rows, marks.marks[marks.listed[first[rows] + k]], place[rows], grass.at(rows), recovery)
    now = np.float32(trodden.time - trodden.since)
    index, _, towards = _left(lying, np.full(len(place), now), grass, recovery)
    return np.asarray(index[:, None] * towards, np.float32)


def laid_over(message: Floats, pressing: Floats, /) -> Floats:
    """Blend messages of the wind (n, 2) with the bending of pressed grass (n, 2), which weakens the wind by its index."""
    index = np.minimum(np.hypot(pressing[:, 0], pressing[:, 1]), np.float32(1.0))
    both = message * (np.float32(1.0) - index)[:, None] + pressing
    return np.asarray(both / np.maximum(np.hypot(both[:, 0], both[:, 1]), np.float32(1.0))[:, None], np.float32)


def touches(marks: Marks, place: Floats, /) -> bool:
    """Return whether any ground position (n, 2) is in a square with marks."""
    return bool(marks.count[square_of(place)].any())


def recoveries(scene: Scene, /) -> Floats:
    """Return the time in which each kind of grass stands up again from trodden flat [s], shape (kinds,)."""
    return np.array([kind.recovery for kind in scene.grass.values()], np.float32)


def _at_rest(count: int) -> Lying:
    """Return the state of receivers that nothing has touched."""
    was, trod, deep = np.zeros((3, count), np.float32)
    lay, aside = np.zeros((2, count, 2), np.float32)
    return Lying(was, trod, lay, deep, aside, np.full(count, _LONG_AGO, np.float32))


def _touch(lying: Lying, rows: NDArray[np.intp], mark: Floats, place: Floats, grass: Grass, recovery: Floats) -> None:
    """Apply one mark (n, NUMBERS) to each of these rows that it reaches."""
    off, far, begun, ended = _passing(mark, place)
    near = far < mark[:, REACH]
    if not near.any():
        return
    rows, mark, off = rows[near], mark[near], off[near]
    far, begun, ended = far[near], begun[near], ended[near]
    anew = np.flatnonzero(begun > lying.until[rows] + np.float32(SAME))
    if len(anew):
        again = rows[anew]
        old = Lying(
            lying.was[again], lying.trod[again], lying.lay[again], lying.deep[again], lying.aside[again],
            lying.until[again],
        )  # fmt: skip
        of_these = grass.at(np.flatnonzero(near)[anew])
        was, trod, towards = _left(old, begun[anew], of_these, recovery)
        lying.was[again], lying.trod[again], lying.lay[again] = np.maximum(was, np.float32(0.0)), trod, towards
        lying.deep[again], lying.until[again] = 0.0, _LONG_AGO
    part = far / mark[:, REACH]
    deep = mark[:, STRENGTH] * (np.float32(1.0) - part * part * part * part)
    more = np.flatnonzero(deep > lying.deep[rows])
    lying.deep[rows[more]] = deep[more]
    lying.aside[rows[more]] = _away(off[more], part[more], mark[more])
    lying.until[rows] = np.maximum(lying.until[rows], ended)


def _passing(mark: Floats, place: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the offsets of places from a mark's nearest point (n, 2), their lengths [m], and begin and end of the touch.

    These are the times at which the disc's edge arrives and leaves [s], shape (n,).
    """
    from_first, way = place - mark[:, FIRST], mark[:, LAST] - mark[:, FIRST]
    long = np.sqrt(way[:, 0] * way[:, 0] + way[:, 1] * way[:, 1])
    short = np.maximum(long, np.float32(1e-6))
    along = way / short[:, None]
    at = from_first[:, 0] * along[:, 0] + from_first[:, 1] * along[:, 1]
    aside = from_first[:, 0] * along[:, 1] - from_first[:, 1] * along[:, 0]
    off = from_first - np.clip(at, np.float32(0.0), long)[:, None] * along
    far = np.sqrt(off[:, 0] * off[:, 0] + off[:, 1] * off[:, 1])
    still = long < np.float32(1e-6)
    half = np.sqrt(np.maximum(mark[:, REACH] * mark[:, REACH] - aside * aside, np.float32(0.0)))
    enter, leave = (at - half) / short, (at + half) / short
    took = mark[:, CAME] - mark[:, BEGUN]
    begun = mark[:, BEGUN] + np.where(still, np.float32(0.0), np.clip(enter, np.float32(0.0), np.float32(1.0)) * took)
    ended = np.where(still | (leave >= np.float32(1.0)), mark[:, LEFT], mark[:, BEGUN] + leave * took)
    return off, far, begun, ended


def _away(off: Floats, part: Floats, mark: Floats) -> Floats:
    """Return the direction of the push, unit vectors (n, 2): aside at the disc's edge, along the way in its middle."""
    towards = off / mark[:, REACH, None] + (np.float32(AHEAD) * (np.float32(1.0) - part))[:, None] * mark[:, HEADING]
    return _unit(np.asarray(towards, np.float32))


def _left(lying: Lying, then: Floats, grass: Grass, recovery: Floats) -> tuple[Floats, Floats, Floats]:
    """Return posture index, trodden amount and direction (n, 2) of grass at the instants `then` (n,) [s]."""
    elapsed = np.maximum(then - lying.until, np.float32(0.0))
    before = np.maximum(lying.was, _stays(lying.trod))
    flat = np.float32(FLAT) * (lying.deep * lying.deep) * (lying.deep * lying.deep)
    trod = np.asarray(lying.trod + np.float32(TREADS) * np.maximum(flat - lying.trod, np.float32(0.0)), np.float32)
    left = np.maximum(trod - elapsed / recovery[grass.kind], np.float32(0.0))
    index = (np.maximum(lying.deep, before) - _stays(trod)) * grass.after_stop(elapsed) + _stays(left)
    towards = lying.deep[:, None] * lying.aside + before[:, None] * lying.lay
    return np.asarray(index, np.float32), np.asarray(left, np.float32), _unit(np.asarray(towards, np.float32))


def _stays(trod: Floats) -> Floats:
    """Return the posture index at which trodden grass stays: it rises slowly from flat at first."""
    return np.asarray(trod * (np.float32(2.0) - trod), np.float32)


def _unit(vector: Floats) -> Floats:
    """Return vectors (n, 2) scaled to length 1; 0 stays 0."""
    long = np.sqrt(vector[:, 0] * vector[:, 0] + vector[:, 1] * vector[:, 1])
    return np.asarray(vector / np.maximum(long, np.float32(1e-9))[:, None], np.float32)
