"""Transitions: patches on their way from one representation to another (paper, section 4.1)."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..components.arrays import Floats, Levels, Mask, Rows
from .around.outlook import Outlook
from .around.pace import change_step
from .around.patches import PatchTable
from .around.transitions import SEAMLESS, Transitions
from .lod import SLACK, farthest, inputs_of
from .show.representation import Representation

FADE = 1.2
"""Longest duration of a change of representation [s]."""

STRETCH = 0.8
"""Fraction of a patch that a walker crosses during a change: it is over before the patch is crossed (paper, 4.1)."""


def step_of_change(dt: float, /, *, way: float, patch: float) -> float:
    """Return the part of a change made in `dt` seconds, in which the walker goes `way` metres; `patch` is a side [m].

    A change takes `FADE` seconds, or the time to cross `STRETCH` of a patch, whichever is shorter.
    """
    return max(dt / FADE, way / (STRETCH * patch))


def move_on(now: Levels, before: Levels, progress: Floats, wanted: Levels, slowly: Mask, /, *, step: float) -> None:
    """Advance changes from `before` to `now` by `step`, and start those to `wanted`; all arrays have shape (n,).

    Where not `slowly`, `wanted` is reached at once. A change reversed half-way goes back from its present progress. If
    a third level is wanted during a change, it waits for the change to end.
    """
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


def unsettled(now: Levels, before: Levels, progress: Floats, wanted: Levels, /) -> Rows:
    """Return the indices that are changing or have to change, shape (m,); for all others `move_on` does nothing."""
    going: Mask = (wanted != now) | (before != now) | (progress < 1.0)
    return going.nonzero()[0]


def move_rows(
    now: Levels, before: Levels, progress: Floats, rows: Rows, wanted: Levels, slowly: Mask, /, *, step: float
) -> None:
    """Apply `move_on` to some rows (m,) of three columns; `wanted` and `slowly` have shape (m,)."""
    moved = now[rows], before[rows], progress[rows]
    move_on(*moved, wanted, slowly, step=step)
    now[rows], before[rows], progress[rows] = moved


def change(patches: PatchTable, wanted: Levels, settled: Mask, /, *, reach: tuple[int, ...], step: float) -> None:
    """Advance changes of representation by `step` and start those that are due (paper, section 4.1).

    A patch changes at once if it is not `settled` and visible, or is farther away than pools have room for.
    """
    now, before, progress = patches.representation, patches.previous, patches.progress
    rows = unsettled(now, before, progress, wanted)
    rows = rows[patches.alive[rows]]
    if rows.size:
        slowly = (settled & patches.visible)[rows] & (now[rows] >= 0) & ~_left_behind(patches, rows, reach)
        move_rows(now, before, progress, rows, wanted[rows], slowly, step=step)


def held(patches: PatchTable, /, *, reach: tuple[int, ...]) -> Levels:
    """Return the representation that each patch is to have, shape (rows,): the one it is held in, or the wanted one.

    If pools have no room for it, it is the finest for which they have; if none is wanted, the coarsest.
    """
    chosen, rows = patches.wanted.copy(), (patches.hold >= 0).nonzero()[0]
    chosen[rows] = patches.hold[rows]
    np.minimum(chosen.view(np.uint8), len(reach) - 1, out=chosen.view(np.uint8))  # unsigned, -1 (none) is the largest
    finest = np.zeros(len(chosen), np.int8)
    for limit in reach[:-1]:
        finest += patches.distance > limit + SLACK + 1  # from there on there is still room to come back slowly
    return np.maximum(chosen, finest)


def is_over(patches: PatchTable, /) -> bool:
    """Return whether no change is under way, so that a frame does not depend on its duration."""
    return bool((patches.progress >= 1.0).all() and (patches.sublevel_progress >= 1.0).all())


def unfinished(patches: PatchTable, wanted: Levels, /, *, reach: tuple[int, ...], step: float) -> Mask:
    """Return whether each patch must end a change of sub-level before it changes its representation, shape (rows,).

    So blades morph to the painted places of a single sub-level. A patch does not wait if its change ends in this
    `step`, or if it is farther away than pools have room for.
    """
    now, last = patches.representation, len(patches.names) - 1
    rows = ((now != wanted) & (patches.progress >= 1.0)).nonzero()[0]
    from_, to = now[rows], wanted[rows]
    rows = rows[(from_ >= 0) & (from_ < last) & (to >= 0) & (to < last)]
    rows = rows[patches.sublevel_progress[now[rows], rows] + step < 1.0]
    waits = np.zeros(len(now), np.bool_)
    waits[rows[~_left_behind(patches, rows, reach)]] = True
    return waits


def _left_behind(patches: PatchTable, rows: Rows, reach: tuple[int, ...]) -> Mask:
    """Return whether pools lack room, so far away, for a representation that patches (n,) have or come from, (n,)."""
    limit = np.array([*farthest(reach), np.iinfo(np.int32).max], np.int32)
    finest = np.minimum(limit[patches.representation[rows]], limit[patches.previous[rows]])
    return np.asarray(patches.distance[rows] > finest)


def weights(patches: PatchTable, rows: Rows | slice = slice(None), /) -> Floats:
    """Return the weight of each representation on each patch, shape (representations, rows); they sum to 1 or 0."""
    now, before, progress = (column[rows] for column in (patches.representation, patches.previous, patches.progress))
    left = np.float32(1.0) - progress
    shown = np.empty((len(patches.names), len(progress)), np.float32)
    for level in range(len(shown)):
        np.add((now == level) * progress, (before == level) * left, out=shown[level])
    return shown


def refine(
    outlook: Outlook,
    representations: tuple[Representation, ...],
    waits: Mask,
    /,
    *,
    step: float,
    transitions: Transitions,
) -> None:
    """Advance changes of sub-levels by `step` and start those that are due.

    A representation that does not show takes its sub-level at once. While a patch changes between two representations
    that stand on the ground, no sub-level changes, so that each blade keeps its painted place. Patches that wait
    (rows,) go to the nearer end of their change. Patches that are not visible or do not have the representation end
    their changes and begin no others: their sub-levels will be chosen anew.
    """
    patches, last = outlook.patches, len(representations) - 1
    seen = patches.alive & patches.visible
    for level, representation in enumerate(representations[:last]):
        has = (patches.representation == level) | (patches.previous == level)
        rows = ((seen & has) | (patches.sublevel_progress[level] < 1.0)).nonzero()[0]
        if rows.size:
            _refine(outlook, representation, level, rows, waits[rows], step=step, transitions=transitions)


def _refine(
    outlook: Outlook,
    representation: Representation,
    level: int,
    rows: Rows,
    waits: Mask,
    *,
    step: float,
    transitions: Transitions,
) -> None:
    """Advance and start changes of the sub-levels of one representation on some rows of the patch table."""
    patches = outlook.patches
    now, before, progress = (
        levels[level] for levels in (patches.sublevel, patches.sublevel_before, patches.sublevel_progress)
    )
    present, (slowly, between) = now[rows], _standing(patches, rows, level)
    slowly &= (patches.was_visible & patches.visible)[rows] & (present >= 0) & (not outlook.viewer.jumped)
    slack = SLACK if transitions.hysteresis else 0
    due = representation.sublevels(outlook, rows, np.where(slowly, present, np.int8(-1)), slack=slack)
    slowly &= transitions.gradual
    wanted = np.where(between & slowly, present, due)
    nearer = np.where(progress[rows] < 0.5, before[rows], present)
    wanted = np.where(waits & slowly, nearer, wanted)
    here = unsettled(present, before[rows], progress[rows], wanted)
    if here.size:
        progress[rows[between]] = 1.0
        move_rows(now, before, progress, rows[here], wanted[here], slowly[here], step=step)


def _standing(patches: PatchTable, rows: Rows, level: int) -> tuple[Mask, Mask]:
    """Return whether patches (n,) show a representation, and whether they change between two that stand on the ground.

    Both have shape (n,).
    """
    now, before, progress = (column[rows] for column in (patches.representation, patches.previous, patches.progress))
    come, going = progress > 0.0, progress < 1.0

    def shows(number: int) -> Mask:  # where its weight is above 0
        return np.asarray(((now == number) & come) | ((before == number) & going))

    return shows(level), going & (now != before) & ~shows(len(patches.names) - 1)


@dataclass(slots=True)
class Transition:
    """The system `transition`: the state machine that moves patches to the representation that is due.

    No other system writes a patch's representation and sub-level. A held patch goes to the representation that it is
    held in, whatever is wanted.
    """

    outlooks: Iterable[Outlook]
    representations: tuple[Representation, ...]
    reach: tuple[int, ...]
    patch: float
    """Side of a patch [m]."""

    transitions: Transitions = SEAMLESS

    def run(self) -> None:
        """Advance changes for every viewer that looks."""
        for outlook in self.outlooks:
            over = partial(is_over, outlook.patches)
            outlook.unless_at_rest(self, inputs_of(outlook), partial(self._run, outlook), settled=over)

    def _run(self, outlook: Outlook) -> None:
        patches, viewer = outlook.patches, outlook.viewer
        settled = patches.was_visible & patches.visible & (not viewer.jumped)
        step = step_of_change(change_step(viewer), way=viewer.way, patch=self.patch)
        before = patches.representation.copy()
        reach = outlook.lens.room or self.reach
        wanted = held(patches, reach=reach)
        waits = unfinished(patches, wanted, reach=reach, step=step)
        wanted[waits] = patches.representation[waits]
        change(patches, wanted, settled & self.transitions.gradual, reach=reach, step=step)
        refine(outlook, self.representations, waits, step=step, transitions=self.transitions)
        changing = (patches.progress < 1.0) | ((before != patches.representation) & settled)
        outlook.changing = int(np.count_nonzero(patches.shown & changing))
