"""Appearance: what a patch looks like on its way from one representation to another (paper, section 4)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from .transitions import Transitions

Three = tuple[int, int, int]
"""The numbers of the representations whose changes into one another are more than a fade: the one that moves to its
painted places on the next, this next one, and the one that this grows out of."""

ARRIVED = 0.95
"""Part of a change from blades to strips after which the blades are in their painted places."""

GENTLY = 1.6
"""Exponent of the ease curve of that way: above 1, blades set off slowly and hurry at the end."""

NEARLY = 0.35
"""Part of a change from blades to strips after which the blades begin to be handed over to the strips."""

OVERLAP = 0.7
"""How much more than in a plain cross-fade blades and strips show in the midst of handing over, in quarters. Both cover
the same place: with less, dark depths show through grass that covers all; with more, single blades look swollen."""

BORDER = 0.3
"""Part of the strips' reach over which they give way to the carpet: over a crest, their feet come out row by row."""

LEAST_BORDER = 4.0
"""Over how many patches they do at least."""

GROWN = 0.6
"""Part of a change from carpet to strips after which the strips stand at their full height."""

SINKS = 0.4
"""Part of a change from carpet to strips after which the carpet begins to sink and fade."""

GLSL = {"GROWN": GROWN, "SINKS": SINKS}


@dataclass(frozen=True, slots=True, eq=False)
class Appearance:
    """How each patch around a viewer appears in a frame."""

    cover: Floats
    """How much each representation shows, from 0 for nothing to 1 for all of it, shape (representations, rows)."""

    morph: Floats
    """How far blades have moved towards their painted places, shape (rows,)."""

    handed: Floats
    """How far the blades have been handed over to the strips, shape (rows,)."""

    growth: Floats
    """Height of the strips, as a part of their full height, shape (rows,)."""

    @classmethod
    def of_carpet(cls, representations: int, count: int, /) -> "Appearance":
        """Return the appearance of `count` rows that have the last of so many representations alone, the carpet."""
        cover = np.zeros((representations, count), np.float32)
        cover[-1] = 1.0
        return cls(cover, *np.zeros((3, count), np.float32))

    def among(self, rows: NDArray[np.int64], count: int, /) -> "Appearance":
        """Return this as the appearance of some rows among `count` of them; the others have carpet alone."""
        spread = Appearance.of_carpet(len(self.cover), count)
        spread.cover[:, rows] = self.cover
        spread.morph[rows], spread.handed[rows], spread.growth[rows] = self.morph, self.handed, self.growth
        return spread


def smooth(progress: Floats, /) -> Floats:
    """Return a step from 0 to 1 that starts and ends gently, where `progress` goes from 0 to 1."""
    x = _part(progress)
    return np.asarray(x * x * (np.float32(3.0) - np.float32(2.0) * x))


def _part(value: Floats, /) -> Floats:
    """Return what lies between 0 and 1 of some values; `np.clip` takes longer for few."""
    return np.minimum(np.maximum(value, np.float32(0.0)), np.float32(1.0))


def border_of(reach: float, /) -> float:
    """Return over how many patches strips that reach so far give way to the carpet."""
    return max(BORDER * reach, LEAST_BORDER)


def kept_near(away: Floats | Doubles, /, *, reach: float) -> Floats:
    """Return how much of the strips the distance leaves, from 1 to 0 over the outermost patches, as `border_of` has it.

    `away` is the patches' distance from the viewer [patch sides]. So no line shows where the strips end, and a patch
    that changes between strips and carpet far away has next to nothing to change.
    """
    return _part(((reach + 0.5 - away) / border_of(reach)).astype(np.float32))


def appearance(weight: Floats, kept: Floats, /, *, transitions: Transitions, three: Three = (0, 1, 2)) -> Appearance:
    """Return how each patch appears whose representations have these weights, (representations, rows).

    `kept` (rows,) is how much of the strips the distance leaves. Between blades and strips, and between strips and
    carpet, there are changes of their own (paper, sections 4.2 and 4.3): these are `three`, and all others fade.
    """
    if not transitions.gradual:
        kept = np.ones_like(kept)
    blades, strips, carpet = (weight[number] for number in three)
    both = (blades > 0.0) & (strips > 0.0)
    covers, growth, laid = _grown(np.where(carpet > 0.0, kept * strips, kept), transitions)
    shown, morph, handed = _moved(blades, strips, transitions)
    if not transitions.morph:
        covers = np.where(both, covers * _early(strips, transitions), covers)
    lies = np.where(strips > 0.0, np.where(both, laid * strips, laid), carpet)
    cover = np.empty_like(weight)
    for number in (number for number in range(len(weight)) if number not in three):
        cover[number] = _early(weight[number], transitions)
        covers = np.where(weight[number] > 0.0, covers * _early(strips, transitions), covers)
    for number, values in zip(three, (shown, np.where(strips > 0.0, covers, np.float32(0.0)), lies), strict=True):
        cover[number] = values
    return Appearance(cover, morph, handed, growth)


def _moved(blades: Floats, strips: Floats, transitions: Transitions) -> tuple[Floats, Floats, Floats]:
    """Return how much blades cover, how far they have moved, and how much of them has been handed over."""
    both = (blades > 0.0) & (strips > 0.0)
    if not transitions.morph:
        gone = (strips > 0.0).astype(np.float32)
        return _early(blades, transitions), np.zeros_like(blades), gone
    morph = np.zeros_like(blades)
    morph[both] = np.minimum(strips[both] / np.float32(ARRIVED), np.float32(1.0)) ** np.float32(GENTLY)
    handed = _part((strips - np.float32(NEARLY)) / np.float32(1.0 - NEARLY))
    shown = np.where(both, np.float32(1.0), _early(blades, transitions))
    return shown, morph, np.where(both, handed, (strips > 0.0).astype(np.float32))


def _early(weight: Floats, transitions: Transitions) -> Floats:
    """Return how much a representation shows that fades in while the other is still there, and out after it has come.

    So no ground shows through the change.
    """
    if not transitions.fade:
        return (weight >= np.float32(0.5)).astype(np.float32)
    early: Floats = np.minimum(weight * np.float32(2.0), np.float32(1.0))
    return early


def _grown(progress: Floats, transitions: Transitions) -> tuple[Floats, Floats, Floats]:
    """Return how much strips cover, how high they stand, and how much carpet there is, on the way from it to them."""
    if transitions.growth:
        height = smooth(progress / np.float32(GROWN))
        sunk = smooth((progress - np.float32(SINKS)) / np.float32(1.0 - SINKS))
        return (progress > 0.0).astype(np.float32), height, np.float32(1.0) - sunk
    whole = np.ones_like(progress)
    if transitions.fade:
        return progress, whole, whole - progress
    switched = (progress >= np.float32(0.5)).astype(np.float32)
    return switched, whole, whole - switched


def handed_over(handed: Floats, /, *, fade: bool) -> tuple[Floats, Floats]:
    """Return how much blades show, and the strips that they lie on, while they are handed over."""
    if not fade:
        painted = (handed >= np.float32(0.5)).astype(np.float32)
        return np.float32(1.0) - painted, painted
    one = np.float32(1.0)
    more = np.float32(OVERLAP) * handed * (one - handed)
    return np.minimum(one - handed + more, one), np.minimum(handed + more, one)
