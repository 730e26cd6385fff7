"""Levels of detail: the representation that is due on each patch (paper, sections 2.2 and 4.1)."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Levels
from .around.outlook import Outlook
from .around.transitions import SLACK
from .mow.mown import Mown
from .show.representation import Representation

ROOM = 2
"""Number of patches beyond the slack for which pools have room, while they are changing; farther out, a change is made
at once."""


def reach_of(limits: tuple[int, ...], forced: int | None, /) -> tuple[int, ...]:
    """Return the reach of each representation, from the finest: the largest discrete distance at which it is due.

    `limits` are those of the quality. `forced` is the index of a representation that replaces all others.
    """
    if forced is None:
        return limits
    last = len(limits) - 1
    nowhere, far = -SLACK - 1, limits[last - 1]
    return (*(nowhere if number < forced else far for number in range(last)), limits[last])


def wanted_representation(
    distance: NDArray[np.int32], current: Levels, /, *, reach: tuple[float, ...], slack: int = SLACK
) -> Levels:
    """Return the representation due at each discrete distance, shape (n,).

    A patch keeps a finer representation for `slack` patches beyond its reach, so that a walker on a limit leaves
    nothing in transition (paper, section 4.1). `current` is -1 for a patch without a representation.
    """
    due = _beyond(distance, reach)
    finer = ((current >= 0) & (current < due)).nonzero()[0]
    due[finer] = np.maximum(_beyond(distance[finer] - slack, reach), current[finer])
    return due


def _beyond(distance: NDArray[np.int32], reach: tuple[float, ...]) -> Levels:
    """Return the number of representations whose reach is below each discrete distance (n,), shape (n,)."""
    beyond = np.zeros(len(distance), np.int8)
    for limit in reach[:-1]:
        beyond += distance > limit
    return beyond


def farthest(reach: tuple[int, ...], /) -> tuple[int, ...]:
    """Return the largest discrete distance at which pools have room for each representation but the coarsest."""
    return tuple(limit + SLACK + ROOM for limit in reach[:-1])


def inputs_of(outlook: Outlook, /) -> tuple[object, ...]:
    """Return the inputs of levels of detail and appearance besides the patch table, to be compared between frames.

    The view cone is in the table, as what is visible, and the viewer's cell follows from its eye.
    """
    viewer, lens, mown = outlook.viewer, outlook.lens, outlook.noted(Mown, None)
    sees = lens.zoom, lens.range, lens.reach, lens.room
    return viewer.eye, viewer.jumped, *sees, outlook.mean_index, outlook.heights, outlook.sown, mown and mown.strokes


@dataclass(slots=True)
class ChooseLevels:
    """The system `lod`: chooses the representation due on each patch by its discrete distance and how it is seen.

    It only writes `wanted`; the system `transition` moves patches there.
    """

    outlooks: Iterable[Outlook]
    reach: tuple[int, ...]
    """Largest discrete distance of each representation."""

    representations: tuple[Representation, ...] = ()
    """All representations, from the finest, which may be unfit for how a near patch is seen; empty to ask none."""

    slack: int = SLACK

    bent: Callable[[float], float] = lambda _: 0.0
    """Returns the mean posture index to which winds bend grass everywhere at a time [s]."""

    def run(self) -> None:
        """Choose for every viewer that looks."""
        for outlook in self.outlooks:
            outlook.mean_index = self.bent(outlook.viewer.time)
            outlook.unless_at_rest(self, inputs_of(outlook), partial(self._run, outlook))

    def _run(self, outlook: Outlook) -> None:
        patches = outlook.patches
        settled = patches.was_visible & patches.visible & (not outlook.viewer.jumped)
        unsettled = settled.view(np.int8) - np.int8(1)  # 0 where settled; elsewhere -1, whose bits are all set
        current = patches.representation | unsettled
        reach = outlook.lens.reach_in(self.reach)
        patches.wanted[:] = wanted_representation(patches.away, current, reach=reach, slack=self.slack)
        if self.reach[0] >= 0:  # otherwise one representation replaces all finer ones
            self._pass_on(outlook, current)

    def _pass_on(self, outlook: Outlook, current: Levels) -> None:
        """Pass patches whose representation is unfit on to the next coarser one."""
        patches = outlook.patches
        for level, representation in enumerate(self.representations[:-1]):
            rows = (patches.visible & (patches.wanted == level)).nonzero()[0]
            unfit = representation.unfit(outlook, rows, current[rows] == level, slack=self.slack)
            patches.wanted[rows[unfit]] = level + 1
