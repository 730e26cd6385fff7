"""Footprints as discs: pressing handles nothing but discs."""

from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles
from ...components.presser import Presser
from ..wind.outline import Outline, outline_of_polygon

MOST_DISCS = 40
"""Largest number of discs in a footprint."""

_SPACING, _LEAST_DEPTH = 0.9, 0.3
"""Spacing of discs in a polygon, relative to the larger one's radius; smallest radius, relative to the largest."""

_WIDENING = 1.3
"""Factor by which the spacing grows while there are too many discs."""

_CAPSULE_SPACING = 1.4
"""Spacing of discs in a capsule, relative to their radius: between them grass is pressed almost as deep."""


@lru_cache(maxsize=256)
def discs_of(presser: Presser, /) -> Doubles:
    """Return the discs of a footprint in its own frame: middles (x, z) and radii [m], shape (n, 3)."""
    discs = _in_polygon(presser.corners) if presser.corners else _in_capsule(presser.radius, presser.length)
    discs.flags.writeable = False
    return discs


def _in_capsule(radius: float, length: float) -> Doubles:
    """Return a row of discs along a capsule."""
    count = min(1 + int(np.ceil(length / (_CAPSULE_SPACING * radius))), MOST_DISCS)
    ahead = np.linspace(-0.5, 0.5, count) * length if count > 1 else np.zeros(1)
    return np.stack([np.zeros(count), ahead, np.full(count, radius)], axis=1)


def _in_polygon(corners: tuple[tuple[float, float], ...]) -> Doubles:
    """Return discs that fill a polygon, with a wider spacing if there would be too many.

    A polygon thinner than the sampling step of its outline is widened by that step.
    """
    outline = outline_of_polygon(corners)
    depth = outline.depth.astype(np.float64)
    if outline.deepest < outline.step:
        depth += outline.step
    spacing, discs = _SPACING, _discs_in(outline, depth, _SPACING)
    while len(discs) > MOST_DISCS:
        spacing *= _WIDENING
        discs = _discs_in(outline, depth, spacing)
    return discs


def _discs_in(outline: Outline, depth: Doubles, spacing: float) -> Doubles:
    """Return discs in an outline by its depths, the largest first, at least `spacing` of the larger radius apart."""
    rows, columns = np.indices(depth.shape)
    x, z = outline.corner[0] + columns * outline.step, outline.corner[1] + rows * outline.step
    depths, least = depth.copy(), _LEAST_DEPTH * depth.max()
    discs: list[tuple[float, float, float]] = []
    while len(discs) <= MOST_DISCS and depths.max() > least:
        deepest = int(depths.argmax())
        disc = float(x.flat[deepest]), float(z.flat[deepest]), float(depths.flat[deepest])
        discs.append(disc)
        depths[np.hypot(x - disc[0], z - disc[1]) < spacing * disc[2]] = 0.0
    return np.array(discs)
