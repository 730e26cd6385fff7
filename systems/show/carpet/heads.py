"""Where the heads of plants are in the canopy: a line of sight along its top meets them before all else."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...around.canopy import canopy_height
from ...grow.bend import Doubles, ribbon
from ...grow.organs import HEADS
from ...grow.raster import rasterise, ribbon_triangles
from ...grow.record import Blades, Growth

NO_HEADS = (1.0, 0.0, 0.0, 1.0)

_POINTS = 9
_TAPER = 0.6
"""Of blades among the rows: near enough to share out the leaf area."""

_SAMPLE = 0.003
"""Side of a sample of outlines [m]."""

_BEHIND = 0.75
"""How many of the heads that a line of sight would meet, did they stand evenly, it meets in a meadow: heads stand in
clumps, one behind another. Measured on poppies in barley, at slopes of 0.02 and less."""

_STEMS = 40
"""Heads at most whose outlines are measured."""


def heads_of(growth: Growth, /) -> tuple[float, float, float, float]:
    """Return a kind's leaf area without heads and that of heads' outlines, and from where to where they are.

    Areas are seen from the side, as parts of the whole leaf area: petals behind petals do not count again. Heights are
    parts of the canopy's; heads are taken to lie evenly between them, with their own mean and variance.
    """
    blades = growth.models[0].blades
    bears = np.isin(np.broadcast_to(blades.organ, blades.height.shape), HEADS)
    if not bears.any():
        return NO_HEADS
    left, right = ribbon(blades, growth.postures, (0.0, 0.0), points=_POINTS, taper=_TAPER)
    triangles = ribbon_triangles(left.astype(np.float64), right.astype(np.float64))
    area = _from_the_side(triangles)
    own = np.repeat(bears, len(triangles) // len(bears))
    height = triangles[own, :, 1].mean(axis=1) / canopy_height(growth)
    mean = np.average(height, weights=area[own])
    half = np.sqrt(3.0 * np.average((height - mean) ** 2, weights=area[own]))
    share = float(area[own].sum() / area.sum())
    return 1.0 - share, _BEHIND * share * _outlined(blades, triangles, bears), float(mean - half), float(mean + half)


def any_heads(growths: Sequence[Growth], /) -> bool:
    """Return whether any kind bears heads."""
    return any(np.isin(model.blades.organ, HEADS).any() for growth in growths for model in growth.models)


def _from_the_side(triangles: Doubles, /) -> Doubles:
    """Return the area of triangles (n, 3, 3) seen along x and along z, on the mean [m2], shape (n,)."""
    one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normal = np.cross(one, other)
    return np.asarray(0.25 * (np.abs(normal[:, 0]) + np.abs(normal[:, 2])))


def _outlined(blades: Blades, triangles: Doubles, bears: NDArray[np.bool_], /) -> float:
    """Return the area of heads' outlines, of that of all their triangles: heads stand side by side for that."""
    rows = np.flatnonzero(bears)
    _, stem = np.unique(
        np.column_stack([blades.rank, blades.stem, blades.stem_rest])[rows], axis=0, return_inverse=True
    )
    some = stem.reshape(-1) < _STEMS
    each = len(triangles) // len(bears)
    own = triangles.reshape(len(bears), each, 3, 3)[rows[some]]
    at = np.stack([own[..., 0] - blades.root[rows[some], None, None, 0], own[..., 1]], axis=-1) / _SAMPLE
    at -= at.min(axis=(0, 1, 2)) - 1.0
    wide, high = np.ceil(at.max(axis=(0, 1, 2)) + 1.0).astype(int).tolist()
    at[..., 0] += (stem.reshape(-1)[some] * wide)[:, None, None]
    corners = at.reshape(-1, 3, 2)
    seen = rasterise(corners, np.zeros(corners.shape[:2]), shape=(high, wide * (int(stem[some].max()) + 1)))
    edges = np.diff(corners, axis=1)
    every = 0.5 * np.abs(edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]).sum()
    return min(len(seen.sample) / float(every), 1.0)
