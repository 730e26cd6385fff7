"""Bounds of the parts of a near tree in any wind: parts outside the picture are not drawn."""

from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ..space.frustum import outside_planes
from .bark import MOST_OUTSET, Faces, Wood
from .grow import POINTS
from .habit import Habit
from .motion import (
    FLUTTERS,
    LEAF_TURNS,
    LIMB_LEANS,
    LIMB_SIDEWAYS,
    LIMB_STIFF,
    LIMB_SWINGS,
    LOAD_AT_END,
    TRUNK_LEANS,
    TRUNK_SIDEWAYS,
    TRUNK_SWINGS,
)  # fmt: skip
from .twig import BLOCK, card_reach

LARGER = 1.35
"""Greatest size of a near tree's twig on its card, relative to its own: where two thirds of the twigs are drawn."""

MOST_TRUNK = hypot(TRUNK_LEANS + TRUNK_SWINGS, TRUNK_SIDEWAYS * TRUNK_SWINGS)
"""Greatest displacement of a trunk's top by a message of 1, relative to its height: along the wind and across it."""

MOST_LIMB = hypot(LIMB_LEANS + LIMB_SWINGS, LIMB_SIDEWAYS * LIMB_SWINGS, LIMB_SWINGS)
"""Greatest displacement of a limb by a message of 1: along the wind, across it and upwards, as in `swayed` of
tree.glsl."""

MOST_FLUTTER = LEAF_TURNS * hypot(*FLUTTERS)
"""Greatest displacement of a twig's tip against its foot, relative to its length: `tip_offset` of twig.glsl."""


class Balls(NamedTuple):
    """Bounding spheres of parts of a model in any wind."""

    middle: Doubles
    """(n, 3) [m]."""

    radius: Doubles
    """(n,) [m]."""


def twig_balls(twigs: NDArray[np.void], height: float, habit: Habit, /) -> Balls:
    """Return the bounding spheres of twigs, records of `TWIG`, on their cards."""
    wide, back, ahead = card_reach(habit)
    reach = hypot(wide, max(ahead - 0.5, 0.5 - back)) + MOST_FLUTTER * ahead
    middle = twigs["foot"] + 0.5 * twigs["span"][:, None] * twigs["along"].astype(np.float64)
    return Balls(middle, LARGER * reach * twigs["span"] + _sway(middle, twigs["pivot"], height))


def grouped(places: Doubles, /) -> NDArray[np.intp]:
    """Return the order of places (n, 3) in which each `BLOCK` are neighbours: halved again and again, across."""
    done, left = list[NDArray[np.intp]](), [np.arange(len(places))]
    while left:
        rows = left.pop()
        if len(rows) <= BLOCK:
            done.append(rows)
            continue
        half = BLOCK * max(len(rows) // BLOCK // 2, 1)
        rows = rows[np.argsort(places[rows, np.ptp(places[rows], axis=0).argmax()])]
        left += [rows[half:], rows[:half]]
    return np.concatenate(done)


def blocks_of(balls: Balls, order: NDArray[np.intp], /) -> Balls:
    """Return the bounding spheres of each `BLOCK` of spheres in an order; in the last one there may be fewer."""
    first = np.arange(0, len(order), BLOCK)
    middle, radius = balls.middle[order], balls.radius[order]
    low = np.minimum.reduceat(middle - radius[:, None], first)
    high = np.maximum.reduceat(middle + radius[:, None], first)
    within = 0.5 * (low + high)
    off = np.linalg.norm(middle - within.repeat(BLOCK, axis=0)[: len(order)], axis=1) + radius
    return Balls(within, np.maximum.reduceat(off, first))


def wood_balls(vertices: NDArray[np.void], twigs: NDArray[np.void], height: float, /) -> Balls:
    """Return the bounding spheres of vertices, records of `BARK`, with half of the stems to the next ones.

    `twigs` are records of `TWIG`, among them those of the limbs.
    """
    stem = vertices["stem"].astype(np.float64)
    around = (1.0 + MOST_OUTSET) * stem[:, 3] + 0.5 * height / (POINTS[0] - 1)
    limb = vertices["on_limb"][:, 0].astype(np.intp)
    pivot = np.where(limb[:, None] > 0, twigs["pivot"][limb], stem[:, :3])
    return Balls(stem[:, :3], around + _sway(stem[:, :3], pivot, height))


def near_wood(wood: Wood, vertices: NDArray[np.void], balls: Balls, /) -> tuple[Wood, tuple[Balls, Balls]]:
    """Return wood in blocks of neighbouring triangles, and the bounding spheres of these of `whole` and of `edges`.

    Next to the eye, most of a tree is outside the picture. `balls` are those of the vertices, records of `BARK`.
    """
    found = []
    for faces in wood:
        middle, radius = balls.middle[faces.triangles], balls.radius[faces.triangles]
        within = middle.mean(axis=1)
        off = np.linalg.norm(middle - within[:, None], axis=2) + radius
        order = grouped(within)
        blocks = blocks_of(Balls(within, off.max(axis=1)), order)
        found.append((Faces.of(faces.triangles[order], vertices["stem"]), blocks))
    (whole, of_whole), (edges, of_edges) = found
    return Wood(whole, edges), (of_whole, of_edges)


def blocks_inside(blocks: Balls, trees: NDArray[np.void], sides: Doubles, /) -> tuple[int, int]:
    """Return the first block in the picture of any of some trees, and the one after the last; 0 and 0 if there is none.

    `trees` are records of `INSTANCE`, and `sides` planes of the frustum.
    """
    place, scale = places_of(np.broadcast_to(blocks.middle, (len(trees), *blocks.middle.shape)), trees)
    outside = outside_planes(place.reshape(-1, 3), sides).reshape(len(trees), -1)
    number = np.flatnonzero((outside <= scale[:, None] * blocks.radius).any(axis=0))
    return (int(number[0]), int(number[-1]) + 1) if len(number) else (0, 0)


def places_of(middle: Doubles, trees: NDArray[np.void], /) -> tuple[Doubles, Doubles]:
    """Return where parts of trees' models (n, m, 3) are [m], and the trees' scales (n,); `trees` are of `INSTANCE`."""
    scale = trees["scale"].astype(np.float64)
    (cosine, sine), x, z = scale * trees["turn"].T, middle[..., 0], middle[..., 2]
    place = np.empty_like(middle)
    place[..., 0], place[..., 2] = cosine[:, None] * x - sine[:, None] * z, sine[:, None] * x + cosine[:, None] * z
    place[..., 1] = scale[:, None] * middle[..., 1]
    return np.asarray(place + trees["root"][:, None]), scale


def _sway(place: Doubles, pivot: NDArray[np.floating], height: float) -> Doubles:
    """Return the greatest displacement of places (n, 3) on limbs with these feet in a message of 1 [m]."""
    high, out = place[:, 1] / height, np.linalg.norm(place - pivot, axis=1)
    trunk = 0.5 * high**2 * (LOAD_AT_END - high) * height  # `cantilever` of crown.glsl
    limb = out * out / (out + LIMB_STIFF)
    return np.asarray(MOST_TRUNK * trunk + MOST_LIMB * limb)
