"""Square tiles of the ground, coarser with distance: their layout, culling, grids and triangle orders."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Mask
from ....engine.terrain.record import Terrain
from ...space.cone import HALF_DIAGONAL, outside_cone
from .rims import Rims

Tiles = NDArray[np.float64]

TILE = np.dtype([("tile", "4f4"), ("piece", "3f4")])
"""Instance record of a tile or of a piece of one. `tile`: low corner (x, z) [m]; grid spacing [m]; distance at which
the next coarser spacing has taken over [m], negative if rims alone ask for the tile. `piece`: grid coordinates of the
piece's start, 0 for whole tiles; sum of `SKIRTS`."""

GRID = 8
"""Quads along a side of a tile."""

PIECE = 2
"""Quads along a side of a piece of a tile: the fewest that a grid with a stride of 2 allows."""

FINE, COARSENESS = 1.25, 0.3
"""Largest grid spacing near the viewer: on cells of 1 m and more, and on the smallest cells [m]."""

SPREAD = 6.0
"""Distance at which a spacing gives way to the next coarser one, in tile sides: when a tile of twice the side is split,
its farthest corner must lie inside."""

OUTWARD = np.array([False, True, True, False])
"""Whether a skirt's triangles, in the order of its vertices, face out of the piece, for the sides of `SKIRTS`."""

ORDERS = 8
"""Number of orders in which the triangles of a tile may be drawn."""

WITHIN_PATCH = 1e-3
"""Distance by which a tile reaches into a patch before it counts as lying on it [patches]."""

QUARTERED = 1.5 * SPREAD * GRID
"""Smallest ratio of take-over distance to spacing in `TILE` that marks a quarter of a tile."""

SKIRTS = 1, 2, 4, 8
"""Bits for the sides of a piece that have a skirt, a border that hangs down: low z, high z, low x and high x."""

GLSL = {"QUARTERED": QUARTERED, "PIECE": float(PIECE)} | dict(
    zip(("LOW_Z", "HIGH_Z", "LOW_X", "HIGH_X"), SKIRTS, strict=True)
)


def tiles_around(
    terrain: Terrain,
    place: tuple[float, float],
    /,
    *,
    spacing: float,
    about: float = 0.0,
    rims: Rims | None = None,
    quartered: bool = False,
) -> Tiles:
    """Return the tiles (n, 4), rows as in `TILE`, that cover a terrain and what is beyond it.

    They suit every eye within `about` [m] of a place (x, z) [m]; `about` may be a third of the finest tiles' side. A
    tile of `GRID` quads is split in four while it is nearer than `SPREAD` sides of its quarters, down to a grid spacing
    of `spacing` [m]. At `rims` tiles count as nearer, and are split down to the terrain's cells. With `quartered`, each
    of the finest tiles that no rim asks for comes as four quarters of half the spacing and the same take-over distance.
    """
    extra_levels = 0 if rims is None else max(int(np.ceil(np.log2(spacing / terrain.cell))), 0)
    edge, size = np.asarray(terrain.origin) - terrain.beyond, np.asarray(terrain.size) + 2.0 * terrain.beyond
    levels = max(0, int(np.ceil(np.log2(max(size) / (spacing * GRID)))))
    side = spacing * GRID * 2.0**levels
    corners = _covering(edge, size, side)
    done: list[Tiles] = []
    for level in range(levels, -1 - extra_levels, -1):
        corners = corners[((corners < edge + size) & (corners + side > edge)).all(axis=1)]
        near = _nearest(corners, side, place) - about if level > 0 else np.full(len(corners), np.inf)
        if rims is not None:
            reach = HALF_DIAGONAL * side + about
            near = np.minimum(near, rims.mesh_distance(corners + 0.5 * side, np.array(place)) - reach)
        split = (near < SPREAD * side / 2) if level > -extra_levels else np.zeros(len(corners), np.bool_)
        kept, far = corners[~split], SPREAD * side * (1.0 if level >= 0 else -1.0)
        if quartered and level == 0:
            done.append(_rows(_in_four(kept, side), side / 2.0, far))
        else:
            done.append(_rows(kept, side, far))
        corners = _in_four(corners[split], side)
        side /= 2.0
    return np.concatenate(done)


def _covering(edge: Tiles, size: Tiles, side: float) -> Tiles:
    """Return the low corners (n, 2) of the squares of a side that cover a rectangle from the corner `edge` on [m]."""
    low = np.floor(edge / side) * side
    counts = np.ceil((edge + size - low) / side).astype(int)
    return np.asarray(low + side * np.stack(np.meshgrid(*map(np.arange, counts)), -1).reshape(-1, 2))


def _rows(corners: Tiles, side: float, far: float) -> Tiles:
    """Return rows of `TILE`, (n, 4), of tiles with these low corners (n, 2), a side and a take-over distance [m]."""
    return np.column_stack([corners, np.full(len(corners), side / GRID), np.full(len(corners), far)])


def _in_four(corners: Tiles, side: float) -> Tiles:
    """Return the low corners (4 n, 2) of the quarters of tiles with low corners (n, 2) and a side [m]."""
    return (corners[:, None, :] + 0.5 * side * np.array([[0, 0], [1, 0], [0, 1], [1, 1]])).reshape(-1, 2)


def which_seen(tiles: Tiles, eye: tuple[float, float, float], cone: tuple[float, float], /) -> NDArray[np.intp]:
    """Return the row numbers of the tiles, of `tiles_around` (n, 4), that may be seen, far to near."""
    side = tiles[:, 2] * GRID
    x, z = tiles[:, 0] + 0.5 * side, tiles[:, 1] + 0.5 * side
    seen = (outside_cone(x, z, apex=(eye[0], eye[2]), cone=cone) <= 0.75 * side).nonzero()[0]
    across, along = x.take(seen) - eye[0], z.take(seen) - eye[2]
    return seen.take(np.argsort(-(across * across + along * along)))


def records_of(tiles: Tiles, rows: NDArray[np.intp], /) -> NDArray[np.void]:
    """Return the records of `TILE` of some rows of `tiles_around` (n, 4), as whole tiles."""
    found = np.zeros(len(rows), TILE)
    found["tile"] = tiles.take(rows, axis=0)
    return found


def finest_spacing(terrain: Terrain, patch: float, /) -> float:
    """Return the grid spacing near the viewer [m], a whole fraction of a patch's side.

    It resolves the terrain's cells, so that no root stands in the air or in the ground.
    """
    enough = min(FINE, max(FINE * terrain.cell, COARSENESS))
    return float(patch / 2.0 ** max(1, int(np.ceil(np.log2(patch / enough)))))


def bare_within(
    tiles: NDArray[np.void], carpeted: Mask, centre: NDArray[np.int32], /, *, patch: float, reach: int
) -> NDArray[np.bool_]:
    """Return which tiles (n,) lie wholly within the discrete distance `reach`, on patches without carpet, shape (n,).

    `carpeted` (side, side) tells of each patch around the viewer's cell whether it has any, by the rows of its table.
    Within a negative reach no tile lies.
    """
    lowest, side = centre - reach, max(2 * reach + 1, 0)
    along, across = ((lowest[:, None] + np.arange(side)) % len(carpeted))[::-1]
    sums = np.zeros((side + 1, side + 1), np.int32)  # numbers of carpeted patches before each corner of a patch
    np.cumsum(carpeted[along[:, None], across].cumsum(axis=0, dtype=np.int32), axis=1, out=sums[1:, 1:])
    first, last = (
        (step(ends / patch + off) - lowest).astype(np.intp)
        for step, ends, off in zip((np.floor, np.ceil), _corners(tiles), (WITHIN_PATCH, -WITHIN_PATCH), strict=True)
    )
    inside = ((first >= 0) & (last <= side)).all(axis=1)
    (x0, z0), (x1, z1) = (np.minimum(np.maximum(each, 0), side).T for each in (first, last))
    return np.asarray(inside & (sums[z1, x1] - sums[z0, x1] - sums[z1, x0] + sums[z0, x0] == 0))


def on_terrain(tiles: NDArray[np.void], terrain: Terrain, /) -> NDArray[np.bool_]:
    """Return which tiles (n,) lie wholly on the terrain, shape (n,)."""
    low, (first, last) = np.asarray(terrain.origin), _corners(tiles)
    return np.asarray(((first >= low - 1e-3) & (last <= low + terrain.size + 1e-3)).all(axis=1))


def meets_terrain(tiles: NDArray[np.void], terrain: Terrain, /) -> NDArray[np.bool_]:
    """Return which tiles (n,) lie on the terrain at least in part, shape (n,)."""
    low, (first, last) = np.asarray(terrain.origin), _corners(tiles)
    return np.asarray(((first < low + terrain.size) & (last > low)).all(axis=1))


def _corners(tiles: NDArray[np.void]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the low and the high corner of each tile, (n, 2) [m]."""
    corner, side = tiles["tile"][:, :2], tiles["tile"][:, 2:3] * GRID
    return corner, corner + side


def _nearest(corners: Tiles, side: float, place: tuple[float, float]) -> Tiles:
    """Return the distance (n,) from a place (x, z) to the tiles with these low corners (n, 2) and a side [m]."""
    here = np.array(place)
    away: Tiles = np.linalg.norm(here - np.clip(here, corners, corners + side), axis=1)
    return away


def tile_grid(stride: int = 1, /, *, quads: int = GRID) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the grid points (n, 2) of a tile or piece, and the corners of its triangles, two per quad, (m, 6).

    Corners are `stride` grid points apart.
    """
    line, firsts = np.arange(quads + 1), np.arange(0, quads, stride)
    corners = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2).astype(np.float32)
    first, up = (firsts[:, None] * (quads + 1) + firsts).reshape(-1, 1), stride * (quads + 1)
    quad = np.array([0, up, stride, stride, up, up + stride])
    return corners, (first + quad).astype(np.int32)


def skirted_grid(stride: int = 1, /, *, quads: int) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return `tile_grid` with a skirt. Its vertices lie beyond the grid: the upper ones by 0.5, the lower ones by 1."""
    corners, triangles = tile_grid(stride, quads=quads)
    line, beyond = np.arange(quads + 1.0), list[NDArray[np.float32]]()
    for off in (0.5, 1.0):  # upper vertices, just under the border; lower ones, on the ground
        for axis in (0, 1):
            ends = (-off, quads + off)
            beyond += [np.insert(line[:, None], 1 - axis, end, axis=1).astype(np.float32) for end in ends]
    upper = len(corners) + (quads + 1) * np.arange(4)[:, None] + np.arange(0, quads, stride)
    lower = upper + 4 * (quads + 1)
    first, other = np.where(OUTWARD[:, None], upper, lower), np.where(OUTWARD[:, None], lower, upper)
    skirt = np.stack([first, other, first + stride, first + stride, other, other + stride], axis=-1).reshape(-1, 6)
    return np.concatenate([corners, *beyond]).astype(np.float32), np.concatenate([triangles, skirt]).astype(np.int32)


def in_orders(corners: NDArray[np.float32], triangles: NDArray[np.int32], /) -> NDArray[np.int32]:
    """Return the triangles (m, 6) of a tile in each order that `order_toward` may choose, (ORDERS * m, 6).

    Over a crest the carpet is translucent but writes depth, so what is behind it has to be drawn first.
    """
    x, z = corners[triangles].mean(axis=1).T
    keys = [(x * (1 - 2 * (number & 1)), z * (1 - (number & 2))) for number in range(ORDERS)]
    queues = (np.lexsort(key if number < ORDERS // 2 else key[::-1]) for number, key in enumerate(keys))
    return np.concatenate([triangles[queue] for queue in queues])


def order_toward(azimuth: float, /) -> int:
    """Return the order of `in_orders` that is far to near along an azimuth [rad]: first along the axis nearest to it.

    Bit 0: descending x. Bit 1: descending z. Bit 2: sorted by x first.
    """
    right, back = sin(azimuth), -cos(azimuth)
    return (right > 0.0) + 2 * (back > 0.0) + 4 * (abs(right) > abs(back))
