"""Changes of level: each patch's present level, the one that it comes from, and how far it has come."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Floats, Levels, Mask, Rows


@dataclass(frozen=True, slots=True, eq=False)
class Changes:
    """Changes of representation, or of sub-level, of n patches; all arrays have shape (n,)."""

    now: Levels
    """Level to which each patch has changed or is changing, -1 for none."""

    before: Levels
    """Level before that."""

    progress: Floats
    """Progress from `before` to `now`, from 0 to 1."""

    def of(self, rows: Rows | slice, /) -> "Changes":
        """Return the changes of some patches: copies, except of a slice."""
        return Changes(self.now[rows], self.before[rows], self.progress[rows])

    def weight(self, level: int, /) -> Floats:
        """Return the weight with which each patch shows a level."""
        return np.asarray((self.now == level) * self.progress + (self.before == level) * (1.0 - self.progress))

    def shows(self, level: int, /) -> Mask:
        """Return whether each patch shows a level: whether its weight is above 0."""
        comes, goes = (self.now == level) & (self.progress > 0.0), (self.before == level) & (self.progress < 1.0)
        return np.asarray(comes | goes)

    def unsettled(self, wanted: Levels, /) -> Rows:
        """Return the indices that are changing or have to change, shape (m,): `advance` does nothing for others."""
        going: Mask = (wanted != self.now) | (self.before != self.now) | (self.progress < 1.0)
        return going.nonzero()[0]

    def advance(self, wanted: Levels, slowly: Mask, /, *, step: float) -> None:
        """Advance changes by `step`, and start those to `wanted`.

        Where not `slowly`, `wanted` is reached at once. A change reversed half-way goes back from its present progress.
        If a third level is wanted during a change, it waits for the change to end.
        """
        now, before, progress = self.now, self.before, self.progress
        progress += np.float32(min(step, 2.0))
        np.minimum(progress, np.float32(1.0), out=progress)
        settled = (progress >= 1.0) | ~slowly
        before[settled] = now[settled]
        progress[settled] = 1.0
        due = wanted != now
        back = due & ~settled & (wanted == before)
        before[back], now[back] = now[back], before[back]
        progress[back] = 1.0 - progress[back]
        start = due & settled
        now[start] = wanted[start]
        at_once = start & ~slowly
        before[at_once] = wanted[at_once]
        progress[start & slowly] = 0.0

    def advance_rows(self, rows: Rows, wanted: Levels, slowly: Mask, /, *, step: float) -> None:
        """Do what `advance` does to the patches at `rows` (m,) alone; `wanted` and `slowly` have shape (m,)."""
        moved = self.of(rows)
        moved.advance(wanted, slowly, step=step)
        self.now[rows], self.before[rows], self.progress[rows] = moved.now, moved.before, moved.progress
