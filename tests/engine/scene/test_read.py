"""Reading whole scenes."""

import json
import time
from collections.abc import Iterator
from pathlib import Path
from traceback import format_exception

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.engine.declared.scene import Scene
from tallgrass.engine.declared.terrain import TerrainSource
from tallgrass.engine.plugins import wind, wind_kinds
from tallgrass.engine.scene import SceneError, bundled_scenes, parse_scene, read_scene

GOOD = "tallgrass: 2\ngrass: { lawn: {} }\n"
BUNDLED = [path.read_text("utf-8") for path in bundled_scenes().values()]
WORDS = sorted(
    {word for text in BUNDLED for word in text.split()} | set("[]{}:-#&*!|>'\",?\n\t ") | {"  ", "\n  ", "<<:"}
)


@pytest.fixture
def _own_kinds() -> Iterator[None]:
    wind_kinds.cache_clear()
    yield
    wind_kinds.cache_clear()


def refusal(text: str) -> list[str]:
    with pytest.raises(SceneError) as error:
        parse_scene(text)
    return [f"{problem.line}:{problem.column} {problem.message}" for problem in error.value.problems]


def test_d4_a_scene_declares_kinds_terrain_and_winds(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(
        "tallgrass: 2\nseed: 5\nterrain: { noise: hills, scale: 1e1 }\n"
        "grass:\n  lawn: { height: [0.1, 1], stiffness: 2 }\nwind:\n  - { kind: breeze, strength: 0.25, start: 3 }\n"
    )
    loaded = read_scene(path)
    assert loaded.path == path
    assert loaded.folder == tmp_path
    assert loaded.scene.terrain == TerrainSource(noise="hills", scale=10.0)
    assert loaded.scene.grass["lawn"].height == [0.1, 1.0]
    (breeze,) = loaded.scene.wind
    assert breeze.model_dump() | {"kind": "breeze", "strength": 0.25, "start": 3.0} == breeze.model_dump()


@pytest.mark.parametrize("text", BUNDLED)
def test_a_scene_reads_the_same_with_its_keys_in_another_order(text: str) -> None:
    keys = yaml.safe_load(text)
    assert [*keys] != sorted(keys)
    assert parse_scene(yaml.safe_dump(keys)) == parse_scene(text)


def test_quality_is_a_preset_or_its_numbers() -> None:
    assert parse_scene(GOOD + "quality: paper-low").numbers().blades == 160
    rings = "{ blade_rings: [{ to: 1, segments: 3 }], strip_rings: [{ to: 8, strips: 4 }], blades: 77 }"
    assert parse_scene(GOOD + f"quality: {rings}").numbers().blades == 77


def test_a_string_is_a_bundled_name_and_a_path_never_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "plain").write_text(GOOD + "seed: 77")
    monkeypatch.chdir(tmp_path)
    assert read_scene("plain").path == bundled_scenes()["plain"]
    assert read_scene("./plain").scene.seed == 77


def test_a_scene_reads_the_same_with_a_byte_order_mark_and_other_line_ends(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + BUNDLED[0].replace("\n", "\r\n").encode())
    assert parse_scene(path.read_text("utf-8-sig")) == parse_scene(BUNDLED[0])


def test_files_that_are_missing_are_told_together_with_all_else(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text("tallgrass: 2\nsed: 1\ngrass:\n  lawn: { place: { map: a.png } }\nterrain: { heights: b.png }\n")
    with pytest.raises(SceneError) as error:
        read_scene(path)
    assert [(problem.line, problem.column) for problem in error.value.problems] == [(2, 1), (4, 25), (5, 21)]


def test_maps_and_places_that_cannot_be_used_are_told_together_with_all_else(tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        (tmp_path / name).write_text("no picture")
    path = tmp_path / "a.yaml"
    path.write_text(
        "tallgrass: 2\ngrass:\n  lawn: { place: { map: a.png } }\n  reeds: { place: { map: a.png }, lean: 7 }\n"
        "wind: [{ kind: gust, start: 5, stop: 3 }]\n"
        "camera: { position: [5000, 0], path: [{ at: 0, position: [0, 101] }] }\n"
    )
    with pytest.raises(SceneError) as error:
        read_scene(path)
    places = [(problem.line, problem.column) for problem in error.value.problems]
    assert places == [(3, 25), (4, 41), (5, 38), (6, 21), (6, 58)]
    path.write_text("tallgrass: 2\nsed: 1\ngrass: { lawn: {} }\nterrain: { heights: b.png }\n")
    with pytest.raises(SceneError) as error:
        read_scene(path)
    assert [(problem.line, problem.column) for problem in error.value.problems] == [(2, 1), (4, 21)]


def test_numbers_out_of_order_are_told_together_with_all_else() -> None:
    told = refusal(
        "tallgrass: 2\nterrain: { size: [-5, 0], sed: 1 }\n"
        "grass: { a: { height: [2, 1], leaf: [2, 1], lean: 7, head: { size: [2, 1], open: 3 } } }\n"
    )
    assert [each.split()[0] for each in told] == ["2:18", "2:27", "3:23", "3:37", "3:51", "3:68", "3:82"]


def test_a_file_named_with_impossible_characters_is_missing(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text('tallgrass: 2\ngrass: { lawn: { place: { map: "a\\0\\n\\e" } } }\n')
    with pytest.raises(SceneError, match="no file 'a"):
        read_scene(path)


def test_keys_that_are_not_known_are_told_with_those_that_are() -> None:
    (told,) = refusal(GOOD + "light: { glow: 3 }")
    known = (
        "azimuth, clouds, day, elevation, exposure, ground, haze, horizon, hour, hours_per_minute, latitude, strength, "
        "sun, turbidity, "
    )
    assert told == f"3:10 unknown key 'glow'; known: {known}zenith"


def test_a_traceback_tells_of_problems_in_words_of_scenes_alone() -> None:
    with pytest.raises(SceneError) as caught:
        parse_scene(GOOD + "sead: 3\n")
    assert "pydantic" not in "".join(format_exception(caught.value))


def test_a_key_that_has_the_name_of_a_grass_kind_confuses_nothing() -> None:
    (told,) = refusal("tallgrass: 2\ngrass: { height: { heigth: [1, 2] } }")
    assert told == "2:20 unknown key 'heigth', did you mean 'height'?"


def test_a_problem_inside_what_an_alias_repeats_is_told_where_it_stands() -> None:
    told = refusal("tallgrass: 2\ngrass:\n  a: &a { width: 9 }\n  b: *a\n")
    assert told == ["3:18 width must be more than 0.0005 and at most 0.2 m, found 9"] * 2


def test_of_very_many_problems_the_rest_is_counted() -> None:
    told = refusal(GOOD + "".join(f"key{i}: 1\n" for i in range(500)))
    assert len(told) == 201
    assert told[-1].endswith("and 300 more problems")


@pytest.mark.usefixtures("_own_kinds")
def test_a_plugin_that_fails_on_its_values_is_a_problem_of_its_line() -> None:
    @wind("test-fragile")
    class Fragile(WindPrimitive):
        size: float = 1.0

        def model_post_init(self, _: object, /) -> None:
            if self.size < 0:
                raise KeyError("no\nsuch size")

        def mask(self, place: Floats, /, *, time: float) -> Floats:
            return place[:, 0] * 0 + time

        def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
            return place * 0 + time + seed

    told = refusal(GOOD + "wind:\n  - { kind: test-fragile, size: x, sise: 1 }\n  - { kind: test-fragile, size: -1 }\n")
    assert told == [
        "4:33 size must be a number, found the text 'x'",
        "4:36 unknown key 'sise', did you mean 'size'?",
        r"5:5 kind 'test-fragile' failed on these values: KeyError: 'no\nsuch size'",
    ]


def test_ten_thousand_lines_are_read_in_less_than_a_second(tmp_path: Path) -> None:
    place = "      position:\n        - 1e1\n        - -3\n      target:\n        - 1\n        - 2\n        - 3\n"
    stops = "".join(f"    - at: {i}\n{place}      yaw: {i}\n      pitch: 2.5\n" for i in range(1000))
    winds = "".join(f"  - kind: breeze\n    strength: 0.5\n    start: {i}\n" for i in range(200))
    path = tmp_path / "large.yaml"
    path.write_text(GOOD + "wind:\n" + winds + "camera:\n  path:\n" + stops)
    assert len(path.read_text().splitlines()) > 10_000

    start = time.thread_time()
    loaded = read_scene(path)
    assert time.thread_time() - start < 1.0
    assert len(loaded.scene.camera.path) == 1000


def test_ten_thousand_lines_of_problems_are_told_in_less_than_a_second() -> None:
    text = GOOD + "camera:\n  path:\n" + "".join(f"    - at: {i}\n      positon: [1, 2]\n" for i in range(5_000))
    start = time.thread_time()
    told = refusal(text)
    assert time.thread_time() - start < 1.0
    assert told


def outcome(text: str) -> None:
    """Read a text; the result must be a scene or a SceneError."""
    try:
        scene = parse_scene(text)
    except SceneError as error:
        problems = error.problems
    else:
        assert isinstance(scene, Scene)
        return
    assert problems
    assert all(problem.message and problem.line >= 1 and problem.column >= 1 for problem in problems)


@given(st.text(max_size=200))
def test_any_text_is_a_scene_or_problems(text: str) -> None:
    outcome(text)


@given(st.lists(st.sampled_from(WORDS), max_size=60).map(" ".join))
def test_any_words_of_scenes_are_a_scene_or_problems(text: str) -> None:
    outcome("tallgrass: 2\n" + text)


@given(st.sampled_from(BUNDLED), st.data())
def test_any_change_of_a_bundled_scene_is_a_scene_or_problems(text: str, data: st.DataObject) -> None:
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        length = data.draw(st.integers(0, 12))
        piece = data.draw(st.sampled_from(WORDS) | st.text(max_size=8))
        text = text[:start] + piece + text[start + length :]
    outcome(text)


scalars = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5)
trees = st.recursive(scalars, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner))
KEYS = ["seed", "terrain", "grass", "wind", "camera", "light", "quality"]


@given(st.dictionaries(st.sampled_from(KEYS), trees, min_size=1))
def test_any_value_of_any_key_is_a_scene_or_problems(values: dict[str, object]) -> None:
    outcome("tallgrass: 2\n" + "".join(f"{key}: {json.dumps(value)}\n" for key, value in values.items()))
