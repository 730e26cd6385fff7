"""Levels of detail: which representation each patch has, and how far a change of it has gone."""

import numpy as np
from numpy.typing import NDArray

from ..components.patch import PatchTable
from ..components.quality import Representation

FADE = 0.9
"""How long a change of representation takes [s]: less than a walker needs to cross a patch (paper, section 4.1)."""

BORDER = 4.0
"""Over how many patches the strips give way to the carpet."""

SLACK = 1
"""How many patches farther a patch must be to go to the coarser representation than to come back from it."""

ROOM = 2
"""How many patches farther than that a patch may still be changing; a viewer who is faster leaves no change unfinished,
because there is no room for its grass in the pools."""


def wanted_representation(
    distance: NDArray[np.int32], current: NDArray[np.int8], /, *, reach: tuple[int, int, int]
) -> NDArray[np.int8]:
    """Return the representation due at each discrete distance, shape (n,).

    A patch keeps a finer representation for `SLACK` patches beyond its reach, so that a walker who stands on a
    limit leaves nothing in transition (paper, section 4.1). `current` is -1 for a patch that has none yet.
    """
    blades, strips, _ = reach
    due = (distance > blades).astype(np.int8) + (distance > strips).astype(np.int8)
    late = (distance > blades + SLACK).astype(np.int8) + (distance > strips + SLACK).astype(np.int8)
    keeps = (current >= 0) & (current < due)
    return np.where(keeps, np.maximum(late, current), due).astype(np.int8)


def farthest(reach: tuple[int, int, int], /) -> tuple[int, int]:
    """Return the largest discrete distance at which blades, and at which strips, are ever shown."""
    blades, strips, _ = reach
    return blades + SLACK + ROOM, strips + SLACK + ROOM


def schedule(
    table: PatchTable,
    wanted: NDArray[np.int8],
    was_visible: NDArray[np.bool_],
    /,
    *,
    reach: tuple[int, int, int],
    dt: float,
) -> None:
    """Advance changes of representation and start those that are due (paper, section 4.1).

    A patch that was visible changes over `FADE` seconds; one that was not takes its representation at once, as does one
    that is left behind farther than `ROOM`. A change that turns back in its middle goes back from where it is.
    """
    table.progress[:] = np.minimum(table.progress + np.float32(dt / FADE), 1.0)
    behind = _left_behind(table, reach)
    table.progress[behind] = 1.0
    over = table.progress >= 1.0
    table.previous[over] = table.representation[over]
    due = table.alive & (wanted != table.representation)
    slowly = was_visible & (table.representation >= 0) & ~behind
    seen = due & slowly
    back = seen & ~over & (wanted == table.previous)
    start = seen & over
    at_once = due & ~slowly
    table.previous[back], table.representation[back] = table.representation[back], table.previous[back]
    table.progress[back] = 1.0 - table.progress[back]
    table.previous[start] = table.representation[start]
    table.progress[start] = 0.0
    table.previous[at_once] = wanted[at_once]
    table.progress[at_once] = 1.0
    changed = start | at_once
    table.representation[changed] = wanted[changed]


def _left_behind(table: PatchTable, reach: tuple[int, int, int]) -> NDArray[np.bool_]:
    """Return which patches are too far away for a representation that they have or come from, shape (rows,)."""
    limit = np.array([*farthest(reach), np.iinfo(np.int32).max], np.int32)
    finest = np.minimum(limit[table.representation], limit[table.previous])
    return np.asarray(table.distance > finest)


def weights(table: PatchTable, /) -> NDArray[np.float32]:
    """Return how much each representation shows on each patch, shape (3, rows): they sum to 1, or 0 where none is."""
    shown = np.zeros((len(Representation), len(table.progress)), np.float32)
    for level in Representation:
        shown[level] = np.where(table.representation == level, table.progress, 0.0)
        shown[level] += np.where(table.previous == level, 1.0 - table.progress, 0.0)
    return shown


def thinned_out(shown: NDArray[np.float32], away: NDArray[np.float32], /, *, reach: int) -> NDArray[np.float32]:
    """Return the shares (3, rows) with the strips' outermost `BORDER` patches handed over to the carpet by and by.

    `away` is the patches' distance from the viewer [patch sides], shape (rows,). So no line shows where the strips
    end, and a patch that changes between the two far away has next to nothing to change.
    """
    kept = np.clip((reach + 0.5 - away) / BORDER, 0.0, 1.0).astype(np.float32)
    handed = shown[Representation.STRIPS] * (1.0 - kept)
    result = shown.copy()
    result[Representation.STRIPS] -= handed
    result[Representation.CARPET] = np.minimum(result[Representation.CARPET] + handed, 1.0)
    return result
