"""Skirts of the carpet's pieces down to the ground, and orders of its tiles' triangles (F4)."""

import numpy as np
import pytest

from tallgrass.systems.show.carpet.tiles import ORDERS, PIECE, in_orders, order_toward, skirted_grid, tile_grid


@pytest.mark.parametrize("stride", [1, 2])
def test_triangles_of_a_border_look_out_of_the_piece_on_all_sides_as_those_of_the_sheet_look_up(stride: int) -> None:
    corners, quads = skirted_grid(stride, quads=PIECE)
    above = corners.clip(0.0, PIECE)
    down = np.abs(corners - above).max(axis=1)
    places = np.stack([above[:, 0], -down, above[:, 1]], axis=1)
    triangles = places[quads.reshape(-1, 3)]
    sides = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    sheet = 2 * len(tile_grid(stride, quads=PIECE)[1])
    assert (sides[:sheet, 1] > 0.0).all()
    outwards = triangles[sheet:].mean(axis=1)[:, ::2] - PIECE / 2.0
    seen_from = np.abs(outwards) > PIECE / 2.0 - 1e-3
    assert (seen_from.sum(axis=1) == 1).all()
    assert ((sides[sheet:, ::2] * outwards)[seen_from] > 0.0).all()


@pytest.mark.parametrize("degrees", range(10, 360, 20))
def test_of_a_tile_what_is_farther_off_is_drawn_before_what_is_nearer(degrees: int) -> None:
    corners, quads = tile_grid()
    order = in_orders(corners, quads).reshape(ORDERS, *quads.shape)[order_toward(np.radians(degrees))]
    heading = np.array([np.sin(np.radians(degrees)), -np.cos(np.radians(degrees))])
    main = int(np.abs(heading).argmax())
    middle = corners[order].mean(axis=1)
    far = middle * np.sign(heading)
    assert (np.diff(far[:, main]) <= 0.0).all()
    same = np.diff(far[:, main]) == 0.0
    assert (np.diff(far[:, 1 - main])[same] < 0.0).all()
    assert sorted(map(tuple, order)) == sorted(map(tuple, quads))
