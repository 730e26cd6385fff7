"""Verdicts: where in a frame its changes of representation show the most, and how much."""

from dataclasses import dataclass

import numpy as np

from .flicker import LEAST, MARGIN, TILE, flicker, step
from .steps import Record, Step, Truth


@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """The tile of a frame in which changes of representation show the most."""

    step: Step

    corner: tuple[int, int]
    """Column and row of the tile's first pixel, from the top left."""

    flicker: float
    """How far the frame's change is from the reference's [steps of 255]."""

    steady: float
    """The same for the frame held: what it would be without its changes of representation."""

    jump: float
    """How much those changed the frame [steps of 255]."""

    @property
    def ratio(self) -> float:
        """How many times the flicker is what it would be without them."""
        return self.flicker / self.steady


def judge(record: Record, truth: Truth, /) -> list[Verdict]:
    """Return a verdict on every step that was kept, the worst first."""
    return sorted((_verdict(one, truth) for one in record.steps), key=lambda verdict: -verdict.ratio)


def _verdict(one: Step, truth: Truth) -> Verdict:
    true = truth.near[one.moment.time], truth.near[one.earlier.time]
    seen, steady = flicker(one.now, one.before, *true), np.maximum(flicker(one.held, one.before, *true), LEAST)
    row, column = divmod(int(np.argmax(seen / steady)), seen.shape[1])
    corner = MARGIN + 1 + TILE * column, MARGIN + 1 + TILE * row
    jump = step(one.now, one.held)
    return Verdict(one, corner, *(float(figure[row, column]) for figure in (seen, steady, jump)))
