"""A game's queries to a prairie, without GL (N4, D2, D5, D6)."""

from collections.abc import Callable
from math import radians
from pathlib import Path
from typing import Literal

import esper
import numpy as np
import pytest
from yaml import safe_load

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindPrimitive, WindSource
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.flutter import flutter
from tallgrass.testing import LITTLE, watch

Load = Callable[..., Prairie]

PLACES = np.random.default_rng(0).uniform(-25.0, 25.0, (50, 2)).astype(np.float32)


class Blast(WindPrimitive):
    """A game's own wind, along x where x is positive."""

    kind: Literal["test-blast"] = "test-blast"
    priority: int = 9
    swing: float = 0.0

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.asarray(place[:, 0] > 0.0 * time, np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.tile(np.array([0.9, 0.0], np.float32) + np.float32(0.0 * time * seed), (len(grass.kind), 1))


def test_n4_the_wind_and_the_ground_are_there_without_any_gl(prairie: Prairie) -> None:
    wind, height = prairie.wind_at(PLACES), prairie.height_at(PLACES)
    assert [wind.shape, height.shape] == [(50, 2), (50,)]
    assert wind.dtype == height.dtype == np.float32
    assert 0.1 < np.linalg.norm(wind, axis=1).mean() < 0.8
    assert np.ptp(height) > 1.0


def test_n4_a_single_place_and_plain_lists_may_be_asked_for(prairie: Prairie) -> None:
    np.testing.assert_array_equal(prairie.wind_at(PLACES[3].tolist()), prairie.wind_at(PLACES[3:4]))
    np.testing.assert_array_equal(prairie.height_at([PLACES[3].tolist()]), prairie.height_at(PLACES)[3:4])


def test_n4_the_wind_of_now_is_that_of_the_prairies_time(prairie: Prairie) -> None:
    prairie.advance(1.25)
    prairie.advance(0.5)
    assert prairie.time == 1.75
    np.testing.assert_array_equal(prairie.wind_at(PLACES), prairie.wind_at(PLACES, 1.75))
    assert (prairie.wind_at(PLACES) != prairie.wind_at(PLACES, 0.0)).any()


def test_n5_the_wind_of_any_instant_is_known_in_advance(prairie: Prairie) -> None:
    soon = prairie.wind_at(PLACES, 5.5)
    prairie.advance(5.5)
    np.testing.assert_array_equal(prairie.wind_at(PLACES), soon)
    strength = [float(np.linalg.norm(prairie.wind_at(PLACES, time), axis=1).mean()) for time in (4.9, 5.5, 6.1)]
    assert strength[1] > 1.3 * max(strength[0], strength[2])


@pytest.mark.parametrize("direction", [0.0, 90.0, -35.0])
def test_f8_the_scenes_mean_wind_carries_the_small_oscillations(load: Load, tmp_path: Path, direction: float) -> None:
    swinging = f"{{ kind: breeze, strength: 0, swing: 0.25, direction: {direction} }}"
    scene = (tmp_path / "scene.yaml").read_text("utf-8")
    (tmp_path / "swinging.yaml").write_text(scene.replace("{ kind: breeze, strength: 0.4 }", swinging), "utf-8")
    prairie = load(tmp_path / "swinging.yaml")
    due = flutter(PLACES, time=40.0, seed=5, yaw=radians(direction))
    np.testing.assert_allclose(prairie.wind_at(PLACES, 40.0), np.float32(0.25) * due, atol=1e-6)


def test_d5_a_games_own_wind_may_come_and_go(prairie: Prairie) -> None:
    before = prairie.wind_at(PLACES)
    handle = prairie.add(Blast())
    right = PLACES[:, 0] > 0.0
    during = prairie.wind_at(PLACES)
    assert (during[right] == np.array([0.9, 0.0], np.float32)).all()
    np.testing.assert_array_equal(during[~right], before[~right])
    assert esper.component_for_entity(handle, WindSource).primitive == Blast()
    prairie.remove(handle)
    np.testing.assert_array_equal(prairie.wind_at(PLACES), before)


def test_d2_the_winds_of_a_scene_are_entities_of_the_current_world(prairie: Prairie) -> None:
    found = [source for _, source in esper.get_component(WindSource)]
    assert sorted(source.name for source in found) == ["wind[0] breeze", "wind[1] breeze"]
    assert {source.primitive for source in found} == set(prairie.scene.wind)


def test_d2_a_wind_that_a_game_makes_an_entity_of_is_felt(prairie: Prairie) -> None:
    entity = esper.create_entity(WindSource(Blast(), "mine"))
    assert (prairie.wind_at([[3.0, 1.0]]) == np.array([0.9, 0.0], np.float32)).all()
    esper.delete_entity(entity, immediate=True)
    assert (prairie.wind_at([[3.0, 1.0]]) != np.array([0.9, 0.0], np.float32)).any()


def test_two_prairies_in_one_world_have_each_its_own_wind(load: Load) -> None:
    one = load()
    alone = one.wind_at(PLACES)
    two = load()
    two.add(Blast())
    np.testing.assert_array_equal(one.wind_at(PLACES), alone)
    assert (two.wind_at(PLACES) != alone).any()


def test_a_reseeded_prairie_has_other_grass_and_the_same_ground(prairie: Prairie) -> None:
    other = prairie.reseeded(77)
    np.testing.assert_array_equal(other.height_at(PLACES), prairie.height_at(PLACES))
    ours, theirs = (made.site.growths[0].models[0].blades.root for made in (prairie, other))
    assert (ours != theirs).any()
    assert (other.scene.seed, prairie.scene.seed) == (77, 5)
    other.release()


def test_what_a_prairie_holds_is_printed_in_a_line(prairie: Prairie) -> None:
    """With all numbers of its grass it would be a million lines, which a debugger asks for as well."""
    watch(prairie)
    for thing in (prairie, prairie.site, prairie.viewers, prairie.viewers["main"]):
        assert len(repr(thing)) < 200


def test_time_stays_exact_whatever_numbers_it_moves_on_by(prairie: Prairie) -> None:
    for _ in range(4):
        prairie.advance(np.float32(0.5))  # type: ignore[arg-type]
    for _ in range(1000):
        prairie.advance(0.001)
    assert prairie.time == 3.0


def test_d2_released_a_prairie_leaves_the_world_as_it_was(world: World, load: Load) -> None:
    theirs = [esper.create_entity("a game's own"), esper.create_entity(3)]
    prairie = load()
    prairie.add(Blast())
    assert len(world) == 0
    assert len(prairie.world) == 3
    assert len(list(esper.get_entities())) == len(theirs) + len(prairie.world) + 1, "one that stands for all"
    prairie.release()
    assert sorted(esper.get_entities()) == theirs
    assert len(world) == 0


def test_d4_a_prairie_of_values_has_no_file_and_goes_on_in_others(world: World) -> None:
    del world
    heights = np.linspace(0.0, 6.0, 61 * 61, dtype=np.float32).reshape(61, 61)
    little = {"tallgrass": 2, "grass": {"green": {"height": [0.3, 0.5]}}, "quality": safe_load(LITTLE)["quality"]}
    keys = little | {"terrain": {"heights": heights}}
    made = Prairie.load(keys)
    other = made.reseeded(9)
    assert (made.path, made.files, other.scene.seed) == (None, {}, 9)
    assert made.height_at([(0.0, 0.0)]) == pytest.approx(3.0)
    ground = made.site.ground
    made.reload(keys | {"wind": [{"kind": "breeze"}]})
    assert made.site.ground is ground
    assert len(made.scene.wind) == 1
    made.reload(keys | {"terrain": {"heights": heights + 1.0}})
    assert made.height_at([(0.0, 0.0)]) == pytest.approx(4.0)
    other.release()
    made.release()


def test_w11_a_gust_sets_in_softly_at_its_sides_unless_its_scene_asks_for_priority(load: Load, tmp_path: Path) -> None:
    across = np.stack([np.linspace(0.0, 25.0, 101), np.zeros(101)], axis=1)  # it travels along z, and ends at x = 10
    gust = "  - { kind: gust, position: [0, 8], direction: 0, width: 20, soft: 8, ragged: 0, hold: 9 }\n"
    text = (tmp_path / "scene.yaml").read_text("utf-8").replace("quality:", gust + "quality:")
    steps = []
    for mixing in ("", "mixing: priority\n"):
        (tmp_path / "gust.yaml").write_text(text + mixing, "utf-8")
        wind = load(tmp_path / "gust.yaml").wind_at(across, 3.0)
        steps.append(np.linalg.norm(np.diff(wind, axis=0), axis=1).max())
    assert steps[0] < 0.3  # small oscillations differ from place to place, too
    assert steps[1] > 0.6
