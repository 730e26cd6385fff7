"""The schema of scene files: valid and invalid scenes, and texts for editors."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import fastjsonschema
import numpy as np
import pytest
from pydantic import Field

from tallgrass.app.check import described
from tallgrass.components.arrays import Floats
from tallgrass.components.declaration import Declaration
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.engine.plugins import wind, wind_kinds
from tallgrass.engine.scene import SceneError, bundled_scenes, parse_scene
from tallgrass.engine.scene.compose import decode, read_document

Fits = Callable[[object], bool]
BROKEN = sorted((Path(__file__).parent / "broken").glob("*.yaml"))
FULL = Path(__file__).parent / "format-2" / "full.yaml"
BEYOND = {
    "camera-off-the-terrain", "folder-for-a-map", "map-is-no-image", "no-alpha-channel", "no-density-file",
    "no-elevation-file", "not-a-number", "blades-without-room", "two-bad-maps", "blast-picture-missing",
    "heights-and-noise", "heights-swapped", "path-goes-back-in-time", "path-off-the-terrain", "quality-rings-fall",
    "wind-stops-before-it-starts", "wind-path-goes-back-in-time", "gust-intervals-fall", "blast-outline-twice",
    "blast-ellipse-flat", "blast-outline-empty", "presser-corners-in-a-line",
    "presser-goes-back-in-time", "trees-among-nothing", "trees-off-the-terrain",
    "head-on-grass", "head-of-no-form-on-grass", "head-of-no-eye", "head-longer-than-its-stem", "head-sizes-fall",
    "leaves-fall", "plants-of-grass", "blades-of-a-flower", "several-keys-of-another-plant",
}  # fmt: skip
"""What is wrong with the files that a scene names, or with several values together: `check` tells of these."""


class Grain(Declaration):
    """One grain."""

    size: float = Field(0.5, gt=0.0, le=2.0)
    """How large it is [m]."""


class Dust(WindPrimitive):
    """A cloud of dust."""

    grains: list[Grain] = Field(default=[])
    """What it is made of."""

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.zeros((len(place), 2), np.float32)


class Odd(Dust):
    """A wind with a key that no schema can describe."""

    thing: Callable[[], int] | None = None


@pytest.fixture
def _own_kinds() -> Iterator[None]:
    wind_kinds.cache_clear()
    yield
    wind_kinds.cache_clear()


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    return described(wind_kinds())[0]


def values(text: str) -> Any:
    return read_document(text, file="<scene>").root.data


def checker(schema: dict[str, Any]) -> Fits:
    check = fastjsonschema.compile(schema, use_default=False)

    def fits(data: object) -> bool:
        try:
            check(data)
        except fastjsonschema.JsonSchemaValueException:
            return False
        return True

    return fits


@pytest.fixture(scope="module")
def fits(schema: dict[str, Any]) -> Fits:
    """Return whether values fit the schema."""
    return checker(schema)


@pytest.mark.parametrize("path", [*bundled_scenes().values(), FULL], ids=lambda path: path.stem)
def test_d4_every_bundled_scene_fits_the_schema(fits: Fits, path: Path) -> None:
    assert fits(values(path.read_text("utf-8")))


@pytest.mark.parametrize("path", BROKEN, ids=[path.stem for path in BROKEN])
def test_d4_the_schema_refuses_the_broken_scenes_that_a_schema_can(fits: Fits, path: Path) -> None:
    try:
        document = read_document(decode(path.read_bytes(), file="<scene>"), file="<scene>")
    except SceneError:
        return  # this is no YAML, and an editor says so by itself
    if not document.problems:
        assert fits(document.root.data) == (path.stem in BEYOND)


def test_a_wind_has_the_keys_of_its_kind(fits: Fits) -> None:
    def scene(wind: str) -> Any:
        return values(f"tallgrass: 2\ngrass: {{ lawn: {{}} }}\nwind: [{wind}]\n")

    assert fits(scene("{ kind: gust, hold: 2 }"))
    assert not fits(scene("{ kind: breeze, hold: 2 }"))
    assert not fits(scene("{ kind: dust }"))
    assert not fits(scene("{ hold: 2 }"))


def test_an_editor_shows_docstrings_with_units_defaults_and_ranges(schema: dict[str, Any]) -> None:
    speed = schema["definitions"]["Gust"]["properties"]["speed"]
    assert speed["description"] == "Speed at which it travels [m/s].\n\nDefault: 8. Range: above 0.1 and at most 60."
    assert schema["properties"]["grass"]["description"] == "Grass kinds by name."
    for name, model in schema["definitions"].items():
        assert model["description"], name
        for field, told in model["properties"].items():
            assert told["description"].endswith((".", ":")), f"{name}.{field}"
            assert "\n" not in told["description"].replace("\n\n", "")


def test_the_schema_is_of_the_draft_that_editors_read(schema: dict[str, Any]) -> None:
    def walk(part: object) -> Iterator[dict[str, Any]]:
        if isinstance(part, dict):
            yield part
            for below in part.values():
                yield from walk(below)
        elif isinstance(part, list):
            for below in part:
                yield from walk(below)

    assert schema["$schema"] == "http://json-schema.org/draft-07/schema#"
    for part in walk(schema):
        assert not {"$defs", "prefixItems", "unevaluatedProperties", "dependentSchemas"} & part.keys()
        assert part.keys() == {"$ref"} or not isinstance(part.get("$ref"), str)


@pytest.mark.usefixtures("_own_kinds")
def test_d1_a_plugin_s_keys_are_in_the_schema() -> None:
    wind("test-dust")(Dust)
    schema, told = described(wind_kinds())
    assert not told
    assert "test-dust" in schema["$comment"]
    assert schema["definitions"]["Grain"]["properties"]["size"]["description"].startswith("How large it is [m].")
    fits = checker(schema)
    scene = "tallgrass: 2\ngrass: {{ lawn: {{}} }}\nwind: [{{ kind: test-dust, grains: [{{ {} }}] }}]\n"
    assert fits(values(scene.format("size: 1")))
    assert not fits(values(scene.format("size: 3")))
    assert not fits(values(scene.format("sise: 1")))


@pytest.mark.usefixtures("_own_kinds")
def test_d1_a_plugin_that_cannot_be_described_costs_no_other() -> None:
    wind("test-odd")(Odd)
    schema, told = described(wind_kinds())
    assert [line.partition(":")[0] for line in told] == ["kind 'test-odd' has no schema, any keys are taken as right"]
    fits = checker(schema)
    scene = "tallgrass: 2\ngrass: {{ lawn: {{}} }}\nwind: [{{ kind: {}, shape: 1 }}]\n"
    assert fits(values(scene.format("test-odd")))
    assert not fits(values(scene.format("gust")))


def test_what_can_be_read_fits_the_schema(fits: Fits) -> None:
    text = (
        "tallgrass: 2\ngrass: { a: { height: [1, 2], place: null } }\nwind: [{ kind: gust, stop: null, start: 1e0 }]\n"
    )
    parse_scene(text)
    assert fits(values(text))
