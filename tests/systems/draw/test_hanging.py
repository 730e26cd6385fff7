"""Borders of the carpet's tiles that hang down to the ground (F4)."""

import numpy as np
import pytest

from tallgrass.systems.show.carpet.tiles import GRID, hanging_grid, tile_grid


@pytest.mark.parametrize("wider", [1, 2])
def test_triangles_of_a_border_look_out_of_the_tile_on_all_sides_as_those_of_the_sheet_look_up(wider: int) -> None:
    corners, quads = hanging_grid(wider)
    above = corners.clip(0.0, GRID)
    down = np.abs(corners - above).max(axis=1)
    places = np.stack([above[:, 0], -down, above[:, 1]], axis=1)
    triangles = places[quads.reshape(-1, 3)]
    sides = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    sheet = 2 * len(tile_grid(wider)[1])
    assert (sides[:sheet, 1] > 0.0).all()
    outwards = triangles[sheet:].mean(axis=1)[:, ::2] - GRID / 2.0
    seen_from = np.abs(outwards) > GRID / 2.0 - 1e-3
    assert (seen_from.sum(axis=1) == 1).all()
    assert ((sides[sheet:, ::2] * outwards)[seen_from] > 0.0).all()
