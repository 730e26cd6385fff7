"""Square tiles of the ground, coarser with distance: which there are, are seen, and are drawn by each layer."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from ....engine.terrain.record import Terrain
from ...space.cone import HALF_DIAGONAL, beyond_cone
from .rims import Rims

Tiles = NDArray[np.float64]

TILE = np.dtype([("tile", "4f4"), ("piece", "3f4")])
GRID = 8
"""Quads along a side of a tile."""

PIECE = 2
"""Quads along a side of a piece of one: as few as one may have whose points are twice as far apart."""

FINE, COARSENESS = 1.25, 0.3
"""Largest distance between grid points near the viewer: on cells of 1 m and more, and on the smallest cells [m]."""

SPREAD = 6.0
"""Distance at which a spacing gives way to the next, in tile sides: the farthest corner of a tile of twice the side
that is split must lie inside it."""

OUTWARD = np.array([False, True, True, False])
"""Of the sides of a border, to low z, high z, low x and high x: whether triangles down from it look out of the tile."""

ORDERS = 8
"""Orders in which the triangles of a tile are drawn."""

PARTED = 1.5 * SPREAD * GRID
"""How far tiles reach at least, of their spacing, that are a quarter of one."""

HANGS = 1, 2, 4, 8
"""What `piece` of `TILE` has for sides of a piece whose border hangs down: to low z, high z, low x and high x."""

GLSL = {"PARTED": PARTED, "PIECE": float(PIECE)} | dict(zip(("LOW_Z", "HIGH_Z", "LOW_X", "HIGH_X"), HANGS, strict=True))


def tiles_around(
    terrain: Terrain,
    place: tuple[float, float],
    /,
    *,
    spacing: float,
    about: float = 0.0,
    rims: Rims | None = None,
    parted: bool = False,
) -> Tiles:
    """Return the tiles that cover a terrain and what is beyond it, for who is near a place (x, z) [m], shape (n, 4).

    "Near" is at most `about` [m] away, which may be a third of the finest tiles' side. A tile of `GRID` quads is split
    in four while it is nearer than `SPREAD` sides of its quarters, down to `spacing` [m] between grid points. At `rims`
    tiles count as nearer, and are split as often as it takes for each cell of the terrain. A row is what `TILE` says.
    With `parted`, the finest that no rim asks for come as four each, of half their spacing, which reach as far as they.
    """
    more = 0 if rims is None else max(int(np.ceil(np.log2(spacing / terrain.cell))), 0)
    side = spacing * GRID
    edge, size = np.asarray(terrain.origin) - terrain.beyond, np.asarray(terrain.size) + 2.0 * terrain.beyond
    levels = max(0, int(np.ceil(np.log2(max(size) / side))))
    side *= 2.0**levels
    low = np.floor(edge / side) * side
    counts = np.ceil((edge + size - low) / side).astype(int)
    corners = low + side * np.stack(np.meshgrid(*map(np.arange, counts)), -1).reshape(-1, 2)
    done: list[Tiles] = []
    for level in range(levels, -1 - more, -1):
        corners = corners[((corners < edge + size) & (corners + side > edge)).all(axis=1)]
        near = _nearest(corners, side, place) - about if level > 0 else np.full(len(corners), np.inf)
        if rims is not None:
            reach = HALF_DIAGONAL * side + about
            near = np.minimum(near, rims.near_to(corners + 0.5 * side, np.array(place)) - reach)
        split = (near < SPREAD * side / 2) if level > -more else np.zeros(len(corners), np.bool_)
        kept, far = corners[~split], SPREAD * side * (1.0 if level >= 0 else -1.0)
        if parted and level == 0:
            done.append(_rows(_in_four(kept, side), side / 2.0, far))
        else:
            done.append(_rows(kept, side, far))
        corners = _in_four(corners[split], side)
        side /= 2.0
    return np.concatenate(done)


def _rows(corners: Tiles, side: float, far: float) -> Tiles:
    """Return what `TILE` says of tiles with these corners (n, 2), of a side [m], shape (n, 4)."""
    return np.column_stack([corners, np.full(len(corners), side / GRID), np.full(len(corners), far)])


def _in_four(corners: Tiles, side: float) -> Tiles:
    """Return the corners of the quarters (4 n, 2) of tiles with these corners (n, 2), of a side [m]."""
    return (corners[:, None, :] + 0.5 * side * np.array([[0, 0], [1, 0], [0, 1], [1, 1]])).reshape(-1, 2)


def tiles_seen(tiles: Tiles, eye: tuple[float, float, float], cone: tuple[float, float], /) -> NDArray[np.void]:
    """Return those of `tiles_around` (n, 4) that may be seen, records of `TILE`, far to near."""
    return records_of(tiles, which_seen(tiles, eye, cone))


def which_seen(tiles: Tiles, eye: tuple[float, float, float], cone: tuple[float, float], /) -> NDArray[np.intp]:
    """Return the numbers of those of `tiles_around` (n, 4) that may be seen, far to near."""
    side = tiles[:, 2] * GRID
    x, z = tiles[:, 0] + 0.5 * side, tiles[:, 1] + 0.5 * side
    seen = (beyond_cone(x, z, apex=(eye[0], eye[2]), cone=cone) <= 0.75 * side).nonzero()[0]
    across, along = x.take(seen) - eye[0], z.take(seen) - eye[2]
    return seen.take(np.argsort(-(across * across + along * along)))


def records_of(tiles: Tiles, which: NDArray[np.intp], /) -> NDArray[np.void]:
    """Return some of `tiles_around` (n, 4) whole, records of `TILE`."""
    found = np.zeros(len(which), TILE)
    found["tile"] = tiles.take(which, axis=0)
    return found


def ground_tiles(
    terrain: Terrain,
    eye: tuple[float, float, float],
    cone: tuple[float, float],
    /,
    *,
    spacing: float,
    rims: Rims | None = None,
) -> NDArray[np.void]:
    """Return the tiles that cover what is seen of the ground, records of `TILE`, far to near."""
    return tiles_seen(tiles_around(terrain, (eye[0], eye[2]), spacing=spacing, rims=rims), eye, cone)


def finest_spacing(terrain: Terrain, patch: float, /) -> float:
    """Return the distance between grid points near the viewer [m], a whole fraction of a patch's side.

    It is fine enough for the terrain's own cells, so that no root stands in the air or in the ground.
    """
    enough = min(FINE, max(FINE * terrain.cell, COARSENESS))
    return float(patch / 2.0 ** max(1, int(np.ceil(np.log2(patch / enough)))))


def within(tiles: NDArray[np.void], centre: NDArray[np.int32], /, *, patch: float, reach: int) -> NDArray[np.bool_]:
    """Return which tiles (n,) lie wholly within the discrete distance `reach` of the viewer's cell, shape (n,)."""
    low, high = (centre - reach) * patch, (centre + reach + 1) * patch
    corner, side = tiles["tile"][:, :2], tiles["tile"][:, 2:3] * GRID
    inside: NDArray[np.bool_] = ((corner >= low - 1e-3) & (corner + side <= high + 1e-3)).all(axis=1)
    return inside


def on_terrain(tiles: NDArray[np.void], terrain: Terrain, /) -> NDArray[np.bool_]:
    """Return which tiles (n,) lie wholly on the terrain, shape (n,)."""
    low = np.asarray(terrain.origin)
    corner, side = tiles["tile"][:, :2], tiles["tile"][:, 2:3] * GRID
    inside: NDArray[np.bool_] = ((corner >= low - 1e-3) & (corner + side <= low + terrain.size + 1e-3)).all(axis=1)
    return inside


def meets_terrain(tiles: NDArray[np.void], terrain: Terrain, /) -> NDArray[np.bool_]:
    """Return which tiles (n,) lie on the terrain at least in part, shape (n,)."""
    low = np.asarray(terrain.origin)
    corner, side = tiles["tile"][:, :2], tiles["tile"][:, 2:3] * GRID
    meets: NDArray[np.bool_] = ((corner < low + terrain.size) & (corner + side > low)).all(axis=1)
    return meets


def _nearest(corners: Tiles, side: float, place: tuple[float, float]) -> Tiles:
    here = np.array(place)
    away: Tiles = np.linalg.norm(here - np.clip(here, corners, corners + side), axis=1)
    return away


def tile_grid(wider: int = 1, /, *, quads: int = GRID) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the grid points (n, 2) of a tile, or of a piece of fewer quads, and the corners of its triangles, (m, 6).

    Corners are `wider` grid points apart.
    """
    line, firsts = np.arange(quads + 1), np.arange(0, quads, wider)
    corners = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2).astype(np.float32)
    first, up = (firsts[:, None] * (quads + 1) + firsts).reshape(-1, 1), wider * (quads + 1)
    quad = np.array([0, up, wider, wider, up, up + wider])
    return corners, (first + quad).astype(np.int32)


def hanging_grid(wider: int = 1, /, *, quads: int = GRID) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the same with a border that hangs down: its lower corners lie beyond the grid."""
    corners, triangles = tile_grid(wider, quads=quads)
    line, beyond = np.arange(quads + 1.0), list[NDArray[np.float32]]()
    for off in (0.5, 1.0):  # just under the border, and on the ground
        for axis in (0, 1):
            ends = (-off, quads + off)
            beyond += [np.insert(line[:, None], 1 - axis, end, axis=1).astype(np.float32) for end in ends]
    upper = len(corners) + (quads + 1) * np.arange(4)[:, None] + np.arange(0, quads, wider)
    lower = upper + 4 * (quads + 1)
    first, other = np.where(OUTWARD[:, None], upper, lower), np.where(OUTWARD[:, None], lower, upper)
    hangs = np.stack([first, other, first + wider, first + wider, other, other + wider], axis=-1).reshape(-1, 6)
    return np.concatenate([corners, *beyond]).astype(np.float32), np.concatenate([triangles, hangs]).astype(np.int32)


def in_orders(corners: NDArray[np.float32], triangles: NDArray[np.int32], /) -> NDArray[np.int32]:
    """Return triangles (m, 6) of a tile in each order that `order_toward` may choose, (ORDERS * m, 6).

    Over a crest a carpet lets through what is behind, but writes its depth: so that has to be drawn before.
    """
    x, z = corners[triangles].mean(axis=1).T
    keys = [(x * (1 - 2 * (number & 1)), z * (1 - (number & 2))) for number in range(ORDERS)]
    queues = (np.lexsort(key if number < ORDERS // 2 else key[::-1]) for number, key in enumerate(keys))
    return np.concatenate([triangles[queue] for queue in queues])


def order_toward(azimuth: float, /) -> int:
    """Return which of `in_orders` goes from far to near for who looks that way [rad]: first along the nearer axis.

    With bit 0 it is by x downwards, with bit 1 by z downwards, and with bit 2 by x first.
    """
    right, back = sin(azimuth), -cos(azimuth)
    return (right > 0.0) + 2 * (back > 0.0) + 4 * (abs(right) > abs(back))
