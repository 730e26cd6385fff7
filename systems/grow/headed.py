"""How large the heads of a kind are, and how far what they are made of hides itself: small ones are drawn by that."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from .bend import ribbon
from .organs import HEADS, bears_heads
from .raster import rasterise, ribbon_triangles
from .record import Blades, Growth

_POINTS = 9
_TAPER = 1.0
"""Of blades, of which no head is made."""

_SAMPLES = 48
"""Across a head."""

_MOST = 24
"""Heads at most that are measured."""


class Headed(NamedTuple):
    """What the heads of a kind are like in the mean."""

    above: float
    """Area that one hides, seen from above [m2]."""

    aside: float
    """The same from the side [m2]."""

    layers: float
    """How often what it is made of covers what it hides, from 1 on."""


def headed(growth: Growth, /) -> Headed | None:
    """Return what the heads of a kind are like, None if it bears none."""
    if not bears_heads(growth):
        return None
    blades = next(model.blades for model in growth.models if np.isin(model.blades.organ, HEADS).any())
    own = _of_heads(blades)
    left, right = ribbon(blades, growth.postures, (0.0, 0.0), points=_POINTS, taper=_TAPER)
    hides, covers, heads = np.zeros(2), np.zeros(2), own[-1, 1] + 1
    for head in range(heads):
        rows = own[own[:, 1] == head, 0]
        corners = ribbon_triangles(left[rows].astype(np.float64), right[rows].astype(np.float64))
        seen = [_seen(corners[..., axes]) for axes in ([0, 2], [0, 1], [2, 1])]
        hides += seen[0][0], 0.5 * (seen[1][0] + seen[2][0])
        covers += seen[0][1], 0.5 * (seen[1][1] + seen[2][1])
    above, aside = (hides / heads).tolist()
    return Headed(above, aside, max(float(covers.sum() / hides.sum()), 1.0))


def _of_heads(blades: Blades, /) -> NDArray[np.intp]:
    """Return the rows of some heads and the number of the head that each belongs to, shape (n, 2)."""
    rows = np.flatnonzero(np.isin(np.broadcast_to(blades.organ, blades.rank.shape), HEADS))
    stems = np.column_stack([blades.rank[rows], np.broadcast_to(blades.stem, blades.rank.shape)[rows]])
    _, first, head = np.unique(stems, axis=0, return_index=True, return_inverse=True)
    turn = np.argsort(np.argsort(first))[head.reshape(-1)]
    found = np.column_stack([rows, turn])[turn < _MOST]
    return found[np.argsort(found[:, 1], kind="stable")]


def _seen(corners: Doubles, /) -> tuple[float, float]:
    """Return how much triangles (n, 3, 2) hide together, and one by one [m2]."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    sample = max(float((high - low).max()), 1e-6) / _SAMPLES
    at = (corners - low) / sample + 1.0
    seen = rasterise(at, np.zeros(at.shape[:2]), shape=(_SAMPLES + 3, _SAMPLES + 3))
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    each = 0.5 * np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
    return max(len(seen.sample), 1) * sample**2, float(each.sum())
