"""Tiling: patches and their entities come and go around the viewer (T3, D2)."""

from typing import Any

import esper
import numpy as np
import pytest

from tallgrass.components.patch import Clearings, Lod, Patch
from tallgrass.components.viewer import Viewer
from tallgrass.engine.terrain.change import set_heights
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.world import World
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.entities import BATCH, PatchEntities
from tallgrass.systems.show.registry import NAMES
from tallgrass.systems.space.ground import Ground
from tallgrass.systems.space.window import window_rows
from tallgrass.systems.tile import Tile

SIDE, PATCH = 9, 2.5
WIDE = Terrain(np.zeros((3, 3), np.float32), 5000.0)
SMALL = Terrain(np.zeros((21, 31), np.float32), 1.0)
STEPS = [((0, 0), 0), ((1, 0), SIDE), ((0, -1), SIDE), ((1, 1), 2 * SIDE - 1), ((40, 0), SIDE * SIDE)]


class Tiled:
    """The patches around one viewer, and their entities."""

    def __init__(
        self, world: World, *, side: int = SIDE, terrain: Terrain = WIDE, clearings: Clearings | None = None
    ) -> None:
        self.world = world
        self.clearings = clearings or Clearings()
        self.outlook = Outlook(Viewer(), 0, PatchTable.allocate(side, NAMES))
        self.entities = PatchEntities(world, self.clearings)
        density = Density(np.ones((1, 2, 2), np.float32), terrain.size)
        self.system = Tile([self.outlook], self.entities, (), Ground(terrain, density, PATCH), 3, 4)

    @property
    def patches(self) -> PatchTable:
        return self.outlook.patches

    def at(self, i: int, j: int) -> None:
        """Put the viewer into a cell for one frame."""
        self.outlook.viewer.eye = ((i + 0.5) * PATCH, 1.7, (j + 0.5) * PATCH)
        self.system.run()

    def row(self, i: int, j: int) -> int:
        """Return the row of a cell."""
        row = int(window_rows(np.array([[i, j]], np.int32), side=self.patches.side)[0])
        assert self.patches.cell[row].tolist() == [i, j]
        return row

    def entity(self, i: int, j: int) -> int:
        return int(self.patches.entity[self.row(i, j)])

    def patch(self, i: int, j: int) -> Patch:
        return esper.component_for_entity(self.entity(i, j), Patch)

    def lod(self, i: int, j: int) -> Lod:
        return esper.component_for_entity(self.entity(i, j), Lod)

    def grows(self, i: int, j: int) -> bool:
        """Return whether there is grass in a cell."""
        return bool(self.patches.stands[self.row(i, j)])


@pytest.fixture
def tiled(world: World) -> Tiled:
    """Viewer in the cell (0, 0) of wide ground, with entities for all patches."""
    made = Tiled(world)
    made.at(0, 0)
    return made


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


def test_t3_the_system_says_where_the_viewer_stands_and_how_far_each_patch_is(tiled: Tiled) -> None:
    for centre in ((0, 0), (2, -1), (-30, 7)):
        tiled.at(*centre)
        assert tuple(tiled.outlook.viewer.centre.tolist()) == centre
        expected = np.abs(tiled.patches.cell - centre).max(axis=1)
        np.testing.assert_array_equal(tiled.patches.distance, expected)


def test_t3_distances_are_told_again_as_the_viewer_walks_and_rises_and_as_the_ground_does(world: World) -> None:
    terrain = Terrain(np.zeros((41, 41), np.float32), 1.0)
    tiled, high = Tiled(world, terrain=terrain), 6.0 * PATCH

    def away() -> list[int]:
        return [int(tiled.patches.away[tiled.row(i, 0)]) for i in (0, 2)]

    tiled.at(0, 0)
    assert away() == [0, 2]
    tiled.at(2, 0)
    assert away() == [2, 0]
    tiled.outlook.viewer.eye = (2.5 * PATCH, high, 0.5 * PATCH)
    tiled.system.run()
    assert min(away()) >= 3
    set_heights(terrain, terrain.origin, np.full((41, 41), high - 1.7))
    tiled.system.run()
    assert away() == [2, 0]


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
        patch, lod = esper.component_for_entity(entity, Patch), esper.component_for_entity(entity, Lod)
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


READ_ONLY = {
    "patch": ("cell", "model", "turn", "size"),
    "lod": ("viewer", "distance", "visible", "representation", "previous", "progress", "sublevel"),
}


@pytest.mark.parametrize(("of", "field"), [(of, field) for of, fields in READ_ONLY.items() for field in fields])
def test_what_cannot_be_written_of_a_patch_and_its_level_of_detail_says_so(tiled: Tiled, of: str, field: str) -> None:
    component = getattr(tiled, of)(0, 0)
    before = getattr(component, field, None)
    with pytest.raises(AttributeError, match=field):
        setattr(component, field, before)
    assert getattr(component, field, None) == before


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


def test_d2_released_the_world_is_empty_again_and_the_games_own_entities_are_there(world: World) -> None:
    theirs = [esper.create_entity("a game's own") for _ in range(4)]
    tiled = Tiled(world)
    tiled.at(0, 0)
    tiled.at(3, 3)
    world.release()
    assert sorted(esper.get_entities()) == theirs


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


def test_d2_after_a_leap_entities_go_a_batch_at_a_time_and_are_nowhere_to_be_seen_meanwhile(world: World) -> None:
    tiled = Tiled(world, side=33)
    for _ in range(6):
        tiled.at(0, 0)
    patches = tiled.patches
    patches.visible[:], patches.representation[:] = True, 2
    before = {entity: esper.component_for_entity(entity, Lod) for entity in patches.entity.tolist()}
    assert all(lod.visible and lod.distance <= 16 for lod in before.values())
    tiled.at(500, 0)
    patches.visible[:], patches.representation[:] = True, 2
    there = [lod for entity, lod in before.items() if esper.entity_exists(entity)]
    assert len(there) == len(before) - BATCH
    assert not any(lod.visible or lod.representation or lod.wanted for lod in there)
    assert min(lod.distance for lod in there) > 16
    for _ in range(6):
        tiled.at(500, 0)
    assert not any(map(esper.entity_exists, before))
    assert len(world) == (patches.entity != 0).sum() == 33 * 33


def test_d2_after_a_leap_what_is_still_to_go_is_forgotten_with_a_world_that_was_cleared(world: World) -> None:
    tiled = Tiled(world, side=33)
    for _ in range(6):
        tiled.at(0, 0)
    tiled.at(500, 0)
    esper.clear_database()
    for _ in range(6):
        tiled.at(500, 0)
    assert len(world) == (tiled.patches.entity != 0).sum() == 33 * 33


def test_d2_a_patch_that_is_asked_for_is_an_entity_at_once(world: World) -> None:
    tiled = Tiled(world, side=33)
    tiled.at(0, 0)
    assert tiled.entity(16, -16) == 0
    asked = np.array([[16, -16], [0, 0], [16, -16], [17, 0]], np.int32)
    far, here, again, beyond = tiled.entities.at(tiled.outlook, asked).tolist()
    assert far == again == tiled.entity(16, -16)
    assert esper.component_for_entity(far, Patch).cell == (16, -16)
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


@pytest.mark.parametrize("at_once", [True, False])
def test_deleting_a_patchs_entity_clears_its_grass_until_its_new_entity_grows(tiled: Tiled, *, at_once: bool) -> None:
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
    tiled.patch(1, -2).grows = True
    tiled.at(0, 0)
    assert tiled.patches.stands.all()


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
    assert [one.grows(1, 1), other.grows(1, 1), other.patch(1, 1).grows] == [False] * 3


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
    assert esper.component_for_entity(asked, Patch).cell == (0, 0)
    tiled.at(0, 0)
    assert tiled.entity(0, 0) == asked
    assert len(tiled.world) == SIDE * SIDE
