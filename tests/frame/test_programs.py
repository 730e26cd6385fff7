"""Programs are compiled before the first frame, not when something first happens in a prairie."""

from collections.abc import Callable
from itertools import count
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Blast, Footprint, Gust, Pose, Presser, Tree
from tallgrass.components.shade import Shade
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl import background
from tallgrass.engine.gl.background import BackgroundCompiler
from tallgrass.engine.gl.rasteriser import draws_in_software
from tallgrass.engine.gl.shaders import Texts
from tallgrass.systems.bodies.feature import BodiesPart
from tallgrass.systems.features import UNITS
from tallgrass.systems.frame.feature import Part
from tallgrass.systems.light.draw import LightPart
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.strips.painter import StripsPainter
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.programs import Programs
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

CALM = LITTLE + "wind: [{ kind: breeze, strength: 0.2 }]\n"


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the vertex shaders of all programs that are compiled."""
    made: list[str] = []
    make = moderngl.Context.program

    def noted(self: moderngl.Context, **options: Any) -> moderngl.Program:
        made.append(options["vertex_shader"])
        return make(self, **options)

    monkeypatch.setattr(moderngl.Context, "program", noted)
    return made


def first_cut(prairie: Prairie) -> list[int]:
    prairie.cut(Footprint(radius=4.0), 0.05, pose=Pose(0.0, 10.0))
    return []


def first_clear(prairie: Prairie) -> list[int]:
    prairie.clear(Footprint(radius=4.0), pose=Pose(0.0, 10.0))
    return []


def first_presser(prairie: Prairie) -> list[int]:
    del prairie
    return [esper.create_entity(Presser(radius=0.5), Pose(0.0, 10.0))]


def first_shadow(prairie: Prairie) -> list[int]:
    del prairie
    return [esper.create_entity(Shade((0.0, 3.0, 10.0), 1.0))]


def first_gust(prairie: Prairie) -> list[int]:
    return [prairie.add(Gust(position=[0.0, 20.0], strength=1.0))]


@pytest.mark.usefixtures("ahead", "unpictured")
def test_nothing_that_happens_to_grass_or_trees_for_the_first_time_makes_a_program(
    made: list[str], load: Load, stage: Stage, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    prairie, there = load(CALM + "trees: { ash: { habit: birch, height: [9, 9] } }\n"), camera(0.0, 2.0, 18.0)
    stage.shot(prairie, there)
    prairie.advance(1.0)
    for _ in range(1 if draws_in_software(stage.ctx) else 400):  # a card makes them beside frames
        first = len(made)
        stage.shot(prairie, there)
    assert len(made) == first > 10
    made.clear()
    calm = prairie.state()
    for happens in (first_cut, first_clear, first_presser, first_shadow, first_gust):
        prairie.restore(calm)
        before = stage.shot(prairie, there)
        entities = happens(prairie)
        prairie.advance(0.2)
        after = stage.shot(prairie, there)
        for entity in entities:
            esper.delete_entity(entity, immediate=True)
        assert np.abs(after - before).max() > 20.0, happens
        assert made == [], happens
    for name in ("render", "transform"):  # what trees look like does not matter here
        monkeypatch.setattr(moderngl.VertexArray, name, lambda *_, **__: None)
    tree = esper.create_entity(Tree("ash", height=9.0), Pose(0.0, -15.0))
    for z in (18.0, -10.0, -13.0):  # its picture gives way to twigs on cards, and these to leaves
        stage.shot(prairie, camera(0.0, 2.0, z))
        assert made == [], z
    esper.delete_entity(tree, immediate=True)


@pytest.mark.usefixtures("ahead", "undrawn")
def test_what_trees_and_bodies_are_drawn_with_can_be_made_before_the_first_of_them_is_there(
    made: list[str], load: Load, stage: Stage, camera: Aim
) -> None:
    prairie = load(CALM)
    stage.shot(prairie, camera(0.0, 2.0, 18.0))
    painter = prairie.painter
    assert painter is not None
    made.clear()
    bodies = painter.part(BodiesPart)
    assert not [*bodies.texts()]
    assert not [*bodies.making()], "nothing may fly"
    prairie.add(Blast(start=1e4, body="saucer"))
    assert len([*bodies.making()]) == len(made) == 2
    painter.block.defines = {**painter.block.defines, "TREES": 1}
    trees = Programs(stage.ctx, painter.block, UNITS)
    texts = [each.vertex for each in trees.texts(in_rows=False)]
    made.clear()
    steps = len([*trees.making(in_rows=False)])
    assert steps == len(made) > len(texts) > 8
    assert made[: len(texts)] == texts, "as a driver is asked for them beside the frames"
    assert [*trees.making(in_rows=False), *trees.texts(in_rows=False), *bodies.texts()] == []
    trees.release()
    assert TreePart.making is not Part.making


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Vertex shaders of all programs given to a pretended driver, which finishes one between two polls."""
    asked: list[str] = []
    looks = count()

    def start(_: BackgroundCompiler, texts: Texts) -> None:
        asked.append(texts.vertex)

    monkeypatch.setattr(background, "draws_in_software", lambda _: False)
    monkeypatch.setattr(BackgroundCompiler, "start", start)
    monkeypatch.setattr(BackgroundCompiler, "pending", property(lambda _: max(0, len(asked) - next(looks))))
    return asked


@pytest.mark.usefixtures("ahead")
def test_a_card_makes_beside_the_frames_what_the_first_does_not_draw_with(
    made: list[str], asked: list[str], load: Load, stage: Stage, camera: Aim
) -> None:
    prairie, there = load(CALM), camera(0.0, 2.0, 18.0)
    first = stage.shot(prairie, there)
    drawn = len(made)
    for frame in range(3):  # it is asked for one a frame
        np.testing.assert_array_equal(stage.shot(prairie, there), first)
        assert (len(asked), len(made)) == (frame + 1, drawn)
    for _ in range(108):
        before = len(asked), len(made)
        stage.shot(prairie, there)
        assert len(asked) + len(made) <= sum(before) + 1
    assert made[drawn : drawn + len(asked)] == asked
    assert len(asked) > 5
    made.clear()
    first_cut(prairie)
    assert np.abs(stage.shot(prairie, there) - first).max() > 20.0
    assert made == []


@pytest.mark.usefixtures("ahead")
@pytest.mark.parametrize("fails", [LightPart, StripsPainter])
def test_a_first_frame_that_fails_says_why_and_leaves_nothing_that_cannot_be_released(
    stage: Stage, load: Load, monkeypatch: pytest.MonkeyPatch, fails: type
) -> None:
    def settle(*_: object) -> None:
        raise RuntimeError("the driver refuses this")

    prairie = load(CALM, live=False)
    monkeypatch.setattr(fails, "settle", settle)
    with pytest.raises(RuntimeError, match="the driver refuses this"):
        stage.shot(prairie)
    prairie.release()


@pytest.mark.usefixtures("undrawn")
def test_a_game_that_prepares_with_a_card_waits_for_each_program_in_a_step(asked: list[str], load: Load) -> None:
    steps = list(load(CALM).preparing())
    assert len(asked) > 5
    assert [done for done, _ in steps] == sorted(done for done, _ in steps)
    assert steps[-1][0] == steps[-1][1]


@pytest.mark.usefixtures("ahead")
def test_where_nobody_waits_for_the_next_frame_programs_are_made_as_they_are_drawn(
    made: list[str], load: Load, stage: Stage, camera: Aim
) -> None:
    film, there = load(CALM, live=False), camera(0.0, 2.0, 18.0)
    stage.shot(film, there)
    first = len(made)
    stage.shot(film, there)
    assert len(made) == first > 10
    film.cut(Footprint(radius=4.0), 0.05, pose=Pose(0.0, 10.0))
    cut = stage.shot(film, there)
    assert len(made) > first
    game = load(CALM)
    game.cut(Footprint(radius=4.0), 0.05, pose=Pose(0.0, 10.0))
    np.testing.assert_array_equal(stage.shot(game, there), cut)
