"""Tiling: patches come and go around the viewer (T1, D2)."""

from typing import Any

import esper
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.patch import Lod, Patch
from tallgrass.components.viewer import Viewer
from tallgrass.engine.declared.quality import Quality
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at, slope_at
from tallgrass.engine.world import World
from tallgrass.systems.around.clearing import Clearings
from tallgrass.systems.around.cone import discrete_distance, far_to_near, nearness
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.around.window import cell_of, window_cells, window_rows
from tallgrass.systems.entities import BATCH, PatchEntities
from tallgrass.systems.show.registry import NAMES
from tallgrass.systems.tile import Tile, cell_stood_in, cells_on, patch_models, tile

SIDE, PATCH = 9, 2.5
WIDE = Terrain(np.zeros((3, 3), np.float32), 5000.0)
SMALL = Terrain(np.zeros((21, 31), np.float32), 1.0)

centres = st.tuples(st.integers(-3000, 3000), st.integers(-3000, 3000)).map(lambda pair: np.array(pair, np.int32))
sides = st.integers(0, 20).map(lambda reach: 2 * reach + 1)


def table_of(side: int = SIDE) -> PatchTable:
    return PatchTable.allocate(side, NAMES)


def stood(table: PatchTable, centre: tuple[int, int], terrain: Terrain = WIDE) -> NDArray[np.int32]:
    return tile(table, np.array(centre, np.int32), terrain, patch=PATCH, seed=3, models=4)


class Tiled:
    """The patches around one viewer, and their entities."""

    def __init__(
        self, world: World, *, side: int = SIDE, terrain: Terrain = WIDE, clearings: Clearings | None = None
    ) -> None:
        self.world = world
        self.clearings = clearings or Clearings()
        self.outlook = Outlook(Viewer(), 0, table_of(side))
        self.entities = PatchEntities(world, self.clearings)
        self.system = Tile([self.outlook], self.entities, terrain, PATCH, 3, 4)

    @property
    def patches(self) -> PatchTable:
        return self.outlook.patches

    def at(self, i: int, j: int) -> None:
        """Let the viewer stand in this cell for one frame."""
        self.outlook.viewer.eye = ((i + 0.5) * PATCH, 1.7, (j + 0.5) * PATCH)
        self.system.run()

    def row(self, i: int, j: int) -> int:
        """The row of this cell."""
        row = int(window_rows(np.array([[i, j]], np.int32), side=self.patches.side)[0])
        assert self.patches.cell[row].tolist() == [i, j]
        return row

    def entity(self, i: int, j: int) -> int:
        return int(self.patches.entity[self.row(i, j)])

    def patch(self, i: int, j: int) -> Patch:
        return self.world.get(self.entity(i, j), Patch)

    def lod(self, i: int, j: int) -> Lod:
        return self.world.get(self.entity(i, j), Lod)

    def grows(self, i: int, j: int) -> bool:
        """Whether there is grass in this cell."""
        return bool(self.patches.stands[self.row(i, j)])


@pytest.fixture
def tiled(world: World) -> Tiled:
    """A viewer in the cell (0, 0) of wide ground, all of whose patches are entities."""
    made = Tiled(world)
    made.at(0, 0)
    return made


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


STEPS = [((0, 0), 0), ((1, 0), SIDE), ((0, -1), SIDE), ((1, 1), 2 * SIDE - 1), ((40, 0), SIDE * SIDE)]


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


@pytest.mark.parametrize(("step", "fresh"), STEPS)
def test_d2_patches_that_stay_keep_their_entities_and_those_that_come_have_new_ones(
    world: World, step: tuple[int, int], fresh: int
) -> None:
    tiled = Tiled(world)
    tiled.at(5, -7)
    cells, kept = tiled.patches.cell.copy(), tiled.patches.entity.copy()
    tiled.at(5 + step[0], -7 + step[1])
    changed = (tiled.patches.cell != cells).any(axis=1)
    assert changed.sum() == fresh
    np.testing.assert_array_equal(tiled.patches.entity[~changed], kept[~changed])
    assert not np.isin(tiled.patches.entity[changed], kept).any()
    assert not any(esper.entity_exists(entity) for entity in kept[changed].tolist())


def test_d2_every_patch_on_the_terrain_is_an_entity_and_no_other(world: World) -> None:
    tiled = Tiled(world, terrain=SMALL)
    table = tiled.patches
    for centre in ((0, 0), (3, 1), (-9, 2), (100, 100), (1, 0)):
        tiled.at(*centre)
        found = world.all(Patch)
        assert len(world) == len(found) == int(table.alive.sum())
        assert {patch.cell for _, patch in found} == {tuple(cell) for cell in table.cell[table.alive].tolist()}
        assert (table.entity[~table.alive] == 0).all()
        assert [entity for entity, _ in found] == sorted(table.entity[table.alive].tolist())
    assert 0 < table.alive.sum() < len(table.alive)


def test_t1_a_patch_is_on_the_terrain_where_its_middle_is() -> None:
    table = table_of()
    stood(table, (0, 0), SMALL)
    width, depth = SMALL.size
    middle = (table.cell + 0.5) * PATCH
    inside = (np.abs(middle[:, 0]) <= width / 2) & (np.abs(middle[:, 1]) <= depth / 2)
    np.testing.assert_array_equal(table.alive, inside)
    np.testing.assert_array_equal(cells_on(SMALL, table.cell, patch=PATCH), inside)


def test_t3_the_system_says_where_the_viewer_stands_and_how_far_each_patch_is(tiled: Tiled) -> None:
    for centre in ((0, 0), (2, -1), (-30, 7)):
        tiled.at(*centre)
        assert tuple(tiled.outlook.viewer.centre.tolist()) == centre
        expected = np.abs(tiled.patches.cell - centre).max(axis=1)
        np.testing.assert_array_equal(tiled.patches.distance, expected)


@given(st.lists(centres, min_size=1, max_size=3), st.sampled_from([3, 9, 41]))
def test_t5_wherever_the_window_goes_the_table_knows_the_order_from_far_to_near(
    way: list[NDArray[np.int32]], side: int
) -> None:
    table = table_of(side)
    for centre in way:
        tile(table, centre, WIDE, patch=PATCH, seed=3, models=4)
    rows = np.arange(0, side * side, 2)
    np.testing.assert_array_equal(table.distance, discrete_distance(table.cell, way[-1]))
    np.testing.assert_array_equal(table.far_to_near(rows), rows[far_to_near(table.cell[rows], way[-1])])


def test_t5_the_widest_window_there_is_has_room_for_its_order() -> None:
    table = table_of(2 * Quality.model_json_schema()["properties"]["carpet_to"]["maximum"] + 1)
    stood(table, (5, 7))
    np.testing.assert_array_equal(table.nearness, nearness(table.cell, np.array([5, 7], np.int32)))


def test_d2_what_is_written_to_the_table_shows_in_the_components(world: World) -> None:
    tiled = Tiled(world)
    tiled.at(2, 2)
    table, random = tiled.patches, np.random.default_rng(0)
    table.distance[:] = random.integers(0, 9, len(table.distance))
    for levels in (table.representation, table.previous, table.wanted, table.hold):
        levels[:] = random.integers(-1, 3, len(levels))
    table.progress[:] = random.random(len(table.progress))
    table.visible[:] = random.random(len(table.visible)) < 0.5
    named = (*NAMES, None)  # -1 is none
    for row, entity in enumerate(table.entity.tolist()):
        patch, lod = world.get(entity, Patch), world.get(entity, Lod)
        assert patch.cell == tuple(table.cell[row].tolist())
        assert (patch.model, patch.turn, patch.grows) == (table.model[row], table.turn[row], True)
        assert (lod.distance, lod.progress, lod.visible) == (
            table.distance[row],
            table.progress[row],
            table.visible[row],
        )
        assert (lod.representation, lod.previous) == (named[table.representation[row]], named[table.previous[row]])
        assert (lod.wanted, lod.hold) == (named[table.wanted[row]], named[table.hold[row]])
        assert lod.viewer == "main"


@pytest.mark.parametrize("field", ["wanted", "hold"])
def test_d2_what_a_game_writes_to_a_component_shows_in_the_table(tiled: Tiled, field: str) -> None:
    lod, levels = tiled.lod(1, 2), getattr(tiled.patches, field)
    for number, name in enumerate(NAMES):
        setattr(lod, field, name)
        assert levels[tiled.row(1, 2)] == number
        assert getattr(lod, field) == name
        assert (np.delete(levels, tiled.row(1, 2)) == -1).all()
    setattr(lod, field, None)
    assert (levels == -1).all()


@pytest.mark.parametrize("field", ["cell", "model", "turn", "size"])
def test_what_cannot_be_written_of_a_patch_says_so(tiled: Tiled, field: str) -> None:
    patch = tiled.patch(0, 0)
    before = getattr(patch, field, None)
    with pytest.raises(AttributeError, match=field):
        setattr(patch, field, before)
    assert getattr(patch, field, None) == before


@pytest.mark.parametrize(
    "field", ["viewer", "distance", "visible", "representation", "previous", "progress", "sublevel"]
)
def test_what_cannot_be_written_of_a_level_of_detail_says_so(tiled: Tiled, field: str) -> None:
    lod = tiled.lod(0, 0)
    before = getattr(lod, field, None)
    with pytest.raises(AttributeError, match=field):
        setattr(lod, field, before)
    assert getattr(lod, field, None) == before


@pytest.mark.parametrize("field", ["wanted", "hold"])
@pytest.mark.parametrize("name", ["grass", "Blades", "", 1])
def test_an_unknown_representation_is_refused_in_a_sentence(tiled: Tiled, field: str, name: Any) -> None:
    lod = tiled.lod(0, 0)
    setattr(lod, field, "strips")
    with pytest.raises(ValueError, match=rf"^unknown representation {name!r}; there are blades, strips, carpet$"):
        setattr(lod, field, name)
    assert getattr(lod, field) == "strips"


@pytest.mark.parametrize("field", ["wanted", "hold"])
def test_a_patch_that_the_viewer_has_left_behind_takes_nothing_any_more(tiled: Tiled, field: str) -> None:
    lod = tiled.lod(-4, 3)
    tiled.at(1, 0)
    with pytest.raises(RuntimeError, match=r"^the viewer 'main' has left the patch \(-4, 3\) behind$"):
        setattr(lod, field, "strips")
    with pytest.raises(RuntimeError, match="left the patch"):
        setattr(lod, field, None)
    assert (getattr(tiled.patches, field) == -1).all()


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


def test_d2_released_the_world_is_empty_again_and_the_games_own_entities_are_there(world: World) -> None:
    theirs = [esper.create_entity("a game's own") for _ in range(4)]
    tiled = Tiled(world)
    tiled.at(0, 0)
    tiled.at(3, 3)
    world.release()
    assert sorted(esper.get_entities()) == theirs


# ---- A few entities at a time --------------------------------------------------------------------


def test_d2_in_one_frame_at_most_a_batch_of_patches_become_entities_the_nearest_first(world: World) -> None:
    tiled = Tiled(world, side=33)
    patches, made = tiled.patches, []
    tiled.at(0, 0)
    while (patches.entity == 0).any():
        made.append(len(world))
        without = patches.distance[patches.entity == 0]
        assert patches.distance[patches.entity != 0].max() <= without.min()
        tiled.at(0, 0)
    assert made == [BATCH * (number + 1) for number in range(33 * 33 // BATCH)]
    assert len(world) == 33 * 33
    by_age = patches.distance[np.argsort(patches.entity)]
    assert (np.diff(by_age) >= 0).all()
    tiled.at(0, 0)
    assert len(world) == 33 * 33


def test_d2_who_leaps_before_all_are_entities_has_the_nearest_first_again(world: World) -> None:
    tiled = Tiled(world, side=33)
    tiled.at(0, 0)
    tiled.at(9, 0)
    patches = tiled.patches
    fresh = patches.entity > BATCH + 1
    assert len(world) <= 2 * BATCH
    assert patches.distance[fresh].max() <= patches.distance[patches.entity == 0].min()
    for _ in range(5):
        tiled.at(9, 0)
    assert len(world) == (patches.entity != 0).sum() == 33 * 33


def test_d2_a_patch_that_is_asked_for_is_an_entity_at_once(world: World) -> None:
    tiled = Tiled(world, side=33)
    tiled.at(0, 0)
    assert tiled.entity(16, -16) == 0
    asked = np.array([[16, -16], [0, 0], [16, -16], [17, 0]], np.int32)
    far, here, again, beyond = tiled.entities.at(tiled.outlook, asked).tolist()
    assert far == again == tiled.entity(16, -16)
    assert world.get(far, Patch).cell == (16, -16)
    assert here == tiled.entity(0, 0)
    assert beyond == 0
    for _ in range(6):
        tiled.at(0, 0)
    assert tiled.entity(16, -16) == far
    assert len(world) == 33 * 33


def test_d2_off_the_terrain_there_is_no_patch_to_ask_for(world: World) -> None:
    tiled = Tiled(world, terrain=SMALL)
    tiled.at(5, 0)
    cells = np.array([[5, 0], [7, 0]], np.int32)
    assert (tiled.entities.at(tiled.outlook, cells) != 0).tolist() == [True, False]


# ---- Clearing ------------------------------------------------------------------------------------


@pytest.mark.parametrize("at_once", [True, False])
def test_deleting_a_patchs_entity_clears_its_grass_and_a_new_entity_comes(tiled: Tiled, *, at_once: bool) -> None:
    gone, others = tiled.entity(1, -2), set(tiled.patches.entity.tolist())
    esper.delete_entity(gone, immediate=at_once)
    esper.process()
    tiled.at(0, 0)
    assert not tiled.grows(1, -2)
    assert tiled.entity(1, -2) not in {0, *others}
    assert not tiled.patch(1, -2).grows
    assert tiled.patches.alive.all()
    assert tiled.patches.stands.sum() == SIDE * SIDE - 1
    assert len(tiled.world) == SIDE * SIDE
    now = tiled.patches.entity.copy()
    tiled.at(0, 0)
    np.testing.assert_array_equal(tiled.patches.entity, now)


def test_many_patches_may_be_deleted_at_once(tiled: Tiled) -> None:
    rows = np.flatnonzero(tiled.patches.cell[:, 0] > 0)
    for entity in tiled.patches.entity[rows].tolist():
        esper.delete_entity(entity, immediate=True)
    tiled.at(0, 0)
    assert np.flatnonzero(~tiled.patches.stands).tolist() == rows.tolist()
    assert (tiled.patches.entity != 0).all()


def test_a_patch_that_grows_no_more_keeps_its_entity_and_has_its_grass_back_when_it_grows_again(tiled: Tiled) -> None:
    patch, entity = tiled.patch(2, 1), tiled.entity(2, 1)
    assert patch.grows
    for grows in (False, False, True, True, False, True):
        patch.grows = grows
        assert patch.grows is grows
        tiled.at(0, 0)
        assert tiled.grows(2, 1) is grows
        assert tiled.patches.grows.sum() == SIDE * SIDE - (not grows)
        assert tiled.entity(2, 1) == entity


def test_a_patch_that_was_deleted_may_grow_again(tiled: Tiled) -> None:
    esper.delete_entity(tiled.entity(0, 0), immediate=True)
    tiled.at(0, 0)
    tiled.patch(0, 0).grows = True
    tiled.at(0, 0)
    assert tiled.patches.stands.all()


def test_a_cleared_patch_is_still_bare_when_the_viewer_comes_back(tiled: Tiled) -> None:
    tiled.patch(0, 0).grows = False
    esper.delete_entity(tiled.entity(1, 0), immediate=True)
    tiled.at(0, 0)
    tiled.at(100, 100)
    assert tiled.patches.stands.all()
    tiled.at(1, 1)
    assert np.argwhere(~tiled.patches.stands).ravel().tolist() == sorted([tiled.row(0, 0), tiled.row(1, 0)])
    assert not tiled.patch(0, 0).grows


def test_what_leaves_the_window_is_cleared_of_nothing(tiled: Tiled) -> None:
    for step in range(1, 12):
        tiled.at(step, -step)
    tiled.at(0, 0)
    assert tiled.patches.stands.all()
    assert tiled.clearings.version == 0


def test_a_cleared_place_is_bare_for_every_viewer(world: World) -> None:
    clearings = Clearings()
    one, other = Tiled(world, clearings=clearings), Tiled(world, side=5, clearings=clearings)
    one.at(0, 0)
    other.at(1, 0)
    one.patch(1, 1).grows = False
    one.at(0, 0)
    other.at(1, 0)
    assert not one.grows(1, 1)
    assert not other.grows(1, 1)
    assert not other.patch(1, 1).grows


def test_d6_where_a_game_clears_its_world_all_patches_are_entities_again_and_none_is_bare(tiled: Tiled) -> None:
    esper.delete_entity(tiled.entity(1, 0), immediate=True)  # right before: it goes with the others
    esper.clear_database()
    theirs = [esper.create_entity("a game's own") for _ in range(7)]
    tiled.at(0, 0)
    assert len(tiled.world) == len(tiled.world.all(Patch)) == SIDE * SIDE
    assert tiled.patches.stands.all()
    assert not set(theirs) & set(tiled.patches.entity.tolist())
    assert all(esper.component_for_entity(entity, str) for entity in theirs)
    esper.delete_entity(tiled.entity(0, 1), immediate=True)
    tiled.at(0, 0)
    assert tiled.patches.stands.sum() == SIDE * SIDE - 1


def test_d6_what_was_bare_is_bare_in_a_world_that_was_cleared(tiled: Tiled) -> None:
    tiled.patch(0, 1).grows = False
    tiled.at(0, 0)
    esper.clear_database()
    tiled.at(0, 0)
    assert np.flatnonzero(~tiled.patches.stands).tolist() == [tiled.row(0, 1)]
    assert not tiled.patch(0, 1).grows


def test_d6_right_after_a_game_has_cleared_its_world_a_patch_that_is_asked_for_is_ours(tiled: Tiled) -> None:
    before = tiled.entity(0, 0)
    esper.clear_database()
    theirs = [esper.create_entity("a game's own") for _ in range(before)]
    assert before in theirs, "a cleared world counts from 1 again"
    (asked,) = tiled.entities.at(tiled.outlook, np.array([[0, 0]], np.int32)).tolist()
    assert tiled.world.get(asked, Patch).cell == (0, 0)
    tiled.at(0, 0)
    assert tiled.entity(0, 0) == asked
    assert len(tiled.world) == SIDE * SIDE


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
