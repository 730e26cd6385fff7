"""Pictures of kinds of grass that a game changes (F4, X5)."""

import json
from collections.abc import Callable
from itertools import pairwise
from threading import Event
from time import sleep
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass.engine.camera import Camera
from tallgrass.systems import ripen
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.blades import representation
from tallgrass.systems.show.blades.plant import carry_blades
from tallgrass.systems.site import Site, ripened
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

SCENE = LITTLE + "wind: [{ kind: breeze, strength: 0.4 }]\n"
TALL = "height: [0.5, 0.9], width: 0.02"
HIGHER: dict[str, Any] = {"height": [0.9, 1.3], "width": 0.012, "blades": 90}
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
    """Programs that are compiled during the test."""
    made: list[object] = []
    make = moderngl.Context.program

    def noted(ctx: moderngl.Context, *args: object, **named: object) -> moderngl.Program:
        made.append(make(ctx, *args, **named))  # type: ignore[arg-type]
        return made[-1]  # type: ignore[return-value]

    monkeypatch.setattr(moderngl.Context, "program", noted)
    return made


def make_rare(prairie: Any) -> None:
    """Compile the carpet's program for changing grass, as a live prairie does before its first frame."""
    carpet = prairie.painter.painters.get("carpet")
    if carpet is not None:
        assert carpet.ground.carpet["all"].program


@pytest.mark.parametrize("lod", ["blades", pytest.param("strips", marks=pytest.mark.slow), "carpet"])
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


def of(**keys: object) -> str:
    """Return the scene without wind, with other keys of its tall grass."""
    told = {"height": [0.5, 0.9], "width": 0.02, **keys}
    return LITTLE.replace(TALL, ", ".join(f"{key}: {json.dumps(value)}" for key, value in told.items()))


@pytest.mark.parametrize(
    "lod", ["blades", *(pytest.param(lod, marks=pytest.mark.slow) for lod in ("strips", "carpet")), "auto"]
)
def test_f4_plants_come_in_one_by_one_until_all_are_those_of_a_scene_that_had_them_from_the_start(
    stage: Stage, load: Load, camera: Aim, programs: list[object], lod: str
) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-12), load(LITTLE, lod=lod, live=False)
    story = [stage.shot(played, aim)]
    make_rare(played)
    before = played.grass_at([(3.0, 3.0)]).height[0]
    programs.clear()
    played.change_kind("tall", over=2.0, **HIGHER)
    heights = []
    for _ in range(9):
        played.advance(0.25)
        story.append(stage.shot(played, aim))
        heights.append(float(played.grass_at([(3.0, 3.0)]).height[0]))
    assert not programs, "nothing is compiled"
    due = load(of(**HIGHER), lod=lod, live=False)
    due.advance(2.25)
    last = stage.shot(due, aim)
    np.testing.assert_array_equal(story[-1], last)
    away = [float(np.abs(each - last).mean()) for each in story]
    assert away[0] > 1.5
    assert heights == sorted(heights)
    assert heights[0] < before + 0.2 * (heights[-1] - before)
    if lod != "carpet":  # from near by, what the carpet shows lies elsewhere as it rises
        assert away[1:] == sorted(away[1:], reverse=True)
        steps = [float(np.abs(one - other).mean()) for one, other in pairwise(story)]
        assert max(steps) < 0.5 * away[0]


def test_f4_grass_withers_where_no_plant_had_other_organs_before(stage: Stage, load: Load, camera: Aim) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-12), load(LITTLE, live=False)
    first = stage.shot(played, aim)
    played.change_kind("tall", withered=0.5, over=1.0)
    played.advance(0.5)
    between = stage.shot(played, aim)
    played.advance(0.5)
    due = load(of(withered=0.5), live=False)
    due.advance(1.0)
    last = stage.shot(due, aim)
    np.testing.assert_array_equal(stage.shot(played, aim), last)
    assert np.abs(between - last).mean() < 0.8 * np.abs(first - last).mean()


def test_f4_a_state_brings_plants_back_that_are_coming_in_to_the_bit(stage: Stage, load: Load, camera: Aim) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-12), load(SCENE, live=False)
    stage.shot(played, aim)
    played.change_kind("tall", over=3.0, tip="#ffffff", **HIGHER)
    played.advance(1.0)
    stage.shot(played, aim)
    played.change_kind("short", over=0.5, height=[0.5, 0.6])  # waits for the other
    state = played.state()
    other = load(SCENE, live=False)
    other.restore(state)
    for later in (0.0, 1.0, 1.25, 1.5):
        played.advance(later)
        other.advance(later)
        np.testing.assert_array_equal(stage.shot(other, aim), stage.shot(played, aim))
    assert other.scene.grass == played.scene.grass
    assert played.scene.grass["short"].height == [0.5, 0.6]


def test_f4_no_frame_waits_for_what_has_to_grow(
    stage: Stage, load: Load, camera: Aim, programs: list[object], monkeypatch: pytest.MonkeyPatch
) -> None:
    aim, played = camera(0.0, 4.0, 18.0, pitch=-12), load(LITTLE)
    before = stage.shot(played, aim)
    make_rare(played)
    may_grow = Event()

    def slowly(*known: Any) -> Site:
        assert may_grow.wait(60.0)
        return ripened(*known)

    monkeypatch.setattr(ripen, "ripened", slowly)
    programs.clear()
    played.change_kind("tall", over=1.0, **HIGHER)
    for _ in range(3):
        played.advance(0.5)
        np.testing.assert_array_equal(stage.shot(played, aim), before)
    may_grow.set()
    frames = 0
    while played.scene.grass["tall"].height != HIGHER["height"]:
        frames += 1
        assert frames < 2000, "it never comes"
        sleep(0.01)
        played.advance(0.05)
        after = stage.shot(played, aim)
    assert frames > 20, "it takes its second, once it is there"
    assert not programs
    assert np.abs(after - before).mean() > 1.5


def test_f4_the_frame_that_draws_other_blades_first_finds_them_where_they_stand(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    played, carried = load(LITTLE, lod="blades"), list[object]()
    carry = carry_blades

    def noted(*args: Any) -> None:
        carried.append(carry(*args))

    monkeypatch.setattr(representation, "carry_blades", noted)
    way = [camera(0.0, 4.0, 18.0 - 0.3 * (step % 100), pitch=-12) for step in range(3000)]
    stage.shot(played, way[0])
    played.change_kind("tall", **HIGHER)
    gone = [way[0]]
    for aim in way:
        before, count = played.site.representations, len(carried)
        gone.append(aim)
        seen = stage.shot(played, aim)
        if played.site.representations is not before:
            break
        sleep(0.01)
    assert count == len(carried) == 1
    other = load(of(**HIGHER), lod="blades", live=False)
    due = [stage.shot(other, aim) for aim in gone]
    np.testing.assert_array_equal(seen, due[-1])
