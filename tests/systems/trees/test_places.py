"""Where trees stand, and that they are entities (F3, S2)."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import esper
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Breeze, Pose, Prairie, Tree, WindSource
from tallgrass.engine.declared.tree import TreeKind
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.systems.features import feature_of
from tallgrass.systems.trees.feature import Trees
from tallgrass.systems.trees.forest import HEIGHT_GROWTH, SEEDLING, Forest, grown_to
from tallgrass.systems.trees.place import placed
from tallgrass.testing import LITTLE, little_prairie, private_world

FLAT = Terrain(np.zeros((201, 201), np.float32), 1.0)
NOBODY = np.zeros((0, 2), np.float32)
WOOD = LITTLE + "trees: { oak: { habit: oak, positions: [[0, 0], [9, 0], [0, 12]] } }\n"


@pytest.fixture(autouse=True)
def _world() -> Iterator[None]:
    with private_world():
        yield


def nearest(place: NDArray[np.float32]) -> float:
    apart = np.hypot(*(place[:, None] - place[None]).transpose(2, 0, 1))
    np.fill_diagonal(apart, np.inf)
    return float(apart.min())


def kind(**keys: object) -> TreeKind:
    return TreeKind.model_validate({"habit": "birch", **keys})


def grown(terrain: Terrain = FLAT, /, **kinds: TreeKind) -> Any:
    """A ground with trees, as a prairie has it."""
    density = Density(np.array([[[0.0, 1.0], [0.0, 1.0]]], np.float32), terrain.whole, terrain)
    ground = SimpleNamespace(terrain=terrain, density=density)
    return SimpleNamespace(scene=SimpleNamespace(trees=kinds, grass={"turf": None}, seed=1), ground=ground)


def sown(terrain: Terrain = FLAT, fixed: NDArray[np.float32] = NOBODY, **keys: object) -> NDArray[np.float32]:
    rows = Forest(grown(terrain, birch=kind(**keys)), [fixed]).all()
    return np.ascontiguousarray(rows["root"][:, ::2])


@pytest.mark.parametrize(("density", "spacing"), [(60.0, 5.0), (12.0, 16.0), (120.0, 3.0)])
def test_density_brings_about_as_many_as_it_says_and_none_too_near_to_another(density: float, spacing: float) -> None:
    place = sown(density=density, spacing=spacing)
    assert len(place) == pytest.approx(4.0 * density, rel=0.25)
    assert nearest(place) >= spacing
    assert np.array_equal(place, sown(density=density, spacing=spacing))


def test_groves_leave_open_ground_between_them() -> None:
    def empty(groves: float) -> int:
        place = sown(density=100.0, groves=groves, spacing=2.0)
        cells = ((place + 100.0) / 20.0).astype(int)
        return 100 - len({*map(tuple, cells.tolist())})

    assert empty(1.0) > empty(0.0) + 15


def test_a_row_has_trees_from_end_to_end_so_far_apart() -> None:
    place = placed(kind(rows=[[[-40.0, 0.0], [40.0, 0.0]]], spacing=8.0), FLAT, NOBODY, seed=1)
    assert place.tolist() == [[x, 0.0] for x in np.linspace(-40.0, 40.0, 11)]


def test_an_uneven_row_has_gaps_and_no_rhythm_and_stays_on_its_line() -> None:
    row = {"rows": [[[-90.0, 0.0], [90.0, 0.0]]], "spacing": 1.0}
    place = placed(kind(**row, uneven=1.0), FLAT, NOBODY, seed=1)
    assert 0.7 * 181 < len(place) < 0.95 * 181
    assert np.abs(place[:, 1]).max() < 0.5
    apart = np.diff(np.sort(place[:, 0]))
    assert apart.max() > 1.8
    assert apart.std() > 0.25
    assert not np.array_equal(place, placed(kind(**row, uneven=1.0), FLAT, NOBODY, seed=2))


def test_trees_of_density_are_of_all_ages_and_few_of_rows_and_places() -> None:
    high: Any = kind(density=100.0, spacing=2.0, height=[10.0, 12.0], young=0.5)
    rows = Forest(grown(birch=high), [NOBODY]).all()["height"]
    assert (rows < 10.0).mean() == pytest.approx(0.5, abs=0.1)
    assert rows.min() < 2.5
    assert rows.max() > 11.5
    even = Forest(grown(birch=high.model_copy(update={"young": 0.0})), [NOBODY]).all()["height"]
    assert even.min() >= 10.0


def test_trunks_of_young_trees_are_the_more_the_thinner() -> None:
    high = grown_to(1.0, np.linspace(0.0, 1.0, 1000, endpoint=False))
    thick = (
        -np.log1p(-(high - SEEDLING) / (1.0 - SEEDLING) * -np.expm1(-HEIGHT_GROWTH)) / HEIGHT_GROWTH
    )  # of a grown one's
    counts = np.histogram(thick, 5, (0.0, 1.0))[0]
    assert counts[:-1] / counts[1:] == pytest.approx(1.35, rel=0.03)
    assert (grown_to(0.0, np.array([0.0, 0.5])) == 1.0).all()


def test_nothing_stands_off_the_terrain_in_another_tree_on_cliffs_or_where_its_grass_does_not_grow() -> None:
    outside = kind(positions=[[0.0, 0.0], [0.1, 0.0], [300.0, 0.0]])
    assert placed(outside, FLAT, NOBODY, seed=1).tolist() == [[0.0, 0.0]]
    assert abs(sown(density=60.0, spacing=4.0)).max() <= 100.0
    assert 0.0 > sown(density=60.0, spacing=4.0, among="turf")[:, 0].min() > -60.0  # its map begins half-way
    steep = Terrain(np.tile(np.maximum(np.arange(201) - 100.0, 0.0), (201, 1)).astype(np.float32), 1.0)
    assert sown(steep, density=60.0, spacing=4.0)[:, 0].max() < 1.0
    taken = np.array([[20.0, 20.0]], np.float32)
    assert np.hypot(*(sown(fixed=taken, density=60.0, spacing=4.0) - taken).T).min() >= 4.0
    both = Forest(
        grown(birch=kind(density=60.0, spacing=4.0), oak=kind(density=60.0, spacing=9.0)), [NOBODY, NOBODY]
    ).all()
    birch, oak = (np.ascontiguousarray(both["root"][both["kind"] == number][:, ::2]) for number in (0, 1))
    assert np.hypot(*(birch[:, None] - oak[None]).transpose(2, 0, 1)).min() >= 4.5


def test_squares_have_the_same_trees_whichever_are_asked_for_and_when() -> None:
    kinds = {"birch": kind(density=60.0, spacing=4.0, groves=0.5), "oak": kind(density=9.0, spacing=12.0)}
    whole = Forest(grown(**kinds), [NOBODY, NOBODY]).all()
    alone = Forest(grown(**kinds), [NOBODY, NOBODY])
    for square in ((0, 0), (-2, 1), (1, -1)):
        rows = alone.on([square])[square]
        own = (np.floor(whole["root"][:, ::2] / 64.0) == square).all(axis=1)
        assert len(rows) > 5
        # those whose cell of the lattice reaches over an edge belong to the square of its middle
        assert len(np.setdiff1d(rows, whole)) == 0
        assert len(np.setdiff1d(whole[own], rows)) < 0.3 * len(rows)


LARGE = LITTLE.replace("size: [60, 60]", "size: [6000, 6000]") + (
    "trees: { birch: { habit: birch, density: 30 }, oak: { habit: oak, positions: [[0, 0]] } }\n"
)


def test_where_a_state_changes_no_tree_all_stand_as_before() -> None:
    with little_prairie(scene=WOOD) as prairie:
        trees = feature_of(Trees, prairie.features)
        trees.step("main", (0.0, 2.0, 0.0), time=0.0)
        before = trees.standing.rows
        prairie.restore(prairie.state())
        trees.step("main", (0.0, 2.0, 0.0), time=0.0)
        assert len(before) > 0
        np.testing.assert_array_equal(trees.standing.rows, before)


def test_of_a_large_forest_trees_near_viewers_are_entities_and_those_farther_off_are_fewer_by_rings() -> None:
    with little_prairie(scene=LARGE) as prairie:
        trees = feature_of(Trees, prairie.features)
        trees.step("main", (0.0, 2.0, 0.0), time=0.0)
        near = {(pose.x, pose.z) for _, (_, pose) in esper.get_components(Tree, Pose)}
        assert 200 < len(near) < 800
        assert max(np.hypot(*place) for place in near) < 400.0
        rows = trees.standing.rows
        assert len(np.unique(rows[["root"]])) == len(rows)
        off = np.hypot(rows["root"][:, 0], rows["root"][:, 2])
        every = (off < 500.0) & (rows["ring"] < 2)
        assert every.sum() == pytest.approx(30.0 * np.pi * 25.0, rel=0.1)
        counts = np.bincount(rows["ring"])
        assert len(rows) < 12_000  # of 108,000
        assert (counts[2:] < 1.5 * counts[2]).all()
        trees.step("main", (900.0, 2.0, 0.0), time=0.0)
        moved = {(pose.x, pose.z) for _, (_, pose) in esper.get_components(Tree, Pose)}
        assert moved & near == {(0.0, 0.0)}
        assert trees.shading is trees.standing, "none was felled"
        trees.step("main", (0.0, 2.0, 0.0), time=0.0)
        assert {(pose.x, pose.z) for _, (_, pose) in esper.get_components(Tree, Pose)} == near


def test_what_another_thread_has_grown_about_an_eye_is_there_when_a_frame_asks_for_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    forest, eye = Forest(grown(birch=kind(density=30.0)), [NOBODY]), (10.0, 2.0, -20.0)
    due = len(forest.around(eye, []))
    again = Forest(grown(birch=kind(density=30.0)), [NOBODY])
    again.grow_about(eye)
    monkeypatch.setattr(again, "_trees_on", None)
    assert len(again.around(eye, [])) == due > 0


def test_what_is_felled_and_changed_of_a_large_forest_stays_so_and_states_know_it() -> None:
    with little_prairie(scene=LARGE) as prairie:
        trees = feature_of(Trees, prairie.features)

        def look(x: float) -> int:
            trees.step("main", (x, 2.0, 0.0), time=0.0)
            return len(esper.get_component(Tree))

        there = look(0.0)
        whole = prairie.state()
        first, second, *_ = (entity for entity, tree in esper.get_component(Tree) if tree.kind == "birch")
        felled, grown_up = esper.component_for_entity(first, Pose), esper.component_for_entity(second, Pose)
        esper.delete_entity(first, immediate=True)
        esper.add_component(second, Tree("birch", 2.0))
        assert look(0.0) == there - 1
        look(2000.0)  # the one that a game has changed stays its own
        assert esper.component_for_entity(second, Tree).height == 2.0
        changed = prairie.state()
        assert look(0.0) == there - 1
        prairie.restore(whole)
        assert look(0.0) == there
        prairie.restore(changed)
        assert look(0.0) == there - 1
        poses = {(pose.x, pose.z): tree.height for _, (tree, pose) in esper.get_components(Tree, Pose)}
        assert (felled.x, felled.z) not in poses
        assert poses[grown_up.x, grown_up.z] == 2.0


def test_a_restore_takes_trees_planted_since_and_what_it_makes_is_the_games_own() -> None:
    with little_prairie(scene=LITTLE + "trees: { oak: { habit: oak } }\n") as prairie:
        old = esper.create_entity(Tree("oak", 9.0), Pose(5.0, 5.0))
        blown = esper.create_entity(WindSource(Breeze(strength=0.5), "mine"))
        state = prairie.state()
        named, other = esper.create_entity(Tree("oak", 4.0), Pose(1.0, 5.0), "an oak"), esper.create_entity("a man")
        esper.create_entity(Tree("oak", 3.0), Pose(2.0, 5.0))
        elm = esper.create_entity(Tree("elm", 3.0), Pose(9.0, 5.0))  # of another prairie
        for entity in (old, blown):
            esper.delete_entity(entity, immediate=True)
        became = prairie.restore(state)
        assert prairie.restore(state) == became
        assert {entity for entity, _ in esper.get_component(Tree)} == {became[old], elm}
        assert esper.components_for_entity(named) == (Pose(1.0, 5.0), "an oak")
    assert {*esper.get_entities()} == {*became.values(), named, other, elm}


def standing(prairie: Prairie) -> list[list[float]]:
    trees = feature_of(Trees, prairie.features)
    trees.step("main", (0.0, 0.0, 0.0), time=0.0)
    return sorted(np.round(trees.standing.rows["root"][:, ::2], 3).tolist())


def test_trees_are_entities_that_a_game_reads_fells_moves_and_plants() -> None:
    with little_prairie(scene=WOOD) as prairie:
        found = {(pose.x, pose.z): entity for entity, (_, pose) in esper.get_components(Tree, Pose)}
        assert standing(prairie) == [[0.0, 0.0], [0.0, 12.0], [9.0, 0.0]]
        esper.delete_entity(found[9.0, 0.0], immediate=True)
        esper.add_component(found[0.0, 0.0], Pose(2.0, 0.0))
        esper.create_entity(Tree("oak", height=6.0), Pose(-9.0, 3.0))
        assert standing(prairie) == [[-9.0, 3.0], [0.0, 12.0], [2.0, 0.0]]


def test_a_tree_whose_deletion_esper_defers_is_felled_at_once() -> None:
    with little_prairie(scene=WOOD) as prairie:
        found = {(pose.x, pose.z): entity for entity, (_, pose) in esper.get_components(Tree, Pose)}
        assert len(standing(prairie)) == 3
        for place, left in (((9.0, 0.0), 2), ((0.0, 12.0), 1)):
            esper.delete_entity(found[place])
            assert len(standing(prairie)) == left
        felled = prairie.state()
        esper.process()
        assert len(standing(prairie)) == 1
        assert prairie.restore(felled) == {}
        assert len(standing(prairie)) == 1


def test_a_kind_of_trees_is_no_grass_to_be_changed() -> None:
    with little_prairie(scene=WOOD) as prairie, pytest.raises(ValueError, match=r"^'oak' are trees: give each another"):
        prairie.change_kind("oak", tip="#c86a1e")


def test_a_state_says_which_are_felled_and_brings_others_back() -> None:
    with little_prairie(scene=WOOD) as prairie:
        whole = prairie.state()
        (first, _), *_ = esper.get_component(Tree)
        esper.delete_entity(first, immediate=True)
        felled = prairie.state()
        prairie.restore(whole)
        assert len(standing(prairie)) == 3
        prairie.restore(felled)
        assert len(standing(prairie)) == 2
        sapling = esper.create_entity(Tree("oak", height=2.0), Pose(5.0, 5.0))
        planted = prairie.state()
        esper.delete_entity(sapling, immediate=True)
        prairie.restore(planted)
        assert [5.0, 5.0] in standing(prairie)


def test_a_state_keeps_trees_of_the_scene_that_a_game_has_changed() -> None:
    def foliages() -> list[float]:
        return sorted(tree.foliage for _, tree in esper.get_component(Tree))

    with little_prairie(scene=WOOD) as prairie:
        whole = prairie.state()
        first, second, third = (entity for entity, _ in esper.get_component(Tree))
        esper.add_component(first, Tree("oak", foliage=0.0))
        esper.add_component(second, Pose(4.0, 4.0))
        winter = prairie.state()
        prairie.restore(winter)
        assert foliages() == [0.0, 1.0, 1.0]
        assert len(standing(prairie)) == 3
        esper.delete_entity(third, immediate=True)
        bare = prairie.state()
        prairie.restore(whole)
        assert foliages() == [1.0, 1.0, 1.0]
        assert len(standing(prairie)) == 3
        *_, (last, _) = esper.get_component(Tree)
        esper.add_component(last, Tree("oak", 3.0))
        prairie.restore(bare)  # where that one is gone
        assert foliages() == [0.0, 1.0]
    with little_prairie(scene=WOOD) as prairie:
        prairie.restore(winter)
        assert foliages() == [0.0, 1.0, 1.0]
        assert [4.0, 4.0] in standing(prairie)


def test_a_scene_read_again_keeps_its_trees_unless_they_are_others() -> None:
    with little_prairie(scene=WOOD) as prairie:
        (first, _), *_ = esper.get_component(Tree)
        esper.delete_entity(first, immediate=True)
        values = prairie.scene.model_dump(mode="json")
        prairie.reload(values | {"mixing": "weight"})
        assert len(standing(prairie)) == 2
        summer = prairie.state()
        autumn = {name: kind | {"leaf": "#c86a1e"} for name, kind in values["trees"].items()}
        prairie.reload(values | {"mixing": "weight", "trees": autumn})  # what is felled stays so
        assert len(standing(prairie)) == 2
        prairie.restore(summer)
        prairie.reload(values | {"trees": {"oak": {"habit": "oak", "positions": [[5.0, 5.0]]}}})
        assert standing(prairie) == [[5.0, 5.0]]


@pytest.mark.parametrize(
    ("keys", "why"),
    [
        ({"height": 200.0}, "a tree is 0.5 to 60 m high, not 200.0"),
        ({"height": float("nan")}, "a tree is 0.5 to 60 m high, not nan"),
        ({"foliage": 2.0}, "a tree's foliage is from 0 to 1, not 2.0"),
    ],
)
def test_what_is_no_tree_is_refused_in_a_sentence(keys: dict[str, float], why: str) -> None:
    with pytest.raises(ValueError, match="a tree") as caught:
        Tree("oak", **keys)
    assert str(caught.value) == why


@pytest.mark.parametrize(("scene", "why"), [(WOOD, "there are oak"), (LITTLE, "it has none")])
def test_a_tree_of_no_kind_of_the_scene_is_named_once_and_left_standing_unseen(
    scene: str, why: str, caplog: pytest.LogCaptureFixture
) -> None:
    with little_prairie(scene=scene) as prairie:
        before = standing(prairie)
        for x in (5.0, 25.0):
            entity = esper.create_entity(Tree("fir"), Pose(x, 30.0))
            assert standing(prairie) == before
        assert esper.entity_exists(entity)
    said = [record.getMessage() for record in caplog.records if "'fir'" in record.getMessage()]
    assert len(said) == 1
    assert why in said[0]


def test_a_games_own_tree_outlives_its_prairie_and_shows_where_its_kind_is_known() -> None:
    with little_prairie(scene=WOOD):
        esper.create_entity(Tree("oak", height=6.0), Pose(-9.0, 3.0))
    with little_prairie(scene=LITTLE) as bare:
        assert standing(bare) == []
        bare.reload(bare.scene.model_dump(mode="json") | {"trees": {"oak": {"habit": "oak"}}})
        assert [-9.0, 3.0] in standing(bare)
