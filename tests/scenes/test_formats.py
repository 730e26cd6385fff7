"""Scenes of all formats: their meaning never changes.

A folder `format-N` has scenes of format N, each with a file of its meaning, which later releases must read, too:
keys may be added with their defaults, but none may go, and no value may change.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel

from tallgrass.engine.declared.plant import Head
from tallgrass.engine.declared.scene import FORMAT, Scene
from tallgrass.engine.declared.tree import TreeKind
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.scene import parse_scene
from tallgrass.engine.scene.compose import read_document

OLD = sorted(Path(__file__).parent.glob("format-*/*.yaml"))


def lost(meant: object, read: object, where: str = "") -> Iterator[str]:
    """Yield the values of a scene's recorded meaning that are lost or changed."""
    if isinstance(meant, dict) and isinstance(read, dict):
        for key, value in meant.items():
            if key in read:
                yield from lost(value, read[key], f"{where}.{key}")
            else:
                yield f"{where}.{key}: gone"
    elif isinstance(meant, list) and isinstance(read, list) and len(meant) == len(read):
        for number, (one, other) in enumerate(zip(meant, read, strict=True)):
            yield from lost(one, other, f"{where}[{number}]")
    elif meant != read:
        yield f"{where}: {meant} became {read}"


def fields(model: type[BaseModel]) -> set[str]:
    return set(model.model_fields)


def test_d4_there_is_a_scene_of_every_format() -> None:
    assert {path.parent.name for path in OLD} == {f"format-{version}" for version in range(1, FORMAT + 1)}


@pytest.mark.parametrize("path", OLD, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_d4_a_scene_of_any_format_means_what_it_always_meant(path: Path) -> None:
    meant = json.loads(path.with_suffix(".json").read_text("utf-8"))
    scene = parse_scene(path.read_text("utf-8"), file=str(path))
    told = scene.model_dump(mode="json")
    assert list(lost({**meant, "tallgrass": FORMAT}, told)) == []


def test_what_a_scene_loses_is_told() -> None:
    assert list(lost({"a": [{"b": 1, "c": 2}]}, {"a": [{"b": 3}], "d": 4})) == [".a[0].b: 1 became 3", ".a[0].c: gone"]
    assert list(lost([1], [1, 2])) == [": [1] became [1, 2]"]


def test_the_scene_of_todays_format_uses_every_key() -> None:
    path = Path(__file__).parent / f"format-{FORMAT}" / "full.yaml"
    values: Any = read_document(path.read_text("utf-8"), file="full.yaml").root.data
    scene = parse_scene(path.read_text("utf-8"))
    assert values.keys() == fields(Scene)
    for part in ("camera", "light", "quality"):
        assert values[part].keys() == fields(type(getattr(scene, part)))
    assert values["terrain"].keys() == fields(type(scene.terrain)) - {"heights", "holes", "window"}
    for part in ("pressers", "lamps"):
        assert values[part][0].keys() == fields(type(getattr(scene, part)[0]))
    assert values["trees"]["ash"].keys() == fields(TreeKind)
    assert values["grass"]["tall"].keys() | values["grass"]["poppy"].keys() == fields(type(scene.grass["tall"]))
    assert values["grass"]["poppy"]["head"].keys() == fields(Head)
    used = {declared["kind"]: declared.keys() for declared in reversed(values["wind"])}
    assert used == {kind: fields(wind_kinds().find(kind)) for kind in used}
    assert set(used) >= {"breeze", "gust", "whirlwind", "blast", "turbulence"}
