"""Mean size of a kind's heads, and how often their organs cover one another: the coverage of small heads needs it."""

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
"""Taper of blades, which has no effect, as no head is made of them."""

_SAMPLES = 48
"""Number of samples across a head."""

_MOST = 24
"""Largest number of heads that are measured."""


class Headed(NamedTuple):
    """Means over the heads of a kind."""

    above: float
    """Area that a head covers, seen from above [m2]."""

    aside: float
    """Area that a head covers, seen from the side [m2]."""

    layers: float
    """Number of layers of organs over the area that a head covers, at least 1."""


def headed(growth: Growth, /) -> Headed | None:
    """Return means over the heads of a kind, None if it bears none."""
    if not bears_heads(growth):
        return None
    blades = next(model.blades for model in growth.models if np.isin(model.blades.organ, HEADS).any())
    members = _head_rows(blades)
    left, right = ribbon(blades, growth.postures, (0.0, 0.0), points=_POINTS, taper=_TAPER)
    covered, total, heads = np.zeros(2), np.zeros(2), members[-1, 1] + 1
    for head in range(heads):
        rows = members[members[:, 1] == head, 0]
        corners = ribbon_triangles(left[rows], right[rows])
        areas = [_areas(corners[..., axes]) for axes in ([0, 2], [0, 1], [2, 1])]
        covered += areas[0][0], 0.5 * (areas[1][0] + areas[2][0])
        total += areas[0][1], 0.5 * (areas[1][1] + areas[2][1])
    above, aside = (covered / heads).tolist()
    return Headed(above, aside, max(float(total.sum() / covered.sum()), 1.0))


def _head_rows(blades: Blades, /) -> NDArray[np.intp]:
    """Return the rows of up to `_MOST` heads, each with the number of its head, shape (n, 2), head after head."""
    rows = np.flatnonzero(np.isin(np.broadcast_to(blades.organ, blades.rank.shape), HEADS))
    stems = np.column_stack([blades.rank[rows], np.broadcast_to(blades.stem, blades.rank.shape)[rows]])
    _, first, head = np.unique(stems, axis=0, return_index=True, return_inverse=True)
    number = np.argsort(np.argsort(first))[head.reshape(-1)]
    members = np.column_stack([rows, number])[number < _MOST]
    return members[np.argsort(members[:, 1], kind="stable")]


def _areas(corners: Doubles, /) -> tuple[float, float]:
    """Return the area that triangles (n, 3, 2) cover together, and the sum of their areas [m2]."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    sample = max(float((high - low).max()), 1e-6) / _SAMPLES
    place = (corners - low) / sample + 1.0
    seen = rasterise(place, np.zeros(place.shape[:2]), shape=(_SAMPLES + 3, _SAMPLES + 3))
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = 0.5 * np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
    return max(len(seen.sample), 1) * sample**2, float(area.sum())
