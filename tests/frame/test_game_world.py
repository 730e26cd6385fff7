"""A prairie among the entities of a game (D2, D6)."""

import gc
import weakref
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Blast, Breeze, Gust, Pose
from tallgrass.components.patch import Patch
from tallgrass.components.receivers import Receivers
from tallgrass.components.tree import Tree
from tallgrass.components.viewer import Viewer
from tallgrass.components.wind import WindSource
from tallgrass.engine.camera import Camera
from tallgrass.engine.scene import LoadedScene, read_scene
from tallgrass.engine.world import install
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, watch

Stage = Any
Aim = Callable[..., Camera]
WINDY = LITTLE + "wind: [{ kind: breeze, strength: 0.4 }, { kind: gust, position: [-20, 0] }]\n"
HERE = np.array([[0.0, 0.0], [3.0, 4.0], [-9.0, 14.0]], np.float32)
BESIDE = np.array([[0.0, 8.5]], np.float32)
"""Place that a runner passes, a little to its side."""

SEEN = np.array([[0.0, 12.5]], np.float32)
"""A place that no crest hides."""

numbers = count()


@dataclass
class Bullet:
    speed: float


class Shoot(esper.Processor):
    """A processor of the game's own."""

    def process(self, *args: object) -> None:
        """Do nothing."""


@pytest.fixture
def loaded(tmp_path: Path) -> LoadedScene:
    """The little scene, as it is read."""
    (tmp_path / "scene.yaml").write_text(LITTLE, "utf-8")
    return read_scene(tmp_path / "scene.yaml")


@pytest.fixture(autouse=True)
def level() -> Iterator[str]:
    """Name of a game's current world, which is not esper's default one."""
    name = f"level-{next(numbers)}"
    esper.switch_world(name)
    yield name
    esper.switch_world("default")
    esper.delete_world(name)


def told() -> tuple[object, ...]:
    """Return the contents of the current world: entities, processors and event handlers."""
    entities: dict[int, tuple[object, ...]] = {
        entity: esper.components_for_entity(entity) for entity in esper.get_entities()
    }
    return entities, esper.get_processor(Shoot), [type(one) for one in esper._processors], dict(esper.event_registry)  # noqa: SLF001


def test_d6_a_games_world_is_as_it_was_after_release(stage: Stage, loaded: LoadedScene, ctx: moderngl.Context) -> None:
    shoot = Shoot()
    esper.add_processor(shoot, 5)
    handle = esper.create_entity(Bullet(3.0), Pose(1.0, 2.0))
    before = told()
    prairie = Prairie(loaded, ctx=ctx)
    install()
    prairie.add(Gust(), name="theirs")
    esper.process(0.1)
    for _ in range(4):  # patches and receivers become entities by and by
        stage.shot(prairie)
    assert len(list(esper.get_entities())) > 500
    prairie.release()
    assert told() == before
    assert esper.component_for_entity(handle, Pose) == Pose(1.0, 2.0)


def test_d6_nothing_appears_in_a_world_that_is_not_the_prairies(
    level: str, stage: Stage, loaded: LoadedScene, ctx: moderngl.Context
) -> None:
    esper.switch_world("default")
    others = set(esper.get_entities()), esper.get_processor(Shoot)
    esper.switch_world(level)
    prairie = Prairie(loaded, ctx=ctx)
    install()
    esper.process(0.5)
    stage.shot(prairie)
    assert prairie.time == 0.5
    prairie.release()
    esper.switch_world("default")
    assert (set(esper.get_entities()), esper.get_processor(Shoot)) == others
    esper.switch_world(level)


def test_d6_a_games_processor_writes_winds_and_reads_what_the_grass_feels(
    stage: Stage, loaded: LoadedScene, ctx: moderngl.Context
) -> None:
    class Carry(esper.Processor):
        def process(self, dt: float) -> None:
            for entity, _ in esper.get_component(Bullet):
                pose = esper.component_for_entity(entity, Pose)
                esper.add_component(entity, Pose(pose.x + 10.0 * dt, pose.z))

    prairie = Prairie(loaded, ctx=ctx)
    install()
    esper.add_processor(Carry())
    runner = esper.create_entity(Bullet(10.0), Pose(-20.0, 10.0), WindSource(Blast(strength=0.9), "runner"))
    still = prairie.wind_at(BESIDE)
    for _ in range(20):
        esper.process(0.1)
    stage.shot(prairie)
    assert esper.component_for_entity(runner, Pose).x == pytest.approx(0.0)
    (here,) = prairie.wind_at(BESIDE)
    assert np.hypot(*here) > np.hypot(*still[0]) + 0.1
    assert here[1] < 0.0, "grass beside the runner is pressed away from it"
    felt = [row for _, found in esper.get_component(Receivers) for row in zip(found.place, found.message, strict=True)]
    place, message = (np.array(column) for column in zip(*felt, strict=True))
    near = np.hypot(place[:, 0], place[:, 1] - 10.0) < 2.5
    outwards = place[near] - (0.0, 10.0)
    assert near.sum() > 20
    assert ((outwards * message[near]).sum(axis=1) > 0).mean() > 0.9
    prairie.release()
    esper.delete_entity(runner, immediate=True)


def test_d6_released_a_prairie_needs_no_collector_to_be_gone(
    stage: Stage, loaded: LoadedScene, ctx: moderngl.Context
) -> None:
    prairie = Prairie(loaded, ctx=ctx)
    stage.shot(prairie)
    gone = weakref.ref(prairie)
    prairie.release()
    gc.disable()
    try:
        del prairie
        assert gone() is None
    finally:
        gc.enable()


@pytest.mark.slow
def test_d6_a_crowd_that_comes_and_goes_every_frame_does_not_slow_the_systems(
    stage: Stage, loaded: LoadedScene, camera: Aim, ctx: moderngl.Context
) -> None:
    prairie = Prairie(loaded, ctx=ctx)
    prairie.add(Breeze(strength=0.2))

    def frame(crowd: int, number: int) -> float:
        bullets = [esper.create_entity(Bullet(1.0), Pose(float(k), 0.0)) for k in range(crowd)]
        prairie.advance(1 / 60)
        stage.shot(prairie, camera(0.02 * number, 2.6, 18.0 - 0.03 * number, pitch=-12))
        for bullet in bullets:
            esper.delete_entity(bullet, immediate=True)
        return sum(prairie.statistics.systems_ms.values())

    took = [(frame(0, 2 * number), frame(1000, 2 * number + 1)) for number in range(30)][4:]
    prairie.release()
    alone, crowded = (min(times) for times in zip(*took, strict=True))  # others may keep the processor busy
    assert crowded < 1.5 * alone, f"{crowded:.2f} ms in a crowd, {alone:.2f} ms alone"


@pytest.fixture
def windy(tmp_path: Path, stage: Stage, ctx: moderngl.Context) -> Iterator[Prairie]:
    """A prairie with a breeze and a gust, 2 s old, whose patches are all entities."""
    (tmp_path / "windy.yaml").write_text(WINDY, "utf-8")
    prairie = Prairie.load(tmp_path / "windy.yaml", ctx=ctx)
    prairie.advance(2.0)
    shot_until_all_are_there(stage, prairie)
    yield prairie
    prairie.release()


def shot_until_all_are_there(stage: Stage, prairie: Prairie) -> None:
    for _ in range(5):  # patches and receivers become entities by and by
        stage.shot(prairie)


def lives(prairie: Prairie) -> dict[type, int]:
    return {kind: len(prairie.world.all(kind)) for kind in (Patch, Receivers, Viewer, WindSource)}


def test_d2_after_a_game_has_cleared_its_world_the_prairie_comes_back_to_life(
    stage: Stage, windy: Prairie, caplog: pytest.LogCaptureFixture
) -> None:
    before, felt, picture = lives(windy), windy.wind_at(HERE), stage.shot(windy)
    esper.clear_database()
    assert windy.patch_at(HERE).tolist() == [0, 0, 0], "it has not looked again yet"
    np.testing.assert_array_equal(stage.shot(windy), picture)
    shot_until_all_are_there(stage, windy)
    np.testing.assert_array_equal(stage.shot(windy), picture)
    assert lives(windy) == before
    assert before[WindSource] == 2
    np.testing.assert_array_equal(windy.wind_at(HERE), felt)
    cells = [esper.component_for_entity(entity, Patch).cell for entity in windy.patch_at(HERE).tolist()]
    assert cells == [(0, 0), (1, 1), (-4, 5)]
    assert len(caplog.messages) == 1
    assert "cleared" in caplog.messages[0]


def test_d2_a_prairie_comes_back_to_life_as_often_as_its_world_is_cleared(
    stage: Stage, windy: Prairie, caplog: pytest.LogCaptureFixture
) -> None:
    before = lives(windy)
    for times in range(1, 4):
        esper.clear_database()
        shot_until_all_are_there(stage, windy)
        assert lives(windy) == before
        assert len(caplog.messages) == times


def test_d2_winds_are_there_again_before_anything_is_drawn(windy: Prairie) -> None:
    felt = windy.wind_at(HERE)
    esper.clear_database()
    assert [source.name for source in windy.winds.sources()] == ["wind[0] breeze", "wind[1] gust"]
    np.testing.assert_array_equal(windy.wind_at(HERE), felt)


def test_d2_winds_that_a_game_added_go_with_the_world_that_it_clears(windy: Prairie) -> None:
    felt = windy.wind_at(HERE)
    windy.add(Blast(position=[0.0, 0.0], strength=1.0))
    assert (windy.wind_at(HERE) != felt).any()
    esper.clear_database()
    np.testing.assert_array_equal(windy.wind_at(HERE), felt)


@pytest.mark.parametrize("reads_again", [False, True], ids=["drawn", "read again with other grass"])
def test_d2_what_a_game_makes_after_clearing_its_world_is_not_taken_for_what_was_there(
    stage: Stage, windy: Prairie, *, reads_again: bool
) -> None:
    esper.clear_database()
    handles = [windy.add(Breeze(strength=0.1), name=f"new {number}") for number in range(8)]
    bullets = [esper.create_entity(Bullet(float(number))) for number in range(600)]
    if reads_again:
        windy.loaded.file.write_text(WINDY.replace("stiffness: 2", "stiffness: 1"), "utf-8")
        windy.reload()
    shot_until_all_are_there(stage, windy)
    names = [esper.component_for_entity(handle, WindSource).name for handle in handles]
    assert names == [f"new {number}" for number in range(8)]
    assert [esper.components_for_entity(bullet) for bullet in bullets] == [(Bullet(float(k)),) for k in range(600)]
    assert {source.name for source in windy.winds.sources()} == {"wind[0] breeze", "wind[1] gust", *names}
    windy.release()
    assert sorted(esper.get_entities()) == bullets


def test_d2_grass_that_was_taken_away_stays_away_when_the_world_is_cleared(stage: Stage, windy: Prairie) -> None:
    whole = stage.shot(windy)
    esper.delete_entity(int(windy.patch_at(BESIDE + np.array([0.0, 4.0], np.float32))[0]), immediate=True)
    bare = stage.shot(windy)
    assert (bare != whole).any()
    esper.clear_database()
    np.testing.assert_array_equal(stage.shot(windy), bare)


def test_d2_a_scenes_trees_are_there_again_when_the_world_is_cleared_but_for_those_that_were_felled(
    tmp_path: Path,
) -> None:
    wooded = tmp_path / "wooded.yaml"
    wooded.write_text(LITTLE + "trees: { thorn: { habit: hawthorn, positions: [[0, 0], [5, 5], [9, 0]] } }\n", "utf-8")
    prairie = Prairie.load(wooded)
    esper.clear_database()
    assert trees_after_a_frame(prairie) == [(0.0, 0.0), (5.0, 5.0), (9.0, 0.0)], "it has not looked before"
    esper.delete_entity(esper.get_component(Tree)[0][0], immediate=True)
    esper.create_entity(Tree("thorn", 2.0), Pose(-9.0, 0.0))
    assert trees_after_a_frame(prairie) == [(5.0, 5.0), (9.0, 0.0), (-9.0, 0.0)]
    esper.clear_database()
    bullet = esper.create_entity(Bullet(1.0))
    again = Prairie.load(wooded)
    again.restore(prairie.state())
    assert len(esper.get_component(Tree)) == 4, "two of each: none was felled by clearing"
    again.release()
    assert trees_after_a_frame(prairie) == [(5.0, 5.0), (9.0, 0.0)]
    prairie.release()
    assert [*esper.get_entities()] == [bullet]


def trees_after_a_frame(prairie: Prairie) -> list[tuple[float, float]]:
    watch(prairie)
    return [(pose.x, pose.z) for _, (_, pose) in esper.get_components(Tree, Pose)]
