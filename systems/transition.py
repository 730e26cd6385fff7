"""Transitions: what a patch looks like on its way from one representation to another (paper, section 4)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..components.transition import Transitions

Floats = NDArray[np.float32]

MORPH = 0.65
"""Part of a change between blades and strips in which the blades move; then they are handed over."""

BORDER = 4.0
"""Over how many patches the strips give way to the carpet."""

GROWN = 0.6
"""Part of a change from carpet to strips after which the strips stand at their full height."""

SINKS = 0.4
"""Part of it after which the carpet begins to sink and fade."""


@dataclass(frozen=True, slots=True, eq=False)
class Looks:
    """How each patch of the table shows, each of shape (rows,)."""

    blades: Floats
    """How much blades cover of what they could, 0 where none are drawn."""

    morph: Floats
    """How far blades have moved towards their painted places."""

    handed: Floats
    """How much of the blades has been handed over to the strips, slice by slice from far to near."""

    strips: Floats
    """How much strips cover of what they could, 0 where none are wanted."""

    growth: Floats
    """Height of the strips, as a part of their full height."""

    carpet: Floats
    """How much the carpet shows."""


def smooth(part: Floats, /) -> Floats:
    """Return a step from 0 to 1 that starts and ends gently, where `part` goes from 0 to 1."""
    x = np.clip(part, np.float32(0.0), np.float32(1.0))
    return np.asarray(x * x * (np.float32(3.0) - np.float32(2.0) * x))


def kept_near(away: Floats, /, *, reach: int) -> Floats:
    """Return how much of the strips the distance leaves, from 1 to 0 over their outermost `BORDER` patches.

    `away` is the patches' distance from the viewer [patch sides]. So no line shows where the strips end, and a patch
    that changes between strips and carpet far away has next to nothing to change.
    """
    kept: Floats = np.clip((reach + 0.5 - away) / BORDER, 0.0, 1.0).astype(np.float32)
    return kept


def looks(weight: Floats, kept: Floats, /, *, transitions: Transitions) -> Looks:
    """Return how each patch shows whose representations have these weights, (3, rows); `kept` is (rows,)."""
    if not transitions.gradual:
        kept = np.ones_like(kept)
    blades, strips, carpet = weight
    both = (blades > 0.0) & (strips > 0.0)
    covers, growth, laid = _grown(np.where(carpet > 0.0, kept * strips, kept), transitions)
    shown, morph, handed = _moved(blades, strips, transitions)
    if not transitions.morph:
        covers = np.where(both, covers * _early(strips, transitions), covers)
    lies = np.where(strips > 0.0, np.where(both, laid * strips, laid), carpet)
    return Looks(shown, morph, handed, np.where(strips > 0.0, covers, np.float32(0.0)), growth, lies)


def _moved(blades: Floats, strips: Floats, transitions: Transitions) -> tuple[Floats, Floats, Floats]:
    """Return how much blades cover, how far they have moved, and how much of them has been handed over."""
    both = (blades > 0.0) & (strips > 0.0)
    if not transitions.morph:
        gone = np.where(strips > 0.0, np.float32(1.0), np.float32(0.0))
        return _early(blades, transitions), np.zeros_like(blades), gone
    morph = np.where(both, smooth(strips / np.float32(MORPH)), np.float32(0.0))
    handed = np.clip((strips - np.float32(MORPH)) / np.float32(1.0 - MORPH), 0.0, 1.0)
    shown = np.where(both, np.float32(1.0), _early(blades, transitions))
    return shown, morph, np.where(both, handed, np.where(strips > 0.0, np.float32(1.0), np.float32(0.0)))


def _early(weight: Floats, transitions: Transitions) -> Floats:
    """Return how much a representation shows that fades in while the other is still there, and out after it has come.

    So no ground shows through the change.
    """
    if not transitions.fade:
        return (weight >= np.float32(0.5)).astype(np.float32)
    early: Floats = np.minimum(weight * np.float32(2.0), np.float32(1.0))
    return early


def _grown(part: Floats, transitions: Transitions) -> tuple[Floats, Floats, Floats]:
    """Return how much strips cover, how high they stand, and how much carpet there is, on the way from it to them."""
    whole = np.ones_like(part)
    if transitions.growth:
        height = smooth(part / np.float32(GROWN))
        sunk = smooth((part - np.float32(SINKS)) / np.float32(1.0 - SINKS))
        return (part > 0.0).astype(np.float32), height, whole - sunk
    if transitions.fade:
        return part, whole, whole - part
    switched = (part >= np.float32(0.5)).astype(np.float32)
    return switched, whole, whole - switched


def handed_over(handed: Floats, place: NDArray[np.int64], slices: int, /, *, fade: bool) -> tuple[Floats, Floats]:
    """Return how much of a slice's blades shows, and of its strip, while a patch is handed over slice by slice.

    `place` counts slices from the farthest, so that in any moment what is drawn as strips lies behind what is drawn
    as blades. A slice's strip appears before its blades go; by then they lie on it.
    """
    part = np.clip(handed * np.float32(slices) - place, 0.0, 1.0).astype(np.float32)
    if not fade:
        painted = (part >= np.float32(0.5)).astype(np.float32)
        return np.float32(1.0) - painted, painted
    blades: Floats = np.minimum(2.0 - 2.0 * part, 1.0).astype(np.float32)
    strips: Floats = np.minimum(2.0 * part, 1.0).astype(np.float32)
    return blades, strips
