"""Pieces of the ground's tiles: only those at edges of grass are drawn by the program for edges (F4, T1)."""

from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.arrays import Mask
from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.show.carpet.holes import Rectangles
from tallgrass.systems.show.carpet.pieces import PIECES, ByLayer, PieceEdges, by_layer, find_edges
from tallgrass.systems.show.carpet.tiles import (
    GRID,
    PIECE,
    SKIRTS,
    Tiles,
    records_of,
    tiles_around,
    which_seen,
)

WIDE = Terrain(np.zeros((41, 61), np.float32), 10.0)
EYE = (0.3, 1.7, 0.7)
ALL_ROUND = (0.0, pi)
SPACING = 1.25
CORNER = (31.0, 11.0)
"""Place (x, z) where grass ends, in a corner of a tile [m]."""


def tiles_about() -> NDArray[np.void]:
    """Return the tiles all around the eye."""
    around = tiles_around(WIDE, EYE[::2], spacing=SPACING)
    return records_of(around, which_seen(around, EYE, ALL_ROUND))


def touches(rectangles: Rectangles) -> Mask:
    """Return the mask of pieces that contain a corner."""
    low_x, high_x, low_z, high_z = rectangles
    x, z = CORNER
    return np.asarray((low_x <= x) & (x < high_x) & (low_z <= z) & (z < high_z))


def laid_out(tiles: Tiles, *, stride: int = 1, offset: float = 0.0, laid: bool = True) -> ByLayer:
    records = records_of(tiles, which_seen(tiles, EYE, ALL_ROUND))
    seen = which_seen(tiles, EYE, ALL_ROUND)
    edges = find_edges(tiles, touches, stride=stride, offset=offset).take(seen)
    return by_layer(records, np.full(len(records), laid), edges, EYE)


def lies_on(records: NDArray[np.void], *, quads: int) -> NDArray[np.float64]:
    """Return the low corners (x, z) and the sides of tiles, or of pieces, (n, 3)."""
    tile = records["tile"].astype(float)
    return np.column_stack([tile[:, :2] + tile[:, 2:3] * records["piece"][:, :2], quads * tile[:, 2]])


def over(squares: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.int64]:
    """Count the squares (n, 3) over each place (m, 2)."""
    inside = (places[:, None] >= squares[:, :2]) & (places[:, None] < squares[:, :2] + squares[:, 2:])
    return np.asarray(inside.all(axis=2).sum(axis=1))


def test_an_edge_in_one_corner_of_a_tile_is_dear_on_the_piece_there_alone() -> None:
    drawn = laid_out(tiles_around(WIDE, EYE[::2], spacing=SPACING))
    assert len(drawn.edged) == len(drawn.edged_carpet) == 1
    assert over(lies_on(drawn.edged_carpet, quads=PIECE), np.array([CORNER]))[0] == 1
    assert len(drawn.even_pieces) == PIECES - 1


@pytest.mark.parametrize("laid", [False, True])
def test_t1_every_place_is_under_one_tile_or_one_piece(*, laid: bool) -> None:
    drawn = laid_out(tiles_around(WIDE, EYE[::2], spacing=SPACING), laid=laid)
    tiles, pieces = (drawn.even, drawn.even_pieces) if laid else (drawn.bare, drawn.bare_pieces)
    edged = drawn.edged_carpet if laid else drawn.edged
    where = np.random.default_rng(0)
    places = np.concatenate([where.uniform((-300, -200), (300, 200), (400, 2)), where.uniform(10.0, 50.0, (400, 2))])
    counts = [
        over(lies_on(some, quads=quads), places) for some, quads in ((tiles, GRID), (pieces, PIECE), (edged, PIECE))
    ]
    assert (np.sum(counts, axis=0) == 1).all()
    assert counts[0].any()
    assert counts[1].any()


def test_without_edges_tiles_are_drawn_whole() -> None:
    tiles = tiles_about()
    laid, none = np.arange(len(tiles)) % 2 == 0, np.zeros((len(tiles), PIECES), np.bool_)
    drawn = by_layer(tiles, laid, PieceEdges(none, none), EYE)
    np.testing.assert_array_equal(drawn.even, tiles[laid])
    np.testing.assert_array_equal(drawn.bare, tiles[~laid])
    assert not any(map(len, (drawn.bare_pieces, drawn.even_pieces, drawn.edged, drawn.edged_carpet)))


def test_t1_beside_pieces_at_which_grass_ends_there_is_ground_below_all_grass_too() -> None:
    drawn = laid_out(tiles_around(WIDE, EYE[::2], spacing=SPACING))
    low_x, low_z, side = lies_on(drawn.edged, quads=PIECE)[0]
    line = np.linspace(-0.05, 1.05, 12) * side  # a square that is a little larger than that piece
    places = np.stack(np.meshgrid(low_x + line, low_z + line), -1).reshape(-1, 2)
    grounds = over(lies_on(drawn.bare_pieces, quads=PIECE), places) + over(lies_on(drawn.edged, quads=PIECE), places)
    assert (grounds == 1).all()
    assert len(drawn.bare_pieces) < 4 * PIECES


def test_pieces_come_from_far_to_near() -> None:
    drawn = laid_out(tiles_around(WIDE, EYE[::2], spacing=SPACING))
    squares = lies_on(drawn.even_pieces, quads=PIECE)
    off = np.linalg.norm(squares[:, :2] + 0.5 * squares[:, 2:] - (EYE[0], EYE[2]), axis=1)
    assert (np.diff(off) <= 1e-3).all()


def test_borders_hang_down_but_for_those_between_pieces_with_edges() -> None:
    tiles = tiles_about()[:1]
    edged = np.zeros((1, PIECES), np.bool_)
    edged[0, [5, 6]] = True  # one beside the other along x
    drawn = by_layer(tiles, np.ones(1, np.bool_), PieceEdges(edged, edged), EYE)
    low_z, high_z, low_x, high_x = SKIRTS
    hangs = dict(
        zip(map(tuple, drawn.edged["piece"][:, :2].tolist()), drawn.edged["piece"][:, 2].tolist(), strict=True)
    )
    assert hangs == {(2.0, 2.0): low_z + high_z + low_x, (4.0, 2.0): low_z + high_z + high_x}


def test_a_piece_has_an_edge_that_it_comes_to_as_its_points_slide_or_lie_at_a_rim() -> None:
    tiles = tiles_around(WIDE, EYE[::2], spacing=SPACING)
    fine, slid, rim = (
        len(laid_out(tiles, stride=stride, offset=offset).edged) for stride, offset in ((1, 0.0), (2, 0.0), (1, 1.0))
    )
    assert fine == 1
    assert slid == rim == 4
    quartered = tiles_around(WIDE, EYE[::2], spacing=SPACING, quartered=True)
    assert len(laid_out(quartered, stride=2).edged) > slid
