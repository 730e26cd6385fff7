"""The crown as a medium: optical depth of its leaves at each twig, in all directions."""

import numpy as np

from ...components.arrays import Doubles, Floats
from .grow import Tree, Twigs
from .habit import GOLDEN, Leaf

CELLS = 24
"""Cells of leaf area along a crown's longest side."""

STEPS = 14
"""Steps of a ray through the crown."""

RAY_LENGTH = 1.1
"""Length of a ray, relative to the crown's longest side."""

RAYS = 20
"""Rays from a place, in evenly spread directions."""

BORDER = 0.3
"""Border of the cells around the middles of all twigs [m]."""

PROJECTED = 0.5
"""Projected area of randomly oriented leaves, relative to their area (Ross, The Radiation Regime of Plants, 1981)."""

CLUMPING = 0.4
"""Clumping index: leaves in clumps hide as much as this share of randomly strewn ones (Nilson, A Theoretical Analysis
of the Frequency of Gaps in Plant Stands, 1971)."""


LEAST_SHADE = 4.0
"""Least radius of a tree's shade on the grass [m]: the sky is broad."""

SHADE_OF_HEIGHT = 0.35
"""Least radius of a tree's shade, relative to its height."""

SKY_MEETS = 0.75
"""Mean optical depth of skylight, which comes from all sides, relative to that straight up."""

FOOT = 1.6
"""Distance from a trunk at which it hides sky from the grass and takes its water [m]: texels of the map are 1 m."""

FOOT_MEETS, FOOT_MEETS_MOST = 12.0 / (np.pi * FOOT), float(np.log(2.0))
"""Optical depth in the middle that hides as much sky as a trunk, for each metre of its radius r; and its greatest
value, as half the sky is hidden right at a wide trunk. At a distance d a trunk hides asin(r / d) / pi of all
directions; the depth is doubled for the water that its roots take."""

GLSL = {"LEAST_SHADE": LEAST_SHADE, "TRUNK_FOOT": FOOT, "FOOT_MEETS_MOST": FOOT_MEETS_MOST}


def shade_of(area: float, radius: float, height: float, trunk: float, /) -> tuple[float, float, float]:
    """Return a tree's shade on the grass: radius [m]; optical depth times squared radius [m²]; and depth at its foot.

    The depth falls from the middle of the disc to its edge by the square of 1 - r². `area` is that of its leaves [m²],
    `radius` that of its crown, `height` its own, and `trunk` the radius of its trunk [m].
    """
    leaves = 3.0 / np.pi * SKY_MEETS * PROJECTED * CLUMPING * area
    return max(radius, SHADE_OF_HEIGHT * height), leaves, FOOT_MEETS * trunk


def leaf_area(twigs: Twigs, leaf: Leaf, twig_length: float, /) -> Doubles:
    """Return the leaf area of each twig, one side [m²], shape (n,); `twig_length` is the usual one [m]."""
    usual_area = leaf.count * leaf.length * leaf.width * leaf.area
    return np.asarray(usual_area * (twigs.length.astype(np.float64) / twig_length) ** 2)


def shading(tree: Tree, area: Doubles, place: Doubles, /) -> Floats:
    """Return the optical depth of leaves from places (n, 3) outwards, as coefficients of direction (x, y, z) and 1.

    `area` is each twig's leaf area [m²]. Shape (n, 4): their dot product with a direction and 1 is the optical depth
    there. It is a least-squares fit over rays to all sides.
    """
    middle = tree.twigs.foot.astype(np.float64) + 0.5 * tree.twigs.length[:, None] * tree.twigs.along
    low, high = middle.min(axis=0) - BORDER, middle.max(axis=0) + BORDER
    cell = float((high - low).max()) / CELLS
    size = np.maximum(np.ceil((high - low) / cell).astype(np.intp), 1)
    dense = np.zeros(size)
    index = np.minimum(((middle - low) / cell).astype(np.intp), size - 1)
    np.add.at(dense, tuple(index.T), area * PROJECTED * CLUMPING / cell**3)
    directions = _directions()
    depths = np.stack(
        [_optical_depths(dense, (place - low) / cell, direction, cell) for direction in directions], axis=1
    )
    terms = np.column_stack([directions, np.ones(len(directions))])
    return np.asarray(np.linalg.lstsq(terms, depths.T, rcond=None)[0].T, np.float32)


def _directions() -> Doubles:
    """Return evenly spread unit vectors (n, 3)."""
    number = np.arange(RAYS) + 0.5
    up, around = 1.0 - 2.0 * number / RAYS, number * GOLDEN
    flat = np.sqrt(1.0 - up * up)
    return np.stack([flat * np.cos(around), up, flat * np.sin(around)], axis=1)


def _optical_depths(dense: Doubles, place: Doubles, direction: Doubles, cell: float) -> Doubles:
    """Return the optical depth along rays from places (n, 3) [cells] in a direction, shape (n,)."""
    ends = (np.arange(STEPS + 1) / STEPS) ** 2 * float(max(dense.shape)) * RAY_LENGTH  # finer near by
    along, length = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends) * cell
    index = (place[:, None] + along[None, :, None] * direction).astype(np.intp)
    inside = ((index >= 0) & (index < dense.shape)).all(axis=-1)
    index = np.clip(index, 0, np.array(dense.shape) - 1)
    return np.asarray((dense[index[..., 0], index[..., 1], index[..., 2]] * inside) @ length)
