"""Footprints: every shape is made of discs, and discs are all that the rest of pressing knows."""

from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles
from ...components.presser import Presser
from ..wind.outline import Outline, outline_of_polygon

MOST_DISCS = 40
"""How many discs a footprint is made of at most."""

_APART, _LEAST = 0.9, 0.3
"""How far apart discs stand, of the larger one's radius; the least depth of one, of the deepest."""

_FARTHER = 1.3
"""How many times farther apart they stand where there would be too many."""


_ALONG = 1.4
"""How far apart a capsule's stand, of their radius: between them grass is pressed almost as deep."""


@lru_cache(maxsize=256)
def discs_of(presser: Presser, /) -> Doubles:
    """Return the discs of a footprint in its own frame: middles (x, z) and radii [m], shape (n, 3)."""
    found = _in_polygon(presser.corners) if presser.corners else _in_capsule(presser.radius, presser.length)
    found.flags.writeable = False
    return found


def _in_capsule(radius: float, length: float) -> Doubles:
    count = min(1 + int(np.ceil(length / (_ALONG * radius))), MOST_DISCS)
    ahead = np.linspace(-0.5, 0.5, count) * length if count > 1 else np.zeros(1)
    return np.stack([np.zeros(count), ahead, np.full(count, radius)], axis=1)


def _in_polygon(corners: tuple[tuple[float, float], ...]) -> Doubles:
    """Return discs that fill a polygon; where it would take too many, they stand farther apart, all over it.

    One that is thinner than the samples of its outline are apart counts as that much wider.
    """
    outline = outline_of_polygon(corners)
    depth = outline.depth.astype(np.float64)
    if outline.deepest < outline.step:
        depth += outline.step
    apart, discs = _APART, _discs_in(outline, depth, _APART)
    while len(discs) > MOST_DISCS:
        apart *= _FARTHER
        discs = _discs_in(outline, depth, apart)
    return discs


def _discs_in(outline: Outline, depth: Doubles, apart: float) -> Doubles:
    """Return discs, the largest first; each stands outside the middles of those before it."""
    rows, columns = np.indices(depth.shape)
    x, z = outline.corner[0] + columns * outline.step, outline.corner[1] + rows * outline.step
    left, least = depth.copy(), _LEAST * depth.max()
    discs: list[tuple[float, float, float]] = []
    while len(discs) <= MOST_DISCS and left.max() > least:
        at = int(left.argmax())
        disc = float(x.flat[at]), float(z.flat[at]), float(left.flat[at])
        discs.append(disc)
        left[np.hypot(x - disc[0], z - disc[1]) < apart * disc[2]] = 0.0
    return np.array(discs)
