"""Tiling: patches come and go around the viewer (T1, D2)."""

import esper
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.patch import Lod, Patch
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at, slope_at
from tallgrass.engine.world import World
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.around.window import cell_of, window_cells, window_rows
from tallgrass.systems.tile import cells_on, patch_models, tile

SIDE, PATCH = 9, 2.5
WIDE = Terrain(np.zeros((3, 3), np.float32), 5000.0)
SMALL = Terrain(np.zeros((21, 31), np.float32), 1.0)

centres = st.tuples(st.integers(-3000, 3000), st.integers(-3000, 3000)).map(lambda pair: np.array(pair, np.int32))
sides = st.integers(0, 20).map(lambda reach: 2 * reach + 1)


def stood(table: PatchTable, world: World, centre: tuple[int, int], terrain: Terrain = WIDE) -> NDArray[np.int32]:
    return tile(table, np.array(centre, np.int32), terrain, world, patch=PATCH, seed=3, models=4)


@given(st.floats(-5000, 5000, width=32), st.floats(-5000, 5000, width=32))
def test_t1_a_place_lies_in_its_cell(x: float, z: float) -> None:
    place = np.array([x, z], np.float32)
    cell = cell_of(place, patch=PATCH)
    assert (cell * PATCH <= place).all()
    assert (place < (cell + 1.0) * PATCH).all()


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


@pytest.mark.parametrize(
    ("step", "fresh"), [((0, 0), 0), ((1, 0), SIDE), ((0, -1), SIDE), ((1, 1), 2 * SIDE - 1), ((40, 0), SIDE * SIDE)]
)
def test_t1_a_step_replaces_the_lines_of_patches_that_it_leaves(
    world: World, step: tuple[int, int], fresh: int
) -> None:
    table = PatchTable.allocate(SIDE)
    assert len(stood(table, world, (5, -7))) == SIDE * SIDE
    kept = table.entity.copy()
    changed = stood(table, world, (5 + step[0], -7 + step[1]))
    assert len(changed) == fresh
    stays = np.setdiff1d(np.arange(SIDE * SIDE), changed)
    np.testing.assert_array_equal(table.entity[stays], kept[stays])
    assert not np.isin(table.entity[changed], kept).any()


def test_d2_every_patch_on_the_terrain_is_an_entity_and_no_other(world: World) -> None:
    table = PatchTable.allocate(SIDE)
    for centre in ((0, 0), (3, 1), (-9, 2), (100, 100), (1, 0)):
        stood(table, world, centre, SMALL)
        found = world.all(Patch)
        assert len(world) == len(found) == int(table.alive.sum())
        assert {tuple(patch.cell) for _, patch in found} == {tuple(cell) for cell in table.cell[table.alive]}
        assert (table.entity[~table.alive] == 0).all()
        assert [entity for entity, _ in found] == sorted(table.entity[table.alive].tolist())
    assert 0 < table.alive.sum() < len(table.alive)


def test_t1_a_patch_is_on_the_terrain_where_its_middle_is(world: World) -> None:
    table = PatchTable.allocate(SIDE)
    stood(table, world, (0, 0), SMALL)
    width, depth = SMALL.size
    middle = (table.cell + 0.5) * PATCH
    inside = (np.abs(middle[:, 0]) <= width / 2) & (np.abs(middle[:, 1]) <= depth / 2)
    np.testing.assert_array_equal(table.alive, inside)
    np.testing.assert_array_equal(cells_on(SMALL, table.cell, patch=PATCH), inside)


def test_d2_what_is_written_to_the_table_shows_in_the_components(world: World) -> None:
    table = PatchTable.allocate(SIDE)
    stood(table, world, (2, 2))
    random = np.random.default_rng(0)
    table.distance[:] = random.integers(0, 9, len(table.distance))
    table.representation[:], table.previous[:] = 1, 2
    table.progress[:] = random.random(len(table.progress))
    table.visible[:] = random.random(len(table.visible)) < 0.5
    for row, entity in enumerate(table.entity.tolist()):
        patch, lod = world.get(entity, Patch), world.get(entity, Lod)
        assert (patch.cell == table.cell[row]).all()
        assert (patch.model[0], patch.turn[0]) == (table.model[row], table.turn[row])
        assert (lod.distance[0], lod.progress[0], lod.visible[0]) == (
            table.distance[row],
            table.progress[row],
            table.visible[row],
        )
        assert (lod.representation[0], lod.previous[0]) == (1, 2)


def test_d2_what_a_game_writes_to_a_component_shows_in_the_table(world: World) -> None:
    table = PatchTable.allocate(SIDE)
    stood(table, world, (2, 2))
    world.get(int(table.entity[7]), Lod).progress[:] = 0.25
    assert table.progress[7] == 0.25
    assert (np.delete(table.progress, 7) == 1.0).all()


def test_t1_a_patch_knows_the_ground_in_its_middle(world: World, hills: Terrain) -> None:
    table = PatchTable.allocate(SIDE)
    stood(table, world, (3, -2), hills)
    middle = ((table.cell + 0.5) * PATCH).astype(np.float32)
    np.testing.assert_array_equal(table.height, height_at(hills, middle))
    np.testing.assert_array_equal(table.slope, slope_at(hills, middle))


def test_a_fresh_patch_has_no_representation_yet_and_was_not_seen(world: World) -> None:
    table = PatchTable.allocate(SIDE)
    stood(table, world, (0, 0))
    table.representation[:], table.previous[:], table.visible[:], table.progress[:] = 1, 0, True, 0.5
    changed = stood(table, world, (1, 0))
    assert (table.representation[changed] == -1).all()
    assert (table.previous[changed] == -1).all()
    assert not table.visible[changed].any()
    assert (table.progress[changed] == 1.0).all()
    stays = np.setdiff1d(np.arange(SIDE * SIDE), changed)
    assert (table.representation[stays] == 1).all()


def test_g1_a_cell_has_the_same_grass_whenever_it_is_visited(world: World) -> None:
    table, other = PatchTable.allocate(SIDE), PatchTable.allocate(25)
    seen: dict[tuple[int, int], tuple[int, int]] = {}
    for centre in ((0, 0), (6, 2), (30, -30), (3, 1)):
        stood(table, world, centre)
        for cell, model, turn in zip(table.cell.tolist(), table.model, table.turn, strict=True):
            assert seen.setdefault(tuple(cell), (model, turn)) == (model, turn)
    stood(other, world, (2, 3))
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


def test_d2_released_the_world_is_empty_again_and_the_games_own_entities_are_there(world: World) -> None:
    theirs = [esper.create_entity("a game's own") for _ in range(4)]
    table = PatchTable.allocate(SIDE)
    stood(table, world, (0, 0))
    stood(table, world, (3, 3))
    world.release()
    assert sorted(esper.get_entities()) == theirs
