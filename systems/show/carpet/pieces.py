"""Pieces of tiles: those where grass ends or is cut are drawn by costlier programs, the rest of a tile is not."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Mask
from .holes import Rectangles
from .tiles import GRID, PIECE, QUARTERED, SKIRTS, Tiles

ALONG = GRID // PIECE
"""Pieces along a side of a tile."""

PIECES = ALONG * ALONG
"""Pieces of a tile, row after row."""

STARTS = PIECE * np.arange(ALONG, dtype=np.float64)
"""Grid coordinates of a tile at which its pieces start along a side, (ALONG,)."""

COARSEST = 2
"""Largest grid spacing of a tile's neighbours, in spacings of the tile."""

COARSEST_BESIDE_QUARTER = 4
"""Largest grid spacing of the neighbours of a quarter of a tile, in spacings of the quarter."""

Touches = Callable[[Rectangles], Mask]
"""Returns which rectangles of ground touch an edge."""


class PieceEdges(NamedTuple):
    """Masks of pieces of tiles, by their edges."""

    edged: Mask
    """Pieces with an edge, (n, PIECES)."""

    beside: Mask
    """Pieces with an edge, and all that may share a border or a corner with one, (n, PIECES)."""

    def take(self, rows: NDArray[np.intp], /) -> "PieceEdges":
        """Return the rows of some of the tiles."""
        return PieceEdges(self.edged.take(rows, axis=0), self.beside.take(rows, axis=0))


def find_edges(tiles: Tiles, touches: Touches, /, *, stride: int, offset: float) -> PieceEdges:
    """Return which pieces of tiles (n, 4) have edges.

    The corners of triangles are `stride` grid points apart, and at rims up to `offset` grid points off the grid.
    """
    is_quarter = tiles[:, 3] >= QUARTERED * tiles[:, 2]
    reach = PIECE * np.where(is_quarter, COARSEST_BESIDE_QUARTER, COARSEST)
    edged, beside = np.zeros((2, len(tiles), PIECES), np.bool_)
    rows = np.flatnonzero(touches(_rectangles(tiles, GRID, np.zeros(1), reach[:, None], reach[:, None])))
    if len(rows):
        tiles, reach = tiles.take(rows, axis=0), reach.take(rows)[:, None]
        slides = offset + np.where(
            is_quarter.take(rows)[:, None], _slides(stride, quartered=True), _slides(stride, quartered=False)
        )
        at_rims = np.full_like(slides, offset)
        edged[rows] = touches(_rectangles(tiles, PIECE, STARTS, slides, at_rims)).reshape(-1, PIECES)
        beside[rows] = touches(_rectangles(tiles, PIECE, STARTS, reach, reach)).reshape(-1, PIECES)
    return PieceEdges(edged, edged | beside)


def _rectangles(tiles: Tiles, quads: int, starts: Doubles, before: Doubles, behind: Doubles) -> Rectangles:
    """Return the rectangles of squares of `quads` a side on tiles (n, 4), widened by some grid points.

    Squares start at the grid coordinates `starts` (m,) along both axes. `before` and `behind`, (n or 1, m or 1), are
    the grid points added on the low and on the high sides.
    """
    x, z, spacing, _ = tiles.T[:, :, None]
    low, high = spacing * (starts - before), spacing * (starts + quads + behind)
    return Rectangles(
        *(bound[:, None] for bound in (x + low, x + high)), *(bound[..., None] for bound in (z + low, z + high))
    )


def _slides(stride: int, *, quartered: bool) -> Doubles:
    """Return how many grid points each piece's start slides down at most, as in `on_mesh_at` of mesh.glsl, (ALONG,)."""
    pair = 0.5 / stride * STARTS
    return np.asarray(2.0 * stride * (pair % 1.0 + 2.0 * quartered * (0.5 * np.floor(pair) % 1.0)))


class ByLayer(NamedTuple):
    """Tiles and pieces of tiles, by the layer that draws them: records of `TILE`, far to near."""

    bare: NDArray[np.void]
    bare_pieces: NDArray[np.void]
    """Ground without carpet or edges."""

    even: NDArray[np.void]
    even_pieces: NDArray[np.void]
    """Carpet without edges, and the layer under it."""

    edged: NDArray[np.void]
    """Ground of the pieces with edges."""

    edged_carpet: NDArray[np.void]
    """Carpet of the pieces with edges, and the layer under it."""


def by_layer(
    tiles: NDArray[np.void], has_carpet: Mask, edges: PieceEdges, eye: tuple[float, float, float], /
) -> ByLayer:
    """Return the tiles (n,) and pieces that each layer draws; `has_carpet` (n,) tells where carpet may lie.

    Even pieces beside edged ones are drawn as bare ground as well: the layer under their carpet ends above the ground.
    """
    if not edges.beside.any():
        none = tiles[:0]
        return ByLayer(tiles[~has_carpet], none, tiles[has_carpet], none, none, none)
    edged, beside = edges
    is_split: Mask = np.asarray(edged.any(axis=1))
    carpet, split, even = has_carpet[:, None], is_split[:, None], ~edged
    pieces, number = pieces_of(tiles, split | carpet & beside, edged, eye)
    masks = even & np.where(carpet, beside, split), even & carpet & split, edged, edged & carpet
    bare_pieces, even_pieces, *rest = (pieces[mask.reshape(-1).take(number)] for mask in masks)
    return ByLayer(tiles[~(has_carpet | is_split)], bare_pieces, tiles[has_carpet & ~is_split], even_pieces, *rest)


def pieces_of(
    tiles: NDArray[np.void], chosen: Mask, edged: Mask, eye: tuple[float, float, float], /
) -> tuple[NDArray[np.void], NDArray[np.intp]]:
    """Return the chosen pieces (n, PIECES) of tiles, records of `TILE`, far to near, and their flat indices (m,).

    Their sides have skirts, except towards edged pieces of the same tile.
    """
    number = np.flatnonzero(chosen)
    tile_number, piece_number = np.divmod(number, PIECES)
    found = tiles.take(tile_number)
    if len(found):
        starts, tile = STARTS.take(np.column_stack([piece_number % ALONG, piece_number // ALONG])), found["tile"]
        found["piece"][:, :2], found["piece"][:, 2] = starts, _skirts(edged).take(number)
        away = tile[:, :2] + tile[:, 2:3] * (starts + 0.5 * PIECE) - (eye[0], eye[2])
        queue = np.argsort(-(away * away).sum(axis=1), kind="stable")
        found, number = found.take(queue), number.take(queue)
    return found, number


def _skirts(edged: Mask) -> Floats:
    """Return the sum of `SKIRTS` over each piece's sides that adjoin no edged piece of its tile, (n, PIECES)."""
    around = np.pad(edged.reshape(-1, ALONG, ALONG), ((0, 0), (1, 1), (1, 1)))
    sides = around[:, :-2, 1:-1], around[:, 2:, 1:-1], around[:, 1:-1, :-2], around[:, 1:-1, 2:]
    skirts = sum(bit * ~beside for bit, beside in zip(SKIRTS, sides, strict=True))
    return np.asarray(skirts, np.float32).reshape(-1, PIECES)
