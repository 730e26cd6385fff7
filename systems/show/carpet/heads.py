"""Distribution of heads over the height of the canopy: a flat line of sight meets heads first."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles
from ...grow.bend import ribbon
from ...grow.organs import HEADS, bears_heads
from ...grow.raster import rasterise, ribbon_triangles
from ...grow.record import Blades, Growth
from ...space.canopy import canopy_height

HEIGHTS = 24
"""Number of height steps of a profile."""

HIGHEST = 1.2
"""Top of the profile, as a fraction of the canopy's height: the tallest plants stand out of the canopy."""

GLSL = {"HEIGHTS": HEIGHTS, "HIGHEST": HIGHEST}

_POINTS = 9
"""Points along a ribbon."""

_TAPER = 0.6
"""Taper of all ribbons: accurate enough for shares of leaf area."""

_SAMPLE = 0.003
"""Side of a sample when silhouettes of plants are rasterised [m]."""

_BEHIND = 0.92
"""Fraction of evenly spread plants that a line of sight would also meet if they stand in clumps, one behind another, as
in a meadow. Measured on poppies in barley and heather in moor grass, at slopes from 0.01 to 0.1."""

_PLANTS = 40
"""Largest number of plants whose silhouettes are rasterised."""


def profile_of(growth: Growth, /) -> Doubles:
    """Return the leaf area of a kind above each height, of all organs and of heads, shape (`HEIGHTS` + 1, 2).

    Heights rise evenly from the ground to `HIGHEST` of the canopy's. Areas are projected to the side, as fractions of
    the whole leaf area. Of kinds with heads they are areas of silhouettes: what a plant itself hides does not count.
    """
    blades = growth.models[0].blades
    triangles = ribbon_triangles(*ribbon(blades, growth.postures, (0.0, 0.0), points=_POINTS, taper=_TAPER))
    area = _side_area(triangles)
    if bears_heads(growth):
        height, seen, heads = _silhouettes(blades, triangles, area)
    else:
        height, seen, heads = triangles[:, :, 1].mean(axis=1), area, np.zeros(len(area), np.bool_)
    step = np.clip(height * (HEIGHTS / (HIGHEST * canopy_height(growth))), 0.0, HEIGHTS - 1).astype(int)
    parts = [np.bincount(step, seen * share, minlength=HEIGHTS) for share in (np.ones(len(step)), heads)]
    above = np.zeros((HEIGHTS + 1, 2))
    above[:-1] = np.cumsum(np.column_stack(parts)[::-1], axis=0)[::-1] / area.sum()
    return above


def _side_area(triangles: Doubles, /) -> Doubles:
    """Return the projected area of triangles (n, 3, 3), the mean of that along x and along z [m2], shape (n,)."""
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return np.asarray(0.25 * (np.abs(normal[:, 0]) + np.abs(normal[:, 2])))


def _silhouettes(blades: Blades, triangles: Doubles, area: Doubles, /) -> tuple[Doubles, Doubles, NDArray[np.bool_]]:
    """Rasterise plants from the side; return each sample's height [m], area [m2] and whether it is a head's, (n,).

    Only the first `_PLANTS` are drawn; areas are scaled up to those of all plants.
    """
    _, plant = np.unique(blades.rank, return_inverse=True)
    rows = np.flatnonzero(plant.reshape(-1) < _PLANTS)
    per_ribbon = len(triangles) // len(blades.rank)
    drawn = triangles.reshape(-1, per_ribbon, 3, 3)[rows]
    at = np.stack([drawn[..., 0] - blades.root[rows, None, None, 0], drawn[..., 1]], axis=-1) / _SAMPLE
    at -= at.min(axis=(0, 1, 2)) * [1.0, 0.0] - 1.0
    wide, high = np.ceil(at.max(axis=(0, 1, 2)) + 1.0).astype(int).tolist()
    at[..., 0] += (plant.reshape(-1)[rows] * wide)[:, None, None]
    shape = high, wide * (int(plant[rows].max()) + 1)
    seen = rasterise(at.reshape(-1, 3, 2), drawn[..., 2].reshape(-1, 3), shape=shape)
    heads = np.isin(np.broadcast_to(blades.organ, blades.rank.shape)[rows], HEADS)[seen.triangle // per_ribbon]
    sample_area = _BEHIND * _SAMPLE**2 * float(area.sum() / area.reshape(-1, per_ribbon)[rows].sum())
    return (seen.sample // shape[1] - 1.0) * _SAMPLE, np.full(len(seen.sample), sample_area), heads
