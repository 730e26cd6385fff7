"""Bounds of the parts of a near tree in any wind: parts outside the picture are not drawn."""

from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Indices
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

    def take(self, number: Indices, /) -> "Balls":
        """Return some of the spheres."""
        return Balls(self.middle.take(number, axis=0), self.radius.take(number))


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
    inside = inside_picture(blocks.middle.T, sides @ matrices_of(trees))
    number = np.flatnonzero((inside >= trees["scale"][:, None] * -blocks.radius).any(axis=0))
    return (int(number[0]), int(number[-1]) + 1) if len(number) else (0, 0)


def inside_picture(places: Doubles, sides: Doubles, /) -> Doubles:
    """Return the distance of places inside the nearest of a picture's sides [m], below 0 outside it, (n, m).

    Places (3, m) or (n, 3, m) [m of a model] and sides, planes (n, 4, 4), are in the axes of the models of n trees.
    """
    return np.asarray((sides[..., :3] @ places + sides[..., 3:]).min(axis=1))


def outside_picture(extents: Doubles, sides: Doubles, /) -> Doubles:
    """Return the distance of upright cylinders outside a picture's sides [m], 0 or less if they may touch it, (n,).

    `extents` are their middles, half their heights and their radii (n, 5) [m], and `sides` planes of the frustum.
    """
    nearer = np.column_stack([sides[:, :3], np.abs(sides[:, 1]), np.hypot(*sides[:, :3:2].T)])
    return np.asarray(-(nearer @ extents.T + sides[:, 3:]).min(axis=0))


def matrices_of(trees: NDArray[np.void], /) -> Doubles:
    """Return the matrices from trees' models to the world, (n, 4, 4); `trees` are records of `INSTANCE`."""
    scale, found = trees["scale"].astype(np.float64), np.zeros((len(trees), 4, 4))
    cosine, sine = scale * trees["turn"].T
    found[:, 0, 0], found[:, 0, 2] = cosine, -sine
    found[:, 2, 0], found[:, 2, 2] = sine, cosine
    found[:, 1, 1], found[:, 3, 3] = scale, 1.0
    found[:, :3, 3] = trees["root"]
    return found


def _sway(place: Doubles, pivot: NDArray[np.floating], height: float) -> Doubles:
    """Return the greatest displacement of places (n, 3) on limbs with these feet in a message of 1 [m]."""
    high, out = place[:, 1] / height, np.linalg.norm(place - pivot, axis=1)
    trunk = 0.5 * high**2 * (LOAD_AT_END - high) * height  # `cantilever` of crown.glsl
    limb = out * out / (out + LIMB_STIFF)
    return np.asarray(MOST_TRUNK * trunk + MOST_LIMB * limb)
