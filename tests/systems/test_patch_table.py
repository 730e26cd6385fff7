"""The patch table around a viewer: its window, and the values of each cell (T1, T5, G1)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.declared.quality import Quality
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at, slope_at
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.show.registry import NAMES
from tallgrass.systems.space.cone import discrete_distance, nearness
from tallgrass.systems.space.window import cell_of, window_cells, window_rows
from tallgrass.systems.tile import cell_stood_in, cells_on, patch_models, tile

SIDE, PATCH = 9, 2.5
WIDE = Terrain(np.zeros((3, 3), np.float32), 5000.0)
SMALL = Terrain(np.zeros((21, 31), np.float32), 1.0)
STEPS = [((0, 0), 0), ((1, 0), SIDE), ((0, -1), SIDE), ((1, 1), 2 * SIDE - 1), ((40, 0), SIDE * SIDE)]

centres = st.tuples(st.integers(-3000, 3000), st.integers(-3000, 3000)).map(lambda pair: np.array(pair, np.int32))
sides = st.integers(0, 20).map(lambda reach: 2 * reach + 1)


def table_of(side: int = SIDE) -> PatchTable:
    return PatchTable.allocate(side, NAMES)


def stood(table: PatchTable, centre: tuple[int, int], terrain: Terrain = WIDE) -> NDArray[np.int32]:
    return tile(table, np.array(centre, np.int32), terrain, patch=PATCH, seed=3, models=4)


@given(st.floats(-5000, 5000, width=32), st.floats(-5000, 5000, width=32))
def test_t1_a_place_lies_in_its_cell(x: float, z: float) -> None:
    place = np.array([x, z], np.float32)
    cell = cell_of(place, patch=PATCH)
    assert (cell * PATCH <= place).all()
    assert (place < (cell + 1.0) * PATCH).all()


@given(st.floats(-9e-5, 9e-5), st.floats(-9e-5, 9e-5), st.integers(-50, 50), st.integers(-50, 50))
def test_who_stands_on_the_edge_of_a_cell_does_not_move_to_and_fro(dx: float, dz: float, i: int, j: int) -> None:
    for before in ((i, j), (i - 1, j), (i, j - 1), (i - 1, j - 1)):
        eye = ((i + dx) * 2.5, 1.7, (j + dz) * 2.5)
        assert tuple(cell_stood_in(eye, np.array(before, np.int32), patch=2.5)) == before


@given(st.floats(0.001, 0.999), st.floats(0.001, 0.999), st.integers(-50, 50), st.integers(-50, 50))
def test_inside_a_cell_a_viewer_stands_in_it_wherever_it_was_before(x: float, z: float, i: int, j: int) -> None:
    for before in ((i, j), (i - 1, j), (i + 1, j + 1), (0, 0)):
        eye = ((i + x) * 2.5, 1.7, (j + z) * 2.5)
        assert tuple(cell_stood_in(eye, np.array(before, np.int32), patch=2.5)) == (i, j)


@given(centres, sides)
def test_t1_the_window_is_the_square_around_the_viewer_with_each_cell_at_its_own_row(
    centre: NDArray[np.int32], side: int
) -> None:
    cells = window_cells(centre, side=side)
    assert (np.abs(cells - centre) <= side // 2).all()
    assert len({tuple(cell) for cell in cells.tolist()}) == side * side
    np.testing.assert_array_equal(window_rows(cells, side=side), np.arange(side * side))


@given(centres, sides, st.tuples(st.integers(-3, 3), st.integers(-3, 3)))
def test_t1_a_cell_that_stays_in_the_window_keeps_its_row(
    centre: NDArray[np.int32], side: int, step: tuple[int, int]
) -> None:
    before, after = window_cells(centre, side=side), window_cells(centre + np.array(step, np.int32), side=side)
    stays = (np.abs(before - centre - step) <= side // 2).all(axis=1)
    np.testing.assert_array_equal(before[stays], after[stays])


@pytest.mark.parametrize(("step", "fresh"), STEPS)
def test_t1_a_step_replaces_the_lines_of_patches_that_it_leaves(step: tuple[int, int], fresh: int) -> None:
    table = table_of()
    assert len(stood(table, (5, -7))) == SIDE * SIDE
    before = table.cell.copy()
    changed = stood(table, (5 + step[0], -7 + step[1]))
    assert len(changed) == fresh
    stays = np.setdiff1d(np.arange(SIDE * SIDE), changed)
    np.testing.assert_array_equal(table.cell[stays], before[stays])
    assert (table.cell[changed] != before[changed]).any(axis=1).all()


def test_t1_a_patch_is_on_the_terrain_where_its_middle_is() -> None:
    table = table_of()
    stood(table, (0, 0), SMALL)
    width, depth = SMALL.size
    middle = (table.cell + 0.5) * PATCH
    inside = (np.abs(middle[:, 0]) <= width / 2) & (np.abs(middle[:, 1]) <= depth / 2)
    np.testing.assert_array_equal(table.alive, inside)
    np.testing.assert_array_equal(cells_on(SMALL, table.cell, patch=PATCH), inside)


@given(st.lists(centres, min_size=1, max_size=3), st.sampled_from([3, 9, 41]))
def test_t5_wherever_the_window_goes_the_table_knows_the_order_from_far_to_near(
    way: list[NDArray[np.int32]], side: int
) -> None:
    table = table_of(side)
    for centre in way:
        tile(table, centre, WIDE, patch=PATCH, seed=3, models=4)
    rows = np.arange(0, side * side, 2)
    np.testing.assert_array_equal(table.distance, discrete_distance(table.cell, way[-1]))
    due = np.argsort(nearness(table.cell[rows], way[-1]), kind="stable")
    np.testing.assert_array_equal(table.far_to_near(rows), rows[due])


def test_t5_the_widest_window_there_is_has_room_for_its_order() -> None:
    table = table_of(2 * Quality.model_json_schema()["properties"]["carpet_to"]["maximum"] + 1)
    stood(table, (5, 7))
    np.testing.assert_array_equal(table.nearness, nearness(table.cell, np.array([5, 7], np.int32)))


def test_t1_a_patch_knows_its_middle_and_the_ground_there(hills: Terrain) -> None:
    table = table_of()
    stood(table, (3, -2), hills)
    middle = ((table.cell + 0.5) * PATCH).astype(np.float32)
    np.testing.assert_array_equal(table.middle.astype(np.float32), middle)
    np.testing.assert_array_equal(table.height, height_at(hills, middle))
    np.testing.assert_array_equal(table.slope, slope_at(hills, middle))


def test_a_fresh_patch_has_no_representation_yet_and_was_not_seen() -> None:
    table = table_of()
    stood(table, (0, 0))
    levels = (table.representation, table.previous, table.wanted, table.hold)
    for each in (*levels, table.sublevel, table.sublevel_before):
        each[:] = 1
    table.visible[:], table.was_visible[:], table.progress[:], table.sublevel_progress[:] = True, True, 0.5, 0.5
    changed = stood(table, (1, 0))
    for each in (*levels, table.sublevel.T, table.sublevel_before.T):
        assert (each[changed] == -1).all()
    assert not (table.visible | table.was_visible)[changed].any()
    assert (table.progress[changed] == 1.0).all()
    assert (table.sublevel_progress[:, changed] == 1.0).all()
    stays = np.setdiff1d(np.arange(SIDE * SIDE), changed)
    for each in (*levels, table.sublevel.T, table.sublevel_before.T):
        assert (each[stays] == 1).all()
    assert (table.sublevel_progress[:, stays] == 0.5).all()


def test_g1_a_cell_has_the_same_grass_whenever_it_is_visited() -> None:
    table, other = table_of(), table_of(25)
    seen: dict[tuple[int, int], tuple[int, int]] = {}
    for centre in ((0, 0), (6, 2), (30, -30), (3, 1)):
        stood(table, centre)
        for cell, model, turn in zip(table.cell.tolist(), table.model, table.turn, strict=True):
            assert seen.setdefault(tuple(cell), (model, turn)) == (model, turn)
    stood(other, (2, 3))
    again = {tuple(c): (m, t) for c, m, t in zip(other.cell.tolist(), other.model, other.turn, strict=True)}
    assert all(seen[cell] == again[cell] for cell in seen.keys() & again.keys())
    assert len(seen.keys() & again.keys()) > 80


def test_g1_models_and_turns_are_spread_evenly_and_without_a_pattern() -> None:
    cells = np.stack(np.meshgrid(np.arange(100), np.arange(100)), -1).reshape(-1, 2).astype(np.int32)
    model, turn = patch_models(cells, seed=3, models=4)
    counts = np.bincount(model * 4 + turn, minlength=16)
    assert (np.abs(counts - 625) < 5 * np.sqrt(625)).all()
    grid = (model * 4 + turn).reshape(100, 100)
    for shifted in (np.roll(grid, 1, 0), np.roll(grid, 1, 1), np.roll(grid, (1, 1), (0, 1)), grid.T):
        assert abs(float((grid == shifted).mean()) - 1 / 16) < 0.02
    other, _ = patch_models(cells, seed=4, models=4)
    assert abs(float((model == other).mean()) - 1 / 4) < 0.03
