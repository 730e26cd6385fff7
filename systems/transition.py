"""Transitions: patches on their way from one representation to another (paper, section 4.1)."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..components.arrays import Floats, Levels, Mask, Rows
from .around.outlook import Outlook
from .around.pace import change_step
from .around.patches import PatchTable
from .around.transitions import SEAMLESS, SLACK, Transitions
from .lod import farthest, inputs_of
from .show.representation import Representation

FADE = 1.2
"""Longest duration of a change of representation [s]."""

STRETCH = 0.8
"""Fraction of a patch that a walker crosses during a change: it is over before the patch is crossed (paper, 4.1)."""


@dataclass(slots=True)
class Transition:
    """The system `transition`: the state machine that moves patches to the representation that is due.

    No other system writes a patch's representation and sub-level. A held patch goes to the representation that it is
    held in, whatever is wanted.
    """

    outlooks: Iterable[Outlook]
    representations: tuple[Representation, ...]
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
        reach = outlook.lens.room
        due = due_representations(patches, reach=reach)
        waits = _waiting(patches, due, reach=reach, step=step)
        due[waits] = patches.representation[waits]
        change_representations(patches, due, settled & self.transitions.gradual, reach=reach, step=step)
        for level in range(len(self.representations) - 1):
            self._change_sublevels(outlook, level, waits, step=step)
        changing = (patches.progress < 1.0) | ((before != patches.representation) & settled)
        outlook.changing = int(np.count_nonzero(patches.shown & changing))

    def _change_sublevels(self, outlook: Outlook, level: int, waits: Mask, *, step: float) -> None:
        """Advance changes of sub-level of the representation with a number by `step`, and start those that are due.

        A representation that does not show takes its sub-level at once. While a patch changes between two
        representations that stand on the ground, no sub-level changes, so that each blade keeps its painted place.
        Patches that wait (rows,) go to the nearer end of their change. Patches that are not visible or do not have the
        representation end their changes and begin no others: their sub-levels will be chosen anew.
        """
        patches, representation = outlook.patches, self.representations[level]
        sublevels, gradual = patches.sublevels(level), self.transitions.gradual
        has = (patches.representation == level) | (patches.previous == level)
        rows = ((patches.alive & patches.visible & has) | (sublevels.progress < 1.0)).nonzero()[0]
        if not rows.size:
            return
        now, change = sublevels.of(rows), patches.representations.of(rows)
        lies = change.shows(len(self.representations) - 1)
        stands_throughout = (change.progress < 1.0) & (change.now != change.before) & ~lies
        seen = (patches.was_visible & patches.visible)[rows] & (not outlook.viewer.jumped)
        slowly = change.shows(level) & seen & (now.now >= 0)
        present = np.where(slowly, now.now, np.int8(-1))
        wanted = representation.sublevels(outlook, rows, present, slack=SLACK * self.transitions.hysteresis)
        slowly &= gradual
        wanted = np.where(stands_throughout & slowly, now.now, wanted)
        nearer = np.where(now.progress < 0.5, now.before, now.now)
        wanted = np.where(waits[rows] & slowly, nearer, wanted)
        here = now.unsettled(wanted)
        if here.size:
            sublevels.progress[rows[stands_throughout]] = 1.0
            sublevels.advance_rows(rows[here], wanted[here], slowly[here], step=step)


def step_of_change(dt: float, /, *, way: float, patch: float) -> float:
    """Return the part of a change made in `dt` seconds, in which the walker goes `way` metres; `patch` is a side [m].

    A change takes `FADE` seconds, or the time to cross `STRETCH` of a patch, whichever is shorter.
    """
    return max(dt / FADE, way / (STRETCH * patch))


def is_over(patches: PatchTable, /) -> bool:
    """Return whether no change is under way, so that a frame does not depend on its duration."""
    return bool((patches.progress >= 1.0).all() and (patches.sublevel_progress >= 1.0).all())


def weights(patches: PatchTable, rows: Rows | slice = slice(None), /) -> Floats:
    """Return the weight of each representation on each patch, shape (representations, rows); they sum to 1 or 0."""
    change = patches.representations.of(rows)
    return np.array([change.weight(level) for level in range(len(patches.names))], np.float32)


def due_representations(patches: PatchTable, /, *, reach: tuple[int, ...]) -> Levels:
    """Return the representation that each patch is to have, shape (rows,): the one it is held in, or the wanted one.

    If pools have no room for it, it is the finest for which they have; if none is wanted, the coarsest.
    """
    due, rows = patches.wanted.copy(), (patches.hold >= 0).nonzero()[0]
    due[rows] = patches.hold[rows]
    np.minimum(due.view(np.uint8), len(reach) - 1, out=due.view(np.uint8))  # unsigned, -1 (none) is the largest
    finest = np.zeros(len(due), np.int8)
    for limit in reach[:-1]:
        finest += patches.distance > limit + SLACK + 1  # from there on there is still room to come back slowly
    return np.maximum(due, finest)


def _waiting(patches: PatchTable, due: Levels, *, reach: tuple[int, ...], step: float) -> Mask:
    """Return whether each patch must end a change of sub-level before it changes its representation, shape (rows,).

    So blades morph to the painted places of a single sub-level. A patch does not wait if its change ends in this
    `step`, or if it is farther away than pools have room for.
    """
    now, last = patches.representation, len(patches.names) - 1
    rows = ((now != due) & (patches.progress >= 1.0)).nonzero()[0]
    from_, to = now[rows], due[rows]
    rows = rows[(from_ >= 0) & (from_ < last) & (to >= 0) & (to < last)]
    rows = rows[patches.sublevel_progress[now[rows], rows] + step < 1.0]
    waits = np.zeros(len(now), np.bool_)
    waits[rows[~_left_behind(patches, rows, reach)]] = True
    return waits


def change_representations(
    patches: PatchTable, due: Levels, settled: Mask, *, reach: tuple[int, ...], step: float
) -> None:
    """Advance changes of representation by `step` and start those that are due (paper, section 4.1).

    A patch changes at once if it is not `settled` and visible, or is farther away than pools have room for.
    """
    changes = patches.representations
    rows = changes.unsettled(due)
    rows = rows[patches.alive[rows]]
    if rows.size:
        slowly = (settled & patches.visible)[rows] & (changes.now[rows] >= 0) & ~_left_behind(patches, rows, reach)
        changes.advance_rows(rows, due[rows], slowly, step=step)


def _left_behind(patches: PatchTable, rows: Rows, reach: tuple[int, ...]) -> Mask:
    """Return whether pools lack room, so far away, for a representation that patches (n,) have or come from, (n,)."""
    limit = np.array([*farthest(reach), np.iinfo(np.int32).max], np.int32)
    finest = np.minimum(limit[patches.representation[rows]], limit[patches.previous[rows]])
    return np.asarray(patches.distance[rows] > finest)
