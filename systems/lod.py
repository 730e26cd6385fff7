"""Levels of detail: which representation each patch has, and how far a change of it has gone."""

import numpy as np
from numpy.typing import NDArray

from ..engine.declared.quality import Representation
from .patches import PatchTable

Floats = NDArray[np.float32]
Levels = NDArray[np.int8]
Mask = NDArray[np.bool_]

FADE = 1.2
"""How long a change of representation takes at most [s]."""

STRETCH = 0.8
"""Part of a patch that a walker may cross meanwhile: a change is over sooner than a patch is crossed (paper, 4.1)."""

SLACK = 1
"""How many patches farther a patch must be to go to the coarser representation than to come back from it."""

ROOM = 2
"""How many patches farther than that a patch may still be changing; a viewer who is faster leaves no change unfinished,
because there is no room for its grass in the pools."""


def wanted_representation(
    distance: NDArray[np.int32], current: Levels, /, *, reach: tuple[int, int, int], slack: int = SLACK
) -> Levels:
    """Return the representation due at each discrete distance, shape (n,).

    A patch keeps a finer representation for `slack` patches beyond its reach, so that a walker who stands on a
    limit leaves nothing in transition (paper, section 4.1). `current` is -1 for a patch that has none yet.
    """
    blades, strips, _ = reach
    due = (distance > blades).astype(np.int8) + (distance > strips).astype(np.int8)
    late = (distance > blades + slack).astype(np.int8) + (distance > strips + slack).astype(np.int8)
    keeps = (current >= 0) & (current < due)
    return np.where(keeps, np.maximum(late, current), due).astype(np.int8)


def farthest(reach: tuple[int, int, int], /) -> tuple[int, int]:
    """Return the largest discrete distance at which blades, and at which strips, are ever shown."""
    blades, strips, _ = reach
    return blades + SLACK + ROOM, strips + SLACK + ROOM


def part_of_change(dt: float, /, *, way: float, patch: float) -> float:
    """Return what part of a change is made in `dt` seconds by a walker who goes `way` metres meanwhile.

    A change takes `FADE` seconds, or as long as it takes to cross `STRETCH` of a patch [m], whichever is shorter.
    """
    return max(dt / FADE, way / (STRETCH * patch))


def move_on(now: Levels, before: Levels, progress: Floats, wanted: Levels, slowly: Mask, /, *, part: float) -> None:
    """Advance changes from `before` to `now` by `part`, and start those that are wanted; all have shape (n,).

    Where not `slowly`, what is wanted is there at once. A change that turns back in its middle goes back from where it
    is; another that is wanted meanwhile waits until it is over.
    """
    progress += np.float32(min(part, 2.0))
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


def schedule(
    table: PatchTable, wanted: Levels, was_visible: Mask, /, *, reach: tuple[int, int, int], part: float
) -> None:
    """Advance changes of representation by `part` and start those that are due (paper, section 4.1).

    A patch that is not visible, or was not, takes its representation at once, as does one that is left behind farther
    than `ROOM`.
    """
    slowly = was_visible & table.visible & (table.representation >= 0) & ~_left_behind(table, reach)
    due = np.where(table.alive, wanted, table.representation)
    move_on(table.representation, table.previous, table.progress, due, slowly, part=part)


def _left_behind(table: PatchTable, reach: tuple[int, int, int]) -> Mask:
    """Return which patches are too far away for a representation that they have or come from, shape (rows,)."""
    limit = np.array([*farthest(reach), np.iinfo(np.int32).max], np.int32)
    finest = np.minimum(limit[table.representation], limit[table.previous])
    return np.asarray(table.distance > finest)


def weights(table: PatchTable, /) -> Floats:
    """Return how far each patch is each representation, shape (3, rows): they sum to 1, or 0 where none is."""
    shown = np.zeros((len(Representation), len(table.progress)), np.float32)
    for level in Representation:
        shown[level] = np.where(table.representation == level, table.progress, 0.0)
        shown[level] += np.where(table.previous == level, 1.0 - table.progress, 0.0)
    return shown
