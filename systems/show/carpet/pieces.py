"""Pieces of tiles: only where grass ends or is cut are they drawn as edges ask for, and the rest of a tile without."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Mask
from .holes import Stretches
from .tiles import GRID, HANGS, PARTED, PIECE, Tiles

ALONG = GRID // PIECE
"""Pieces along a side of a tile."""

PIECES = ALONG * ALONG
"""Pieces of a tile, row after row."""

BEGINS = PIECE * np.arange(ALONG, dtype=np.float64)
"""Where on a tile's grid they begin along a side, (ALONG,)."""

COARSEST = 2
"""How many times as far apart grid points are beside a tile, at most."""

COARSEST_PARTED = 4
"""The same beside a tile that is a quarter of one."""

Touches = Callable[[Stretches], Mask]
"""Which stretches of ground have an edge."""


class Parted(NamedTuple):
    """Which pieces of tiles have edges."""

    edged: Mask
    """Those that have, (n, PIECES)."""

    beside: Mask
    """Those, and all that may have a border with, or a corner of, one that has, (n, PIECES)."""

    def of(self, which: NDArray[np.intp], /) -> "Parted":
        """Return it of some of the tiles."""
        return Parted(self.edged.take(which, axis=0), self.beside.take(which, axis=0))


def part(tiles: Tiles, touches: Touches, /, *, wider: int, off: float) -> Parted:
    """Return which pieces of tiles (n, 4) have edges, as which squares of ground do.

    The corners of triangles are `wider` grid points apart, and at rims up to `off` grid points out of their places.
    """
    is_parted = tiles[:, 3] >= PARTED * tiles[:, 2]
    reach = PIECE * np.where(is_parted, COARSEST_PARTED, COARSEST)
    edged, beside = np.zeros((2, len(tiles), PIECES), np.bool_)
    some = np.flatnonzero(touches(_stretches(tiles, GRID, np.zeros(1), reach[:, None], reach[:, None])))
    if len(some):
        tiles, reach = tiles.take(some, axis=0), reach.take(some)[:, None]
        slides = off + np.where(
            is_parted.take(some)[:, None], _slides(wider, parted=True), _slides(wider, parted=False)
        )
        edged[some] = touches(_stretches(tiles, PIECE, BEGINS, slides, np.full_like(slides, off))).reshape(-1, PIECES)
        beside[some] = touches(_stretches(tiles, PIECE, BEGINS, reach, reach)).reshape(-1, PIECES)
    return Parted(edged, edged | beside)


def _stretches(tiles: Tiles, quads: int, begins: Doubles, before: Doubles, behind: Doubles) -> Stretches:
    """Return what parts of so many quads a side lie on, of tiles (n, 4), and so many grid points more.

    They begin at these of the tile's grid (m,) along both axes. Told of what is beside them is (n or 1, m or 1).
    """
    x, z, spacing, _ = tiles.T[:, :, None]
    low, high = spacing * (begins - before), spacing * (begins + quads + behind)
    return Stretches(
        *(each[:, None] for each in (x + low, x + high)), *(each[..., None] for each in (z + low, z + high))
    )


def whole(tiles: Tiles | NDArray[np.void], /) -> Parted:
    """Return that no piece of tiles (n,) has any."""
    none = np.zeros((len(tiles), PIECES), np.bool_)
    return Parted(none, none)


def _slides(wider: int, *, parted: bool) -> Doubles:
    """Return how many grid points their begins slide down at most, as `on_mesh_at` has it, (ALONG,)."""
    pair = 0.5 / wider * BEGINS
    return np.asarray(2.0 * wider * (pair % 1.0 + 2.0 * parted * (0.5 * np.floor(pair) % 1.0)))


class ByLayer(NamedTuple):
    """What draws which tiles, and which pieces of others: records of `TILE`, far to near."""

    bare: NDArray[np.void]
    bare_pieces: NDArray[np.void]
    """Ground alone."""

    even: NDArray[np.void]
    even_pieces: NDArray[np.void]
    """The carpet, and what is under it."""

    edged: NDArray[np.void]
    """Pieces with edges: their ground,"""

    edged_carpet: NDArray[np.void]
    """and of those the carpet, and what is under it."""


def by_layer(tiles: NDArray[np.void], laid: Mask, parted: Parted, eye: tuple[float, float, float], /) -> ByLayer:
    """Return which tiles (n,) each layer draws, by where carpet may lie, (n,), and by their edges.

    Even pieces that adjoin edged ones have bare ground as well: what lies under their carpet ends above that.
    """
    if not parted.beside.any():
        none = tiles[:0]
        return ByLayer(tiles[~laid], none, tiles[laid], none, none, none)
    edged = parted.edged
    is_parted: Mask = np.asarray(edged.any(axis=1))
    of_laid, of_parted, even = laid[:, None], is_parted[:, None], ~edged
    pieces, number = in_pieces(tiles, of_parted | of_laid & parted.beside, edged, eye)
    masks = even & np.where(of_laid, parted.beside, of_parted), even & of_laid & of_parted, edged, edged & of_laid
    bare, carpet, *rest = (pieces[mask.reshape(-1).take(number)] for mask in masks)
    return ByLayer(tiles[~(laid | is_parted)], bare, tiles[laid & ~is_parted], carpet, *rest)


def in_pieces(
    tiles: NDArray[np.void], chosen: Mask, edged: Mask, eye: tuple[float, float, float], /
) -> tuple[NDArray[np.void], NDArray[np.intp]]:
    """Return the chosen pieces (n, PIECES) of tiles, records of `TILE`, far to near, and their numbers among all (m,).

    Their borders hang down but for those towards edged pieces of the same tile.
    """
    number = np.flatnonzero(chosen)
    which, own = np.divmod(number, PIECES)
    found = tiles.take(which)
    if len(found):
        begins, tile = BEGINS.take(np.column_stack([own % ALONG, own // ALONG])), found["tile"]
        found["piece"][:, :2], found["piece"][:, 2] = begins, _hanging(edged).take(number)
        away = tile[:, :2] + tile[:, 2:3] * (begins + 0.5 * PIECE) - (eye[0], eye[2])
        queue = np.argsort(-(away * away).sum(axis=1), kind="stable")
        found, number = found.take(queue), number.take(queue)
    return found, number


def _hanging(edged: Mask) -> Floats:
    """Return the sum of `HANGS` for the sides of each piece towards which none is edged, (n, PIECES)."""
    around = np.pad(edged.reshape(-1, ALONG, ALONG), ((0, 0), (1, 1), (1, 1)))
    sides = around[:, :-2, 1:-1], around[:, 2:, 1:-1], around[:, 1:-1, :-2], around[:, 1:-1, 2:]
    hanging = sum(times * ~beside for times, beside in zip(HANGS, sides, strict=True))
    return np.asarray(hanging, np.float32).reshape(-1, PIECES)
