"""How grass lies where it has been pressed, and stands up again: the truth that `press.glsl` says too."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.wind import Grass
from ...engine.declared.scene import Scene
from .marks import Marks, Trodden, square_of
from .trail import BEGUN, CAME, FIRST, HEADING, LAST, LEFT, REACH, STRENGTH

TREADS, FLAT = 0.75, 0.9
"""How much of the way to `FLAT` each who comes treads the grass right underfoot; flat for good is 1."""

AHEAD = 0.5
"""How far grass in the middle of a way is taken along it, for how far it is pushed aside at the edge."""

SAME = 1e-3
"""Touches no longer apart are one [s]."""

_LONG_AGO = -1e6

GLSL = {"TREADS": TREADS, "FLAT": FLAT, "AHEAD": AHEAD, "SAME": SAME, "LONG_AGO": _LONG_AGO}


@dataclass(frozen=True, slots=True, eq=False)
class Lying:
    """What receivers have been told by marks so far, in the order of time; each of shape (n,) or (n, 2)."""

    was: Floats
    """Index at the beginning of the touch that was last."""

    trod: Floats
    """How far it was trodden then, in [0, 1]: it wears off evenly, and grass stands up slowly at first."""

    lay: Floats
    """Where grass lay then, a unit vector or nothing."""

    deep: Floats
    """How deep the touch presses it."""

    aside: Floats
    """Where to, a unit vector."""

    until: Floats
    """When the touch ends [s]."""


def pressed(trodden: Trodden, place: Floats, grass: Grass, recovery: Floats, /) -> Floats:
    """Return how grass at ground positions (n, 2) [m] is pressed: vectors (n, 2) as long as the posture index.

    Past rest they point to the other side. `recovery` [s] is that of each kind.
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
    """Return messages of the wind (n, 2) where grass is pressed as well (n, 2): as much as it is, the wind is not."""
    index = np.minimum(np.hypot(pressing[:, 0], pressing[:, 1]), np.float32(1.0))
    both = message * (np.float32(1.0) - index)[:, None] + pressing
    return np.asarray(both / np.maximum(np.hypot(both[:, 0], both[:, 1]), np.float32(1.0))[:, None], np.float32)


def touches(marks: Marks, place: Floats, /) -> bool:
    """Return whether any of these places (n, 2) is in a square that has marks."""
    return bool(marks.count[square_of(place)].any())


def recoveries(scene: Scene, /) -> Floats:
    """Return how long grass of each kind takes to stand again once it was trodden flat [s], shape (kinds,)."""
    return np.array([kind.recovery for kind in scene.grass.values()], np.float32)


def _at_rest(count: int) -> Lying:
    was, trod, deep = np.zeros((3, count), np.float32)
    lay, aside = np.zeros((2, count, 2), np.float32)
    return Lying(was, trod, lay, deep, aside, np.full(count, _LONG_AGO, np.float32))


def _touch(lying: Lying, rows: NDArray[np.intp], mark: Floats, place: Floats, grass: Grass, recovery: Floats) -> None:
    """Let one mark (n, NUMBERS) press each of these rows, where it reaches them."""
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
    """Return how places stand off the nearest point of a mark (n, 2), how far [m], and from when to when it holds them.

    The times are those at which the edge of the disc comes and goes [s], shape (n,).
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
    """Return where grass is pushed, unit vectors (n, 2): aside at the edge, along the way in its middle."""
    towards = off / mark[:, REACH, None] + (np.float32(AHEAD) * (np.float32(1.0) - part))[:, None] * mark[:, HEADING]
    return _unit(np.asarray(towards, np.float32))


def _left(lying: Lying, then: Floats, grass: Grass, recovery: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the index at an instant [s] (n,), how far it is trodden then, and where it lies: unit vectors (n, 2)."""
    elapsed = np.maximum(then - lying.until, np.float32(0.0))
    before = np.maximum(lying.was, _stays(lying.trod))
    flat = np.float32(FLAT) * (lying.deep * lying.deep) * (lying.deep * lying.deep)
    trod = np.asarray(lying.trod + np.float32(TREADS) * np.maximum(flat - lying.trod, np.float32(0.0)), np.float32)
    left = np.maximum(trod - elapsed / recovery[grass.kind], np.float32(0.0))
    index = (np.maximum(lying.deep, before) - _stays(trod)) * grass.after_stop(elapsed) + _stays(left)
    towards = lying.deep[:, None] * lying.aside + before[:, None] * lying.lay
    return np.asarray(index, np.float32), np.asarray(left, np.float32), _unit(np.asarray(towards, np.float32))


def _stays(trod: Floats) -> Floats:
    """Return the index at which trodden grass lies."""
    return np.asarray(trod * (np.float32(2.0) - trod), np.float32)


def _unit(vector: Floats) -> Floats:
    long = np.sqrt(vector[:, 0] * vector[:, 0] + vector[:, 1] * vector[:, 1])
    return np.asarray(vector / np.maximum(long, np.float32(1e-9))[:, None], np.float32)
