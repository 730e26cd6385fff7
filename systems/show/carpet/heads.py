"""Where the heads of plants are in the canopy: a line of sight along its top meets them before all else."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...around.canopy import canopy_height
from ...grow.bend import Doubles, ribbon
from ...grow.organs import HEADS
from ...grow.raster import rasterise, ribbon_triangles
from ...grow.record import Blades, Growth

LAYERS = 12
"""Layers that a canopy is taken in."""

HIGHEST = 1.2
"""How high the topmost reaches, of the canopy's height: the tallest plants stand out of it."""

_POINTS = 9
_TAPER = 0.6
"""Of blades among the rows: near enough to share out the leaf area."""

_SAMPLE = 0.003
"""Side of a sample of outlines [m]."""

_STEMS = 40
"""Heads at most whose outlines are measured."""


def profile_of(growth: Growth, /) -> Doubles:
    """Return a kind's leaf area by height, of all without heads and of heads' outlines, shape (`LAYERS`, 2).

    Areas are seen from the side, as parts of the whole leaf area, for a height as great as the canopy's: petals behind
    petals do not count again.
    """
    blades = growth.models[0].blades
    left, right = ribbon(blades, growth.postures, (0.0, 0.0), points=_POINTS, taper=_TAPER)
    triangles = ribbon_triangles(left.astype(np.float64), right.astype(np.float64))
    area = _from_the_side(triangles)
    bears = np.isin(np.broadcast_to(blades.organ, blades.height.shape), HEADS)
    own = np.repeat(bears, len(triangles) // len(bears))
    layer = triangles[:, :, 1].mean(axis=1) * (LAYERS / (HIGHEST * canopy_height(growth)))
    layer = np.clip(layer, 0.0, LAYERS - 1).astype(int)
    shown = _outlined(blades, triangles, bears) if bears.any() else 1.0
    parts = [np.bincount(layer[of], area[of], minlength=LAYERS) for of in (~own, own)]
    return np.column_stack([parts[0], shown * parts[1]]) * (LAYERS / (HIGHEST * area.sum()))


def bears_heads(growth: Growth, /) -> bool:
    """Return whether a kind bears heads."""
    return any(np.isin(model.blades.organ, HEADS).any() for model in growth.models)


def any_heads(growths: Sequence[Growth], /) -> bool:
    """Return whether any kind bears heads."""
    return any(map(bears_heads, growths))


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
