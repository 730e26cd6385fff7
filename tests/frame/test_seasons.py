"""Kinds of grass that a game changes, as they are seen (F4, X5)."""

import json
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

SCENE = LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n"
AUTUMN: dict[str, Any] = {
    "root": "#5a2a1c",
    "tip": "#e08a3a",
    "variety": 0.4,
    "translucency": 0.4,
    "gloss": 0.3,
    "understorey": 0.2,
}


@pytest.fixture
def programs(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """The programs that are made from now on."""
    made: list[object] = []
    make = moderngl.Context.program

    def noted(ctx: moderngl.Context, *args: object, **named: object) -> moderngl.Program:
        made.append(make(ctx, *args, **named))  # type: ignore[arg-type]
        return made[-1]  # type: ignore[return-value]

    monkeypatch.setattr(moderngl.Context, "program", noted)
    return made


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
def test_f4_colours_that_have_eased_are_those_of_a_scene_that_had_them_from_the_start(
    stage: Stage, load: Load, camera: Aim, programs: list[object], lod: str
) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-12), load(SCENE, lod=lod, live=False)
    first = stage.shot(played, aim)
    programs.clear()
    played.change_kind("tall", over=2.0, **AUTUMN)
    np.testing.assert_array_equal(stage.shot(played, aim), first)
    story = []
    for _ in range(5):
        played.advance(0.5)
        story.append(stage.shot(played, aim))
    assert not programs, "nothing is compiled"
    other = load(SCENE, lod=lod, live=False)
    other.change_kind("tall", **AUTUMN)
    other.advance(2.5)
    kind = other.scene.grass["tall"].model_copy(update=AUTUMN)
    told = ", ".join(f"{key}: {json.dumps(value)}" for key, value in AUTUMN.items())
    text = SCENE.replace('root: "#5a5a2c", tip: "#dcc98f"', told)
    due = load(text, lod=lod, live=False)
    due.advance(2.5)
    assert due.scene.grass["tall"] == kind
    np.testing.assert_array_equal(story[-1], stage.shot(due, aim))
    np.testing.assert_array_equal(stage.shot(other, aim), story[-1])
    changes = [float(np.abs(after - story[-1]).mean()) for after in (first, *story[:3])]
    assert changes == sorted(changes, reverse=True)
    assert changes[0] > 2.0
