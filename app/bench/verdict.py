"""Verdicts: how much a frame's changes of representation show, where they are the most prominent."""

from dataclasses import dataclass

import numpy as np

from ..studio.encode import Picture
from .flicker import LEAST, MARGIN, TILE, change_of_tile, low_passed, prominence, step
from .stroll import Moment
from .truth import Truth


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A frame of the walk, the one before it, and what it would be without its changes of representation."""

    earlier: Moment
    moment: Moment
    before: Picture
    now: Picture
    held: Picture

    changing: int
    """Patches in transition."""


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """The tile of a frame in which changes of representation are the most prominent."""

    step: Step

    corner: tuple[int, int]
    """Column and row of the tile's first pixel, from the top left."""

    flicker: float
    """How far the frame's change is from the reference's [steps of 255]."""

    steady: float
    """The same for the frame held: what it would be without its changes of representation; `LEAST` at least."""

    jump: float
    """How much those changed the frame [steps of 255]."""

    @property
    def ratio(self) -> float:
        """How many times the flicker is what it would be without them."""
        return self.flicker / self.steady


def judge(one: Step, truth: Truth, /, *, unless_below: float = 0.0) -> Verdict | None:
    """Return a verdict on a frame, or None where its ratio cannot be larger than `unless_below`.

    The frame differs from the held one by its step. So its flicker exceeds the held one's by no more than that,
    wherever the reference may be.
    """
    kept = low_passed(one.held)
    jumps = step(low_passed(one.now), kept)
    if 1.0 + float(jumps.max()) / LEAST <= unless_below:
        return None
    found = prominence(jumps, kept, low_passed(one.before))
    row, column = divmod(int(np.argmax(found)), found.shape[1])
    corner = MARGIN + 1 + TILE * column, MARGIN + 1 + TILE * row
    true_before, true_now = truth.tile(one.earlier, corner), truth.tile(one.moment, corner)
    before, now, held = (_around(picture, corner) for picture in (one.before, one.now, one.held))
    flicker = change_of_tile(now, before, true_now, true_before)
    steady = max(change_of_tile(held, before, true_now, true_before), LEAST)
    return Verdict(one, corner, flicker, steady, float(jumps[row, column]))


def _around(picture: Picture, corner: tuple[int, int]) -> Picture:
    left, top = corner[0] - 1, corner[1] - 1
    return picture[top : top + TILE + 2, left : left + TILE + 2]
