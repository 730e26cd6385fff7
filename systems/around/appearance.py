"""Appearance of patches during changes of representation: cross-fade, morph and growth (paper, section 4)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ..wind.shape import smooth
from .transitions import Transitions

Three = tuple[int, int, int]
"""Numbers of the representations for blades, strips and carpet, in this order."""

ARRIVED = 0.95
"""Progress of a change from blades to strips at which the blades reach their painted places."""

MORPH_POWER = 1.6
"""Exponent of the morph's ease curve: above 1, blades set off slowly and hurry at the end."""

HANDED_FROM = 0.35
"""Progress of a change from blades to strips at which the cross-fade from blades to strips begins."""

OVERLAP = 0.7
"""Extra cover of blades and strips in their cross-fade, of which a quarter is added half way. Both cover one place:
with less, dark depths show through dense grass; with more, single blades look swollen."""

BORDER = 0.3
"""Part of the strips' reach over which they fade into the carpet: over a crest, their feet come out row by row."""

LEAST_BORDER = 4.0
"""Least width of that fade [patches]."""

GROWN = 0.6
"""Progress of a change from carpet to strips at which the strips reach their full height."""

SINKS = 0.4
"""Progress of a change from carpet to strips at which the carpet begins to sink and fade."""

GLSL = {"GROWN": GROWN, "SINKS": SINKS}


@dataclass(frozen=True, slots=True, eq=False)
class Appearance:
    """Appearance of each patch around a viewer in a frame; rows are those of the patch table."""

    cover: Floats
    """Opacity of each representation, 0 to 1, shape (representations, rows)."""

    morph: Floats
    """Progress of blades from their own places to their painted places, 0 to 1, shape (rows,)."""

    handed: Floats
    """Progress of the cross-fade from blades to strips, 0 to 1, shape (rows,)."""

    growth: Floats
    """Height of the strips, as a part of their full height, shape (rows,)."""

    @classmethod
    def of_carpet(cls, representations: int, count: int, /) -> "Appearance":
        """Return the appearance of `count` rows that show carpet alone, which is the last of the representations."""
        cover = np.zeros((representations, count), np.float32)
        cover[-1] = 1.0
        return cls(cover, *np.zeros((3, count), np.float32))

    def among(self, rows: NDArray[np.int64], count: int, /) -> "Appearance":
        """Spread the appearance of `rows` over a table of `count` rows; the other rows show carpet alone."""
        spread = Appearance.of_carpet(len(self.cover), count)
        spread.cover[:, rows] = self.cover
        spread.morph[rows], spread.handed[rows], spread.growth[rows] = self.morph, self.handed, self.growth
        return spread


def _clamped(value: Floats, /) -> Floats:
    """Clamp values to [0, 1]; faster than `np.clip` on short arrays."""
    return np.minimum(np.maximum(value, np.float32(0.0)), np.float32(1.0))


def border_width(reach: float, /) -> float:
    """Return the width of the fade from strips with this `reach` into the carpet [patches]."""
    return max(BORDER * reach, LEAST_BORDER)


def strips_left(away: Floats | Doubles, /, *, reach: float) -> Floats:
    """Return the part of the strips that is left at a distance: 1 near by, falling to 0 over the `border_width`.

    `away` is the patches' distance from the viewer [patch sides]. So no line shows where the strips end, and a patch
    that changes between strips and carpet far away has next to nothing to change.
    """
    return _clamped(((reach + 0.5 - away) / border_width(reach)).astype(np.float32))


def appearance(weight: Floats, kept: Floats, /, *, transitions: Transitions, three: Three = (0, 1, 2)) -> Appearance:
    """Return the appearance of patches from their representations' weights, shape (representations, rows).

    `kept` (rows,) is the part of the strips that distance and view leave. Blades morph into strips, and strips grow out
    of the carpet (paper, sections 4.2 and 4.3); `three` has the numbers of these three. All others cross-fade.
    """
    if not transitions.gradual:
        kept = np.ones_like(kept)
    blades, strips, carpet = (weight[number] for number in three)
    both = (blades > 0.0) & (strips > 0.0)
    strip_cover, growth, carpet_cover = _grown(np.where(carpet > 0.0, kept * strips, kept), transitions)
    blade_cover, morph, handed = _morphed(blades, strips, transitions)
    if not transitions.morph:
        strip_cover = np.where(both, strip_cover * _faded(strips, transitions), strip_cover)
    carpet_cover = np.where(strips > 0.0, np.where(both, carpet_cover * strips, carpet_cover), carpet)
    cover = np.empty_like(weight)
    for number in (number for number in range(len(weight)) if number not in three):
        cover[number] = _faded(weight[number], transitions)
        strip_cover = np.where(weight[number] > 0.0, strip_cover * _faded(strips, transitions), strip_cover)
    strip_cover = np.where(strips > 0.0, strip_cover, np.float32(0.0))
    for number, values in zip(three, (blade_cover, strip_cover, carpet_cover), strict=True):
        cover[number] = values
    return Appearance(cover, morph, handed, growth)


def _morphed(blades: Floats, strips: Floats, transitions: Transitions) -> tuple[Floats, Floats, Floats]:
    """Return cover, `morph` and `handed` of blades, each of shape (rows,)."""
    both = (blades > 0.0) & (strips > 0.0)
    if not transitions.morph:
        handed = (strips > 0.0).astype(np.float32)
        return _faded(blades, transitions), np.zeros_like(blades), handed
    morph = np.zeros_like(blades)
    morph[both] = np.minimum(strips[both] / np.float32(ARRIVED), np.float32(1.0)) ** np.float32(MORPH_POWER)
    handed = _clamped((strips - np.float32(HANDED_FROM)) / np.float32(1.0 - HANDED_FROM))
    cover = np.where(both, np.float32(1.0), _faded(blades, transitions))
    return cover, morph, np.where(both, handed, (strips > 0.0).astype(np.float32))


def _faded(weight: Floats, transitions: Transitions) -> Floats:
    """Return the cover of a representation that cross-fades: 1 from a weight of 0.5 on.

    One of the two is always opaque, so no ground shows through the change.
    """
    if not transitions.fade:
        return (weight >= np.float32(0.5)).astype(np.float32)
    cover: Floats = np.minimum(weight * np.float32(2.0), np.float32(1.0))
    return cover


def _grown(progress: Floats, transitions: Transitions) -> tuple[Floats, Floats, Floats]:
    """Return cover and growth of the strips, and cover of the carpet, during a change from carpet to strips."""
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
    """Return the cover of blades, and of the strips that they are painted on, at a progress `handed` of their fade."""
    if not fade:
        strips = (handed >= np.float32(0.5)).astype(np.float32)
        return np.float32(1.0) - strips, strips
    one = np.float32(1.0)
    extra = np.float32(OVERLAP) * handed * (one - handed)
    return np.minimum(one - handed + extra, one), np.minimum(handed + extra, one)
