"""Trees that were felled just now: their shade goes by and by, and grass comes back into the sun, and grows again."""

from typing import NamedTuple

import numpy as np

from .forest import Rows
from .standing import STANDING

LASTS = 1.6
"""How long their shade takes to go [s]."""

STEPS = 8
"""In how many steps it goes: in each, grass is planted anew."""


class Felled(NamedTuple):
    """A tree that is gone."""

    row: np.void
    """It, as it stood: a record of `STANDING`."""

    since: float
    """When it was felled [s]."""


class Going:
    """Felled trees whose shade is still there, and how much of it."""

    def __init__(self) -> None:
        self._felled: list[Felled] = []
        self._left: list[int] = []
        self.changes = 0
        """How often another part of it was left than before."""

    def fell(self, rows: Rows, /, *, time: float) -> None:
        """Let the shade of trees, records of `STANDING`, go from a time on [s]."""
        self._felled += [Felled(row, time) for row in rows]
        self._left += [STEPS] * len(rows)
        self.changes += 1

    def step(self, time: float, /) -> bool:
        """Let it go up to a time [s]; return whether another part of it is left than before."""
        self._felled = [each for each in self._felled if 0.0 <= time - each.since < LASTS]
        left = [STEPS - int(STEPS * (time - each.since) / LASTS) for each in self._felled]
        changed, self._left = left != self._left, left
        self.changes += changed
        return changed

    def rows(self) -> Rows:
        """Return trees that give as much shade as is left, records of `STANDING`."""
        rows = np.array([each.row for each in self._felled], STANDING)
        rows["foliage"] *= np.array(self._left) / np.float32(STEPS)
        return rows

    def forget(self) -> None:
        """Let all of it be gone."""
        self._felled, self._left = [], []

    def __len__(self) -> int:
        return len(self._felled)
