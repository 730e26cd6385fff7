"""The crown as a medium: how much leaf light meets on its way to each twig, from any side."""

import numpy as np

from ...components.arrays import Doubles, Floats
from .grow import Tree, Twigs
from .habit import GOLDEN, Leaf

CELLS = 24
"""Cells of leaf area across a crown's longest side."""

STEPS = 14
"""Steps of a ray through the crown."""

FARTHEST = 1.1
"""How far such a ray goes, of that side."""

WAYS = 20
"""Rays from a place, evenly to all sides."""

AROUND = 0.3
"""How far the cells go beyond the middles of all twigs [m]."""

SHARE = 0.5
"""Of leaf area that faces all ways, so much is seen from any side (Ross, The Radiation Regime of Plants, 1981)."""

CLUMPED = 0.4
"""Leaves stand in clumps, with gaps between: they hide as much as so many that were strewn (Nilson, A Theoretical
Analysis of the Frequency of Gaps in Plant Stands, 1971)."""


LEAST_SHADE = 4.0
"""How far from its trunk a tree shades the grass at least [m]: the sky is broad."""

SHADE_OF_HEIGHT = 0.35
"""How far it does so at least, of its height."""

SKY_MEETS = 0.75
"""How many leaves the sky's light meets, which comes from all sides, of those straight above."""

FOOT = 1.6
"""How far about its foot a trunk itself hides the sky from the grass, and leaves it less water [m]: a map that pixels
read has texels of 1 m."""

FOOT_MEETS, FOOT_MEETS_MOST = 12.0 / (np.pi * FOOT), float(np.log(2.0))
"""As many leaves as that hides the sky in the middle, for each metre of the trunk's radius r; and at most, as right at
a wide trunk half of the sky is hidden. At a distance d it hides asin(r / d) / pi of all ways, over that disc 2 r times
its radius: as much again is for the water that its roots take."""

GLSL = {"LEAST_SHADE": LEAST_SHADE, "TRUNK_FOOT": FOOT, "FOOT_MEETS_MOST": FOOT_MEETS_MOST}


def shade_of(area: float, radius: float, height: float, trunk: float, /) -> tuple[float, float, float]:
    """Return how far a tree shades the grass [m]; leaves that the sky's light meets, times area [m²]; and at its foot.

    So many are met on the ground in the middle of a disc of that area by its radius squared, and less from there to its
    edge by the square of 1 - r². `area` is that of its leaves [m²], `radius` that of its crown, `height` its own, and
    `trunk` the radius of its trunk [m].
    """
    leaves = 3.0 / np.pi * SKY_MEETS * SHARE * CLUMPED * area
    return max(radius, SHADE_OF_HEIGHT * height), leaves, FOOT_MEETS * trunk


def leaf_area(twigs: Twigs, leaf: Leaf, usual: float, /) -> Doubles:
    """Return the leaf area of each twig, one side of its leaves [m²], shape (n,); `usual` is a twig's length [m]."""
    own = leaf.count * leaf.length * leaf.width * leaf.area
    return np.asarray(own * (twigs.length.astype(np.float64) / usual) ** 2)


def shading(tree: Tree, area: Doubles, place: Doubles, /) -> Floats:
    """Return how many leaves light meets before it comes to places (n, 3): by the direction to it (x, y, z), and 1.

    `area` is each twig's leaf area [m²]. Shape (n, 4): the sum of products with those is the number of leaves, of what
    one hides (Beer). It is the linear part of what is met along rays to all sides.
    """
    middle = tree.twigs.foot.astype(np.float64) + 0.5 * tree.twigs.length[:, None] * tree.twigs.along
    low, high = middle.min(axis=0) - AROUND, middle.max(axis=0) + AROUND
    cell = float((high - low).max()) / CELLS
    size = np.maximum(np.ceil((high - low) / cell).astype(np.intp), 1)
    dense = np.zeros(size)
    at = np.minimum(((middle - low) / cell).astype(np.intp), size - 1)
    np.add.at(dense, tuple(at.T), area * SHARE * CLUMPED / cell**3)
    ways = _ways()
    met = np.stack([_met(dense, (place - low) / cell, way, cell) for way in ways], axis=1)
    terms = np.column_stack([ways, np.ones(len(ways))])
    return np.asarray(np.linalg.lstsq(terms, met.T, rcond=None)[0].T, np.float32)


def _ways() -> Doubles:
    """Return directions evenly to all sides, unit vectors (n, 3)."""
    number = np.arange(WAYS) + 0.5
    up, around = 1.0 - 2.0 * number / WAYS, number * GOLDEN
    flat = np.sqrt(1.0 - up * up)
    return np.stack([flat * np.cos(around), up, flat * np.sin(around)], axis=1)


def _met(dense: Doubles, place: Doubles, way: Doubles, cell: float) -> Doubles:
    """Return the leaf area that rays from places (n, 3) [cells] meet on a way, of the area across it, shape (n,)."""
    ends = (np.arange(STEPS + 1) / STEPS) ** 2 * float(max(dense.shape)) * FARTHEST  # finer near by
    along, length = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends) * cell
    at = (place[:, None] + along[None, :, None] * way).astype(np.intp)
    inside = ((at >= 0) & (at < dense.shape)).all(axis=-1)
    at = np.clip(at, 0, np.array(dense.shape) - 1)
    return np.asarray((dense[at[..., 0], at[..., 1], at[..., 2]] * inside) @ length)
