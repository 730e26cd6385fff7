"""Verdicts: how visible a frame's changes of representation are, in the tile where they are most prominent."""

from dataclasses import dataclass

import numpy as np

from ..studio.encode import Picture
from .flicker import LEAST, MARGIN, TILE, change_of_tile, low_passed, prominence, step
from .stroll import Moment
from .truth import Truth


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A frame of the walk (`now`), the one `before`, and `held`: the frame without its changes of representation."""

    earlier: Moment
    moment: Moment
    before: Picture
    now: Picture
    held: Picture

    changing: int
    """Number of patches in transition."""


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """The tile of a frame in which changes of representation are most prominent."""

    step: Step

    corner: tuple[int, int]
    """Column and row of the tile's first pixel, from the top left."""

    flicker: float
    """Difference between the frame's change and the reference's change [steps of 255]."""

    steady: float
    """Flicker of the held frame, which has no changes of representation; `LEAST` at least [steps of 255]."""

    jump: float
    """Difference between the frame and the held frame [steps of 255]."""

    @property
    def ratio(self) -> float:
        """Flicker relative to the held frame's."""
        return self.flicker / self.steady


def judge(frame: Step, truth: Truth, /, *, unless_below: float = 0.0) -> Verdict | None:
    """Return a verdict on a frame, or None where its ratio cannot be larger than `unless_below`.

    Whatever the reference is, the flicker exceeds the held frame's by no more than the difference between both frames.
    """
    held_low = low_passed(frame.held)
    jumps = step(low_passed(frame.now), held_low)
    if 1.0 + float(jumps.max()) / LEAST <= unless_below:
        return None
    found = prominence(jumps, held_low, low_passed(frame.before))
    row, column = divmod(int(np.argmax(found)), found.shape[1])
    corner = MARGIN + 1 + TILE * column, MARGIN + 1 + TILE * row
    true_before, true_now = truth.tile(frame.earlier, corner), truth.tile(frame.moment, corner)
    before, now, held = (_around(picture, corner) for picture in (frame.before, frame.now, frame.held))
    flicker = change_of_tile(now, before, true_now, true_before)
    steady = max(change_of_tile(held, before, true_now, true_before), LEAST)
    return Verdict(frame, corner, flicker, steady, float(jumps[row, column]))


def _around(picture: Picture, corner: tuple[int, int]) -> Picture:
    left, top = corner[0] - 1, corner[1] - 1
    return picture[top : top + TILE + 2, left : left + TILE + 2]
