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
from .lod import SLACK, farthest, read_of
from .show.representation import Representation

FADE = 1.2
"""How long a change of representation takes at most [s]."""

STRETCH = 0.8
"""Part of a patch that a walker may cross meanwhile: a change is over sooner than a patch is crossed (paper, 4.1)."""


def step_of_change(dt: float, /, *, way: float, patch: float) -> float:
    """Return what part of a change is made in `dt` seconds by a walker who goes `way` metres meanwhile.

    A change takes `FADE` seconds, or as long as it takes to cross `STRETCH` of a patch [m], whichever is shorter.
    """
    return max(dt / FADE, way / (STRETCH * patch))


def move_on(now: Levels, before: Levels, progress: Floats, wanted: Levels, slowly: Mask, /, *, step: float) -> None:
    """Advance changes from `before` to `now` by `step`, and start those that are wanted; all have shape (n,).

    Where not `slowly`, what is wanted is there at once. A change that is reversed half-way goes back from where it is.
    Where a third one is wanted meanwhile, it waits until the change is over.
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
    """Return where anything is changing or has to change, shape (m,): everywhere else `move_on` would do nothing."""
    going: Mask = (wanted != now) | (before != now) | (progress < 1.0)
    return going.nonzero()[0]


def move_rows(
    now: Levels, before: Levels, progress: Floats, rows: Rows, wanted: Levels, slowly: Mask, /, *, step: float
) -> None:
    """Do to some rows (m,) of three columns what `move_on` does; `wanted` and `slowly` have shape (m,)."""
    moved = now[rows], before[rows], progress[rows]
    move_on(*moved, wanted, slowly, step=step)
    now[rows], before[rows], progress[rows] = moved


def change(patches: PatchTable, wanted: Levels, settled: Mask, /, *, reach: tuple[int, ...], step: float) -> None:
    """Advance changes of representation by `step` and start those that are due (paper, section 4.1).

    A patch that is not visible, or was not, as `settled` says, takes its representation at once, as does one that is
    left behind farther than there is room for.
    """
    now, before, progress = patches.representation, patches.previous, patches.progress
    rows = unsettled(now, before, progress, wanted)
    rows = rows[patches.alive[rows]]
    if rows.size:
        slowly = (settled & patches.visible)[rows] & (now[rows] >= 0) & ~_left_behind(patches, rows, reach)
        move_rows(now, before, progress, rows, wanted[rows], slowly, step=step)


def held(patches: PatchTable, /, *, reach: tuple[int, ...]) -> Levels:
    """Return the representation that each patch is to have, shape (rows,): the one it is held in, or the wanted one.

    Where there is no room for so fine a one, it is the finest that there is room for; where none is wanted, the
    coarsest.
    """
    chosen, rows = patches.wanted.copy(), (patches.hold >= 0).nonzero()[0]
    chosen[rows] = patches.hold[rows]
    np.minimum(chosen.view(np.uint8), len(reach) - 1, out=chosen.view(np.uint8))  # without a sign, none is coarsest
    finest = np.zeros(len(chosen), np.int8)
    for limit in reach[:-1]:
        finest += patches.distance > limit + SLACK + 1  # from there on there is still room to come back slowly
    return np.maximum(chosen, finest)


def is_over(patches: PatchTable, /) -> bool:
    """Return whether nothing is changing: what a frame does then does not depend on how long it takes."""
    return bool((patches.progress >= 1.0).all() and (patches.sublevel_progress >= 1.0).all())


def unfinished(patches: PatchTable, wanted: Levels, /, *, reach: tuple[int, ...], step: float) -> Mask:
    """Return which patches have to end a change of sub-level before they change their representation, shape (rows,).

    So blades morph to the painted places of a single sub-level. A patch does not wait where its change ends in this
    `step`, nor where it has been left behind farther than pools have room.
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
    """Return which patches (n,) are too far away for a representation that they have or come from, shape (n,)."""
    limit = np.array([*farthest(reach), np.iinfo(np.int32).max], np.int32)
    finest = np.minimum(limit[patches.representation[rows]], limit[patches.previous[rows]])
    return np.asarray(patches.distance[rows] > finest)


def weights(patches: PatchTable, rows: Rows | slice = slice(None), /) -> Floats:
    """Return how far each patch is each representation, shape (representations, rows): they sum to 1 or to 0."""
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

    Where a representation does not show, its sub-level is due at once; while a patch goes between two representations
    that stand on the ground, none changes, so that each blade keeps its painted place. Patches that wait (rows,) for
    their change to end go on to the end that is nearer. Patches that are not visible, and those without the
    representation, end their changes and begin no others: their sub-levels will be due anew.
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
    has, (shows, both) = now[rows], _standing(patches, rows, level)
    shows &= (patches.was_visible & patches.visible)[rows] & (has >= 0) & (not outlook.viewer.jumped)
    slack = SLACK if transitions.hysteresis else 0
    due = representation.sublevels(outlook, rows, np.where(shows, has, np.int8(-1)), slack=slack)
    shows &= transitions.gradual
    wanted = np.where(both & shows, has, due)
    nearer = np.where(progress[rows] < 0.5, before[rows], has)
    wanted = np.where(waits & shows, nearer, wanted)
    here = unsettled(has, before[rows], progress[rows], wanted)
    if here.size:
        progress[rows[both]] = 1.0
        move_rows(now, before, progress, rows[here], wanted[here], shows[here], step=step)


def _standing(patches: PatchTable, rows: Rows, level: int) -> tuple[Mask, Mask]:
    """Return which patches (n,) are a representation at all, and which go between two that stand on the ground."""
    now, before, progress = (column[rows] for column in (patches.representation, patches.previous, patches.progress))
    come, going = progress > 0.0, progress < 1.0

    def counts(level: int) -> Mask:  # where its weight is above 0
        return np.asarray(((now == level) & come) | ((before == level) & going))

    return counts(level), going & (now != before) & ~counts(len(patches.names) - 1)


@dataclass(slots=True)
class Transition:
    """The system `transition`: the state machine that carries patches to the representation that is due.

    It is the only one that writes which representation a patch has, and how fine; a patch that is held in one goes
    there whatever is wanted.
    """

    outlooks: Iterable[Outlook]
    representations: tuple[Representation, ...]
    reach: tuple[int, ...]
    patch: float
    """Side of a patch [m]."""

    transitions: Transitions = SEAMLESS

    def run(self) -> None:
        """Move on for every viewer that looks."""
        for outlook in self.outlooks:
            over = partial(is_over, outlook.patches)
            outlook.unless_at_rest(self, read_of(outlook), partial(self._run, outlook), settled=over)

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
