"""Scenes from a program's values: the same models and messages as from files, without any file (D4)."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from tallgrass.components.arrays import Floats
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.scene import Scene
from tallgrass.engine.scene import LoadedScene, SceneError, load_maps, parse_scene, read_again, read_scene
from tallgrass.systems.wind.gust import Gust

HEIGHTS = np.random.default_rng(0).uniform(0.0, 4.0, (30, 40)).astype(np.float32)
GREEN: Mapping[str, Any] = {"green": {"height": [0.3, 0.5]}}


def read(**keys: Any) -> LoadedScene:
    return read_scene({"tallgrass": 2, "grass": GREEN} | keys)


def told(**keys: Any) -> str:
    with pytest.raises(SceneError) as caught:
        load_maps(read(**keys))
    return str(caught.value)


def test_a_mapping_declares_what_a_file_of_the_same_keys_does() -> None:
    keys = {"tallgrass": 2, "grass": dict(GREEN), "wind": [{"kind": "gust", "speed": 4.0}], "quality": "low"}
    text = "{tallgrass: 2, grass: {green: {height: [0.3, 0.5]}}, wind: [{kind: gust, speed: 4}], quality: low}"
    loaded = read_scene(keys)
    assert loaded.scene == parse_scene(text)
    assert (loaded.path, loaded.paths) == (None, {})


def test_a_mapping_may_hold_tuples_numpys_numbers_parts_and_winds() -> None:
    loaded = read(
        seed=np.int64(4),
        grass={"green": GrassKind(height=[0.3, 0.5]), "rush": {"height": (np.float32(0.5), 1)}},
        wind=(Gust(speed=4.0),),
        camera={"position": np.array([1.0, 2.0])},
    )
    assert loaded.scene.seed == 4
    assert [kind.height for kind in loaded.scene.grass.values()] == [[0.3, 0.5], [0.5, 1.0]]
    assert loaded.scene.wind == [Gust(speed=4.0)]
    assert loaded.scene.camera.position == [1.0, 2.0]


def test_a_scene_is_taken_as_it_is_and_checked_once_more() -> None:
    scene = Scene(tallgrass=2, grass={"green": GrassKind()}, wind=[Gust()])
    assert read_scene(scene).scene == scene
    with pytest.raises(SceneError, match=r"^seed: seed must be between 0 and 2147483647, found -1$"):
        read_scene(scene.model_copy(update={"seed": -1}))


def test_a_scene_can_be_written_to_a_file_with_the_keys_that_were_given() -> None:
    scene = read(wind=[Gust(speed=4.0), {"kind": "breeze"}], quality="low").scene
    keys = scene.model_dump(mode="json", exclude_unset=True)
    assert keys["wind"] == [{"kind": "gust", "speed": 4.0}, {"kind": "breeze"}]
    assert parse_scene(yaml.safe_dump(keys)) == scene


def test_every_problem_is_told_by_the_path_of_its_key_in_the_order_of_the_values() -> None:
    wrong = told(
        grass={"meadow": {"heigth": 1}, "dry": {"height": [3, 2]}},
        wind=[Gust(), {"kind": "gust", "speed": -4}, {"kind": "gsut"}],
        camera={"position": (900, 0)},
    ).splitlines()
    assert wrong == [
        "grass.meadow.heigth: unknown key 'heigth', did you mean 'height'?",
        "grass.dry.height: height must be [shortest, tallest], rising, between 0.02 and 5 m",
        "wind[1].speed: speed must be more than 0.1 and at most 60 m/s, found -4",
        "wind[2].kind: unknown kind 'gsut', did you mean 'gust'? known: blast, breeze, gust, turbulence, whirlwind",
        "camera.position: position is off the terrain, which spans x from -100 to 100 and z from -100 to 100 m",
    ]


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"grass": {}}, "grass: grass must have 1 to 16 entries, found 0"),
        ({"grass": 3}, "grass: grass must be a mapping of keys, found 3"),
        ({"tallgrass": 7}, "tallgrass: this scene is of format 7, this release reads up to 2; update tallgrass"),
        ({"terrain": {"heights": 3}}, "terrain.heights: heights must be text, found 3"),
        ({"terrain": {"heights": "no.npy"}}, "terrain.heights: no file 'no.npy' relative to the scene"),
        ({"seed": np.zeros(3)}, "seed: seed must be a whole number, found an array of shape (3,)"),
    ],
)
def test_a_value_is_refused_in_the_words_of_files(keys: dict[str, Any], sentence: str) -> None:
    assert told(**keys) == sentence


@pytest.mark.parametrize("key", ["grass", "trees"])
@pytest.mark.parametrize("name", ["", "  "])
def test_a_kind_without_a_name_is_refused(key: str, name: str) -> None:
    kinds = {"grass": {**GREEN, name: {}}, "trees": {name: {"habit": "oak"}}}
    assert told(**{key: kinds[key]}) == f"{key}: a kind has a name that is not empty"


def test_a_mapping_without_a_version_and_one_with_other_keys_than_texts_are_refused() -> None:
    with pytest.raises(SceneError, match=r"^the scene: a scene begins with 'tallgrass: 2'"):
        read_scene({"grass": GREEN})
    assert told(grass={3: {}}) == "grass: a key must be text, found 3"
    wrong = "grass: a key must be text, found 3\ngrass.3.heigth: unknown key 'heigth', did you mean 'height'?"
    assert told(grass={3: {"heigth": [1, 2]}}) == wrong


def test_values_that_hold_themselves_and_too_many_are_refused() -> None:
    endless: dict[str, Any] = {"tallgrass": 2}
    endless["grass"] = endless
    with pytest.raises(SceneError, match=r"^grass: nested more than 64 levels deep$"):
        read_scene(endless)
    twice: Any = 0
    for _ in range(20):
        twice = [twice, twice]
    assert told(camera=twice) == "camera: more than 100000 values"


@pytest.mark.parametrize(
    ("heights", "sentence"),
    [
        (HEIGHTS[0], "it must be an array of rows and columns, not of 1 dimensions"),
        (HEIGHTS[:1], "it is 40 by 1 cells, and a map has 2 to 8193 a side"),
        (HEIGHTS[:2, :2], "it is only 1 by 1 m; give a larger cell, in metres"),
        (HEIGHTS.astype(complex), "it holds complex128 values; heights are floats or integers"),
        (HEIGHTS.astype(object), "it holds object values; heights are floats or integers"),
        (HEIGHTS.astype(np.uint8), "8 bits hold only 256 heights, which would make terraces; hand in metres as"),
        (1e6 * np.ones((9, 9)), "its heights go from 1e+06 to 1e+06 m; scale them, or mark its voids"),
        (np.where(HEIGHTS[3, 4] == HEIGHTS, np.inf, HEIGHTS), "1 height is no number, the first at row 3, column 4, "),
        (np.full((9, 9), -np.inf), "81 heights are no numbers, the first at row 0, column 0, counted from 0"),
        (HEIGHTS.tolist(), "a map is a file's name or, in a program, an array: hand in numpy.array(rows), no list"),
        (np.ma.masked_array(HEIGHTS), "the mask of a masked array is not read; hand in what its filled() returns"),
    ],
)
def test_an_array_that_is_no_map_of_heights_is_refused_in_a_sentence(heights: Floats, sentence: str) -> None:
    assert told(terrain={"heights": heights}).startswith(f"terrain.heights: {sentence}")


@pytest.mark.parametrize(
    ("density", "more", "sentence"),
    [
        (np.zeros(4), {}, "it must be an array of rows and columns, with 1 to 4 channels at most, not (4,)"),
        (
            np.zeros((4, 4, 5)),
            {},
            "it must be an array of rows and columns, with 1 to 4 channels at most, not (4, 4, 5)",
        ),
        (np.zeros((4, 0)), {}, "it is 0 by 4 cells; a density map has 1 to 4097 a side"),
        (np.zeros((4, 4), int), {}, "it holds int64 values; densities are floats from 0 to 1, unsigned integers"),
        (np.full((4, 4), 1.5), {}, "it goes from 1.5 to 1.5; densities are from 0 to 1"),
        (np.full((4, 4), np.nan), {}, "16 densities are no numbers, the first at row 0, column 0, counted from 0"),
        (np.zeros((4, 4)), {"channel": "blue"}, "it has no blue channel, only red"),
    ],
)
def test_an_array_that_is_no_map_of_densities_is_refused_in_a_sentence(
    density: Floats, more: dict[str, str], sentence: str
) -> None:
    wrong = told(grass={"green": {"place": {"map": density} | more}})
    assert wrong.startswith(f"grass.green.place.map: {sentence}")


def test_densities_that_rounding_left_just_beyond_0_and_1_are_0_and_1() -> None:
    grey = np.array([[1.0000012, -1e-6], [0.5, 1.0]])
    _, found = load_maps(read(grass={"green": {"place": {"map": grey}}}))
    np.testing.assert_array_equal(found.maps[0], np.array([[1.0, 0.0], [0.5, 1.0]], np.float32))


def test_an_array_of_heights_means_what_a_file_of_it_does(tmp_path: Path) -> None:
    for heights, more in ((HEIGHTS, {"cell": 2.0}), ((100 * HEIGHTS).astype(np.uint16), {"cell": 5.0, "flip": True})):
        np.save(tmp_path / "heights.npy", heights)
        terrain = {"heights": "heights.npy"} | more
        (tmp_path / "scene.yaml").write_text(json.dumps({"tallgrass": 2, "terrain": terrain, "grass": GREEN}))
        due, _ = load_maps(read_scene(tmp_path / "scene.yaml"))
        found, _ = load_maps(read(terrain={"heights": heights} | more))
        np.testing.assert_array_equal(found.heights, due.heights)
        assert found.cell == due.cell


@pytest.mark.parametrize(("kind", "whole"), [("bool", 1), ("uint8", 255), ("uint16", 65535), ("float64", 1)])
def test_full_density_is_the_largest_number_of_a_map(kind: str, whole: int) -> None:
    half = np.zeros((2, 4), kind)
    half[:, 2:] = whole
    loaded = read(grass={"left": {}, "right": {"place": {"map": half}}})
    np.testing.assert_array_equal(load_maps(loaded)[1].maps[:, 0], [[1, 1, 0, 0], [0, 0, 1, 1]])


def test_kinds_share_an_array_channel_by_channel() -> None:
    both = np.zeros((2, 2, 2))
    both[:, 0, 0], both[:, 1, 1] = 0.5, 1.0
    places = {"a": {"place": {"map": both}}, "b": {"place": {"map": both, "channel": "green"}}}
    np.testing.assert_array_equal(load_maps(read(grass=places))[1].maps[:, 0], [[0.5, 0.0], [0.0, 1.0]])


def test_a_callers_arrays_are_copied_and_tell_a_change_by_what_they_hold() -> None:
    mine = HEIGHTS.copy()
    first = read(terrain={"heights": mine})
    before = load_maps(first)
    same = load_maps(read(terrain={"heights": mine.copy()}), before=(first, before))
    assert (same[0] is before[0], same[1] is before[1]) == (True, True)
    mine[:] = 7.0
    np.testing.assert_array_equal(load_maps(first)[0].heights, HEIGHTS)
    other = load_maps(read(terrain={"heights": mine}), before=(first, before))
    assert other[0].heights.min() == 7.0


def test_what_has_no_file_says_so_where_one_is_needed() -> None:
    loaded = read()
    with pytest.raises(ValueError, match=r"^this scene was made from a program's values; it has no file"):
        _ = loaded.file
    with pytest.raises(ValueError, match=r"^this prairie was made from a program's values: call reload with a"):
        read_again(loaded, None)
    assert read_again(loaded, {"tallgrass": 2, "seed": 3, "grass": GREEN}).scene.seed == 3


def test_half_a_character_is_refused_in_one_sentence_wherever_it_stands() -> None:
    """A lone surrogate, as of a file's name of other bytes, is in no file and no saved game."""
    assert told(grass={"a\ud800": {}}) == r"grass: a key must be Unicode text, found 'a\ud800'"
    assert told(wind=[{"kind": "g\ud800"}]).startswith(r"wind[0].kind: text must be Unicode, found 'g\ud800'")
