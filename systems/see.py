"""Seeing: the patches that each representation shows a viewer in this frame."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..components.arrays import Floats, Rows
from .around.appearance import Appearance, appearance, strips_left
from .around.outlook import Outlook
from .around.transitions import SEAMLESS, Transitions
from .lod import inputs_of
from .show.registry import THREE
from .show.representation import Representation
from .space.cone import seen_from
from .transition import weights


def strips_kept(
    outlook: Outlook, rows: Rows, representations: tuple[Representation, ...], /, *, patch: float
) -> Floats:  # fmt: skip
    """Return the fraction of strips that distance and view leave on patches (n,), shape (n,); `patch` is a side [m].

    It is 1 if the next coarser representation is not the carpet.
    """
    number = THREE[1]
    drawn = outlook.lens.reach_in(outlook.lens.reach)
    if drawn[number] < drawn[-2]:
        return np.ones(len(rows), np.float32)
    (x, z), eye = outlook.patches.middle.T, outlook.viewer.eye
    along = np.maximum(np.abs(x[rows] - np.float32(eye[0])), np.abs(z[rows] - np.float32(eye[2]))) / np.float32(patch)
    away = seen_from(along, outlook.patches.height[rows], eye[1], patch=patch)
    kept = strips_left(away, reach=drawn[number])
    if drawn[0] < 0:  # one representation replaces all finer ones
        return kept
    free = outlook.patches.hold[rows] < 0  # strips that a game holds are shown even where they are unfit
    return np.where(free, np.minimum(kept, representations[number].remaining(outlook, rows, away)), kept)


@dataclass(slots=True)
class See:
    """The system `see`: computes the appearance of all patches, and which of them each representation shows."""

    outlooks: Iterable[Outlook]
    representations: tuple[Representation, ...]
    patch: float
    """Side of a patch [m]."""

    transitions: Transitions = SEAMLESS

    def run(self) -> None:
        """See for every viewer that looks."""
        for outlook in self.outlooks:
            seen, made = (*inputs_of(outlook), *outlook.kept.values()), partial(getattr, outlook, "appearance")
            outlook.unless_at_rest(self, seen, partial(self._run, outlook), made=made)

    def _run(self, outlook: Outlook) -> None:
        outlook.appearance = self._appearance(outlook)
        for representation, cover in zip(self.representations, outlook.appearance.cover, strict=True):
            outlook.shown[representation.name] = representation.show(outlook, cover)

    def _appearance(self, outlook: Outlook) -> Appearance:
        """Return the appearance of all patches: carpet for those far from the view cone, or with nothing but carpet."""
        patches, last = outlook.patches, len(self.representations) - 1
        finer = (patches.representation != last) | (patches.previous != last)
        rows = (patches.alive & finer & (patches.near | patches.visible)).nonzero()[0]
        kept = strips_kept(outlook, rows, self.representations, patch=self.patch)
        seen = appearance(weights(patches, rows), kept, transitions=self.transitions, three=THREE)
        return seen.among(rows, len(patches.progress))
