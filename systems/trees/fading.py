"""Trees felled just now: their shade fades step by step, and grass returns to the sun and grows again."""

from typing import NamedTuple

import numpy as np

from .forest import Rows
from .standing import STANDING

DURATION = 1.6
"""Time until their shade is gone [s]."""

STEPS = 8
"""Number of steps it fades in: in each, grass is planted anew."""


class Fading(NamedTuple):
    """A felled tree whose shade is fading."""

    row: np.void
    """The tree as it stood, a record of `STANDING`."""

    since: float
    """Time at which it was felled [s]."""


class FadingShade:
    """Felled trees whose shade is still fading."""

    def __init__(self) -> None:
        self._trees: list[Fading] = []
        self._steps_left: list[int] = []
        self.version = 0
        """Number of changes of any tree's shade."""

    def fell(self, rows: Rows, /, *, time: float) -> None:
        """Begin to fade the shade of trees, records of `STANDING`, at a time [s]."""
        self._trees += [Fading(row, time) for row in rows]
        self._steps_left += [STEPS] * len(rows)
        self.version += 1

    def step(self, time: float, /) -> bool:
        """Fade up to a time [s]; return whether any shade has changed."""
        self._trees = [each for each in self._trees if 0.0 <= time - each.since < DURATION]
        steps_left = [STEPS - int(STEPS * (time - each.since) / DURATION) for each in self._trees]
        changed, self._steps_left = steps_left != self._steps_left, steps_left
        self.version += changed
        return changed

    def rows(self) -> Rows:
        """Return trees whose foliage gives the shade that is left, records of `STANDING`."""
        rows = np.array([each.row for each in self._trees], STANDING)
        rows["foliage"] *= np.array(self._steps_left) / np.float32(STEPS)
        return rows

    def forget(self) -> None:
        """Drop all shade at once."""
        self._trees, self._steps_left = [], []

    def __len__(self) -> int:
        return len(self._trees)
