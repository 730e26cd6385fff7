"""Where the heads of plants are in the canopy: a line of sight along its top meets them before all else."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles
from ...grow.bend import ribbon
from ...grow.organs import HEADS, bears_heads
from ...grow.raster import rasterise, ribbon_triangles
from ...grow.record import Blades, Growth
from ...space.canopy import canopy_height

HEIGHTS = 24
"""Heights that are told apart in a canopy."""

HIGHEST = 1.2
"""How high the topmost reaches, of the canopy's height: the tallest plants stand out of it."""

GLSL = {"HEIGHTS": HEIGHTS, "HIGHEST": HIGHEST}

_POINTS = 9
_TAPER = 0.6
"""Of blades among the rows: near enough to share out the leaf area."""

_SAMPLE = 0.003
"""Side of a sample of plants' outlines [m]."""

_BEHIND = 0.92
"""How many of the plants that a line of sight would meet, did they stand evenly, it meets in a meadow: they stand in
clumps, one behind another. Measured on poppies in barley and heather in moor grass, at slopes from 0.01 to 0.1."""

_PLANTS = 40
"""Plants at most whose outlines are measured."""


def profile_of(growth: Growth, /) -> Doubles:
    """Return how much of a kind's leaf area is above each height, of all and of heads, shape (`HEIGHTS` + 1, 2).

    Heights rise evenly from the ground to `HIGHEST` of the canopy's. Areas are seen from the side, as parts of the
    whole leaf area; of plants with heads, outlines are: what one has behind its own petals and leaves does not count.
    """
    blades = growth.models[0].blades
    left, right = ribbon(blades, growth.postures, (0.0, 0.0), points=_POINTS, taper=_TAPER)
    triangles = ribbon_triangles(left.astype(np.float64), right.astype(np.float64))
    area = _from_the_side(triangles)
    if bears_heads(growth):
        height, seen, heads = _outlines(blades, triangles, area)
    else:
        height, seen, heads = triangles[:, :, 1].mean(axis=1), area, np.zeros(len(area), np.bool_)
    at = np.clip(height * (HEIGHTS / (HIGHEST * canopy_height(growth))), 0.0, HEIGHTS - 1).astype(int)
    parts = [np.bincount(at, seen * of, minlength=HEIGHTS) for of in (np.ones(len(at)), heads)]
    above = np.zeros((HEIGHTS + 1, 2))
    above[:-1] = np.cumsum(np.column_stack(parts)[::-1], axis=0)[::-1] / area.sum()
    return above


def _from_the_side(triangles: Doubles, /) -> Doubles:
    """Return the area of triangles (n, 3, 3) seen along x and along z, on the mean [m2], shape (n,)."""
    one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    normal = np.cross(one, other)
    return np.asarray(0.25 * (np.abs(normal[:, 0]) + np.abs(normal[:, 2])))


def _outlines(blades: Blades, triangles: Doubles, area: Doubles, /) -> tuple[Doubles, Doubles, NDArray[np.bool_]]:
    """Return what is seen of single plants from the side, by sample (n,): height [m], area [m2], whether a head's.

    Some plants stand for all: areas are those of as many as there are.
    """
    _, plant = np.unique(blades.rank, return_inverse=True)
    rows = np.flatnonzero(plant.reshape(-1) < _PLANTS)
    each = len(triangles) // len(blades.rank)
    own = triangles.reshape(-1, each, 3, 3)[rows]
    at = np.stack([own[..., 0] - blades.root[rows, None, None, 0], own[..., 1]], axis=-1) / _SAMPLE
    at -= at.min(axis=(0, 1, 2)) * [1.0, 0.0] - 1.0
    wide, high = np.ceil(at.max(axis=(0, 1, 2)) + 1.0).astype(int).tolist()
    at[..., 0] += (plant.reshape(-1)[rows] * wide)[:, None, None]
    shape = high, wide * (int(plant[rows].max()) + 1)
    seen = rasterise(at.reshape(-1, 3, 2), own[..., 2].reshape(-1, 3), shape=shape)
    heads = np.isin(np.broadcast_to(blades.organ, blades.rank.shape)[rows], HEADS)[seen.triangle // each]
    one = _BEHIND * _SAMPLE**2 * float(area.sum() / area.reshape(-1, each)[rows].sum())
    return (seen.sample // shape[1] - 1.0) * _SAMPLE, np.full(len(seen.sample), one), heads
