"""Transitions: patches on their way from one representation to another (paper, section 4.1)."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .around.outlook import Outlook
from .around.patches import PatchTable
from .around.representation import Representation
from .around.transitions import SEAMLESS, Transitions
from .lod import SLACK, farthest

Floats = NDArray[np.float32]
Levels = NDArray[np.int8]
Mask = NDArray[np.bool_]
Rows = NDArray[np.int64]

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


def change(patches: PatchTable, wanted: Levels, settled: Mask, /, *, reach: tuple[int, ...], step: float) -> None:
    """Advance changes of representation by `step` and start those that are due (paper, section 4.1).

    A patch that is not visible, or was not, as `settled` says, takes its representation at once, as does one that is
    left behind farther than there is room for.
    """
    slowly = settled & patches.visible & (patches.representation >= 0) & ~_left_behind(patches, reach)
    due = np.where(patches.alive, wanted, patches.representation)
    move_on(patches.representation, patches.previous, patches.progress, due, slowly, step=step)


def held(patches: PatchTable, /, *, reach: tuple[int, ...]) -> Levels:
    """Return the representation that each patch is to have, shape (rows,): the one it is held in, or the wanted one.

    Where there is no room for so fine a one, it is the finest that there is room for; where none is wanted, the
    coarsest.
    """
    last = len(reach) - 1
    chosen = np.where(patches.hold >= 0, patches.hold, np.where(patches.wanted >= 0, patches.wanted, last))
    finest = np.zeros(len(chosen), np.int8)
    for limit in reach[:-1]:
        finest += patches.distance > limit + SLACK + 1  # from there on there is still room to come back slowly
    return np.clip(chosen, finest, last).astype(np.int8)


def _left_behind(patches: PatchTable, reach: tuple[int, ...]) -> Mask:
    """Return which patches are too far away for a representation that they have or come from, shape (rows,)."""
    limit = np.array([*farthest(reach), np.iinfo(np.int32).max], np.int32)
    finest = np.minimum(limit[patches.representation], limit[patches.previous])
    return np.asarray(patches.distance > finest)


def weights(patches: PatchTable, rows: Rows | slice = slice(None), /) -> Floats:
    """Return how far each patch is each representation, shape (representations, rows): they sum to 1 or to 0."""
    now, before, progress = (column[rows] for column in (patches.representation, patches.previous, patches.progress))
    shown = np.zeros((len(patches.names), len(progress)), np.float32)
    for level in range(len(shown)):
        shown[level] = np.where(now == level, progress, 0.0)
        shown[level] += np.where(before == level, 1.0 - progress, 0.0)
    return shown


def refine(
    outlook: Outlook,
    representations: tuple[Representation, ...],
    /,
    *,
    reach: tuple[int, ...],
    step: float,
    transitions: Transitions,
) -> None:
    """Advance changes of sub-levels by `step` and start those that are due.

    Where a representation does not show, its sub-level is due at once; while a patch goes between two representations
    that stand on the ground, none changes, so that each blade keeps its painted place. Patches too far away for a
    representation stay as they are, and change no more.
    """
    patches, last = outlook.patches, len(representations) - 1
    limits = farthest(reach)
    near = np.flatnonzero(patches.distance <= max(limits))
    weight = weights(patches, near)
    settled = (patches.was_visible & patches.visible)[near] & (not outlook.viewer.jumped)
    has, had = patches.representation[near], patches.previous[near]
    standing = (patches.progress[near] < 1.0) & (weight[last] == 0.0) & (has != had)
    for level, representation in enumerate(representations[:last]):
        here = np.flatnonzero(patches.distance[near] <= limits[level])
        rows, both = near[here], standing[here]
        now, before, progress = (
            levels[level, rows] for levels in (patches.sublevel, patches.sublevel_before, patches.sublevel_progress)
        )
        seen = settled[here] & (weight[level, here] > 0.0) & (now >= 0)
        wanted = representation.sublevels(
            outlook, rows, np.where(seen, now, np.int8(-1)), slack=SLACK if transitions.hysteresis else 0
        )
        progress[both] = 1.0
        shows = seen & transitions.gradual
        move_on(now, before, progress, np.where(both & shows, now, wanted), shows, step=step)
        patches.sublevel[level, rows], patches.sublevel_before[level, rows] = now, before
        patches.sublevel_progress[level] = 1.0
        patches.sublevel_progress[level, rows] = progress


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
            self._run(outlook)

    def _run(self, outlook: Outlook) -> None:
        patches, viewer = outlook.patches, outlook.viewer
        settled = patches.was_visible & patches.visible & (not viewer.jumped)
        step = step_of_change(viewer.dt, way=viewer.way, patch=self.patch)
        before = patches.representation.copy()
        wanted = held(patches, reach=self.reach)
        change(patches, wanted, settled & self.transitions.gradual, reach=self.reach, step=step)
        refine(outlook, self.representations, reach=self.reach, step=step, transitions=self.transitions)
        changing = (patches.progress < 1.0) | ((before != patches.representation) & settled)
        outlook.changing = int((patches.shown & changing).sum())
