"""Writing changed values back: only what changed is touched."""

import difflib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.edit.rewrite import RewriteError, rewritten
from tallgrass.app.edit.values import NOTHING, Way, value_at, with_value
from tallgrass.engine.scene import bundled_scenes
from tallgrass.engine.scene.compose import read_document

SCENE = """\
# A meadow, for tests.
tallgrass: 2  # the format
terrain: {  noise: rolling,  size: [60, 60] }

grass:
  green: # short
    height: [0.3,   0.5] # two numbers
    tip: '#a8b65a'
    # before the root
    root: "#4b6128"
  tall: { width: 0.02 }

wind:
  # the first
  - kind: breeze
    strength: 0.5 # gentle

  - { kind: gust, position: [0, 10] }
camera:
  position: [0, 20]
quality: # in numbers
  patch: 2.5
  blades: 40
light:
"""


def read(text: str) -> Any:
    return read_document(text, file="").root.data


def changed(way: Way, value: Any, text: str = SCENE) -> tuple[str, list[str], list[str]]:
    """Return a text with another value at a way, and its removed and its added lines."""
    values = with_value(read(text), way, value)
    after = rewritten(text, values)
    assert read(after) == values
    lines = [line for line in difflib.ndiff(text.splitlines(), after.splitlines()) if line.startswith(("- ", "+ "))]
    return after, [line[2:] for line in lines if line[0] == "-"], [line[2:] for line in lines if line[0] == "+"]


@pytest.mark.parametrize(
    ("way", "value", "old", "new"),
    [
        (("grass", "green", "height", 1), 0.6, "[0.3,   0.5]", "[0.3,   0.6]"),
        (("grass", "green", "tip"), "#ffffff", "'#a8b65a'", "'#ffffff'"),
        (("grass", "green", "root"), "#ffffff", '"#4b6128"', '"#ffffff"'),
        (("wind", 0, "strength"), 0.25, "strength: 0.5 # gentle", "strength: 0.25 # gentle"),
        (("wind", 1, "position"), [1.5, 10], "position: [0, 10]", "position: [1.5, 10]"),
        (("terrain", "noise"), "hills", "noise: rolling,  size", "noise: hills,  size"),
        (("grass", "tall", "lean"), 0.1, "{ width: 0.02 }", "{ width: 0.02, lean: 0.1 }"),
        (("terrain", "noise"), NOTHING, "{  noise: rolling,  size:", "{  size:"),
        (("terrain", "size"), NOTHING, "rolling,  size: [60, 60] }", "rolling }"),
        (("grass", "tall", "width"), NOTHING, "{ width: 0.02 }", "{}"),
        (("light",), {"hour": 6}, "light:", "light: { hour: 6 }"),
    ],
)
def test_a_change_is_a_few_characters_and_all_else_stays(way: Way, value: Any, old: str, new: str) -> None:
    assert SCENE.count(old) == 1
    assert changed(way, value)[0] == SCENE.replace(old, new)


@pytest.mark.parametrize(
    ("way", "value", "new"),
    [
        (("seed",), 4, ["seed: 4"]),
        (("grass", "green", "lean"), 0.1, ["    lean: 0.1"]),
        (("wind", 0, "speed"), 3.0, ["    speed: 3"]),
        (("wind", 2), {"kind": "blast", "outline": {"disc": 3.0}}, ["  - { kind: blast, outline: { disc: 3 } }"]),
        (("camera", "eye"), 1.8, ["  eye: 1.8"]),
        (("grass", "odd name"), {"tip": "#aabbcc"}, ['  "odd name": { tip: "#aabbcc" }']),
    ],
)
def test_a_new_key_stands_behind_its_neighbours(way: Way, value: Any, new: list[str]) -> None:
    assert changed(way, value)[1:] == ([], new)


@pytest.mark.parametrize(
    ("way", "gone"),
    [
        (("grass", "green", "tip"), ["    tip: '#a8b65a'"]),
        (("grass", "tall"), ["  tall: { width: 0.02 }"]),
        (("wind", 1), ["  - { kind: gust, position: [0, 10] }"]),
        (("camera",), ["camera:", "  position: [0, 20]"]),
    ],
)
def test_a_key_that_goes_takes_its_own_lines_along(way: Way, gone: list[str]) -> None:
    assert changed(way, NOTHING)[1:] == (gone, [])


def test_the_first_key_of_an_item_goes_and_its_dash_stays() -> None:
    text, gone, new = changed(("wind", 0), {"strength": 0.5})
    assert (gone, new) == (["  - kind: breeze", "    strength: 0.5 # gentle"], ["  - strength: 0.5 # gentle"])
    assert "# the first" in text


@pytest.mark.parametrize(
    ("after", "gone", "new"),
    [
        (
            [{"kind": "breeze", "strength": 0.7}, {"kind": "gust", "position": [0, 10]}, {"kind": "blast"}],
            ["    strength: 0.5 # gentle"],
            ["    strength: 0.7 # gentle", "  - { kind: blast }"],
        ),
        (
            [{"kind": "breeze", "strength": 0.7}],
            ["    strength: 0.5 # gentle", "  - { kind: gust, position: [0, 10] }"],
            ["    strength: 0.7 # gentle"],
        ),
        (
            [{"kind": "gust", "position": [0, 10]}, {"kind": "blast"}],
            ["  - kind: breeze", "    strength: 0.5 # gentle"],
            ["  - { kind: blast }"],
        ),
    ],
)
def test_an_item_may_change_while_others_come_and_go(after: list[Any], gone: list[str], new: list[str]) -> None:
    assert changed(("wind",), after)[1:] == (gone, new)


def test_numbers_on_lines_become_a_word_beside_their_key_and_its_comment() -> None:
    _, gone, new = changed(("quality",), "high")
    assert (gone, new) == (["quality: # in numbers", "  patch: 2.5", "  blades: 40"], ["quality: high # in numbers"])


def test_a_text_on_lines_of_its_own_becomes_another_one_beside_its_key() -> None:
    text = "a:\n  map: >-\n    grass\n    of mine.png\n\n  # and\n  b: 1\n"
    after = rewritten(text, {"a": {"map": "other.png", "b": 1}})
    assert after == "a:\n  map: other.png\n\n  # and\n  b: 1\n"


def test_what_was_empty_at_the_end_of_a_file_is_filled_and_followed() -> None:
    assert rewritten("a: 1\nb:", {"a": 1, "b": 2, "c": 3}) == "a: 1\nb: 2\nc: 3"
    assert rewritten("a:\n  b:", {"a": {"b": 2, "d": 4}, "c": 3}) == "a:\n  b: 2\n  d: 4\nc: 3"


def test_what_reads_the_same_is_not_touched() -> None:
    values = read(SCENE)
    assert rewritten(SCENE, with_value(values, ("wind", 1, "position"), [0.0, 10.0])) == SCENE


def test_line_ends_and_a_last_line_without_one_stay_as_they_are() -> None:
    crlf = SCENE.replace("\n", "\r\n")
    assert rewritten(crlf, read(SCENE) | {"seed": 4}) == crlf + "seed: 4\r\n"
    assert rewritten("tallgrass: 2", {"tallgrass": 2, "seed": 4}) == "tallgrass: 2\nseed: 4"


def test_what_an_alias_repeats_is_refused_and_where_it_is_repeated_it_becomes_its_own() -> None:
    text = "a: &x { b: 1 }\nc: *x\n"
    with pytest.raises(RewriteError, match=r"^with what was changed, c\.b changes, too: it is written once"):
        rewritten(text, {"a": {"b": 2}, "c": {"b": 1}})
    assert rewritten(text, {"a": {"b": 1}, "c": {"b": 2}}) == "a: &x { b: 1 }\nc: { b: 2 }\n"


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=name, marks=[pytest.mark.slow] * (name == "hedgerow"))
        for name, path in bundled_scenes().items()
    ],
)
def test_every_value_of_a_bundled_scene_can_change_without_touching_another_line(path: Path) -> None:
    text = path.read_text("utf-8")

    def numbers(values: Any, way: Way) -> list[Way]:
        inner = values.items() if isinstance(values, dict) else enumerate(values) if isinstance(values, list) else ()
        own = [way] if isinstance(values, int | float) else []
        return own + [found for step, value in inner for found in numbers(value, (*way, step))]

    values, ways = read(text), numbers(read(text), ())
    assert len(ways) > 10
    for way in ways:
        after = rewritten(text, with_value(values, way, 123.25))
        apart = [(a, b) for a, b in zip(text.splitlines(), after.splitlines(), strict=True) if a != b]
        assert len(apart) == 1
        assert value_at(read(after), way) == 123.25


PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers(-9, 9) | st.sampled_from(["a", "b c", "#fff", "1", "x: y", "", "-"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from("abcd"), inner, max_size=3),
    max_leaves=8,
)
MAPPING = st.dictionaries(st.sampled_from("abcd"), PLAIN, min_size=1, max_size=4)


@given(MAPPING, MAPPING, st.booleans())
def test_any_values_are_written_over_any_others(before: dict[str, Any], after: dict[str, Any], flow: bool) -> None:  # noqa: FBT001
    import yaml  # noqa: PLC0415

    text = yaml.safe_dump(before, default_flow_style=flow, sort_keys=False)
    assert read(text) == before
    assert read(rewritten(text, after)) == after
