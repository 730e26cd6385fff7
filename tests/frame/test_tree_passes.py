"""What each pass of trees draws, and what its calls are told (F3, N6)."""

import dataclasses
from collections.abc import Iterator, Sequence
from ctypes import addressof, c_int

import moderngl
import numpy as np
import pytest

from tallgrass import Prairie
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.functions import functions_of
from tallgrass.systems.painter import CRESTS_FROM
from tallgrass.systems.show.carpet.painter import CarpetPainter
from tallgrass.systems.trees import call
from tallgrass.systems.trees.call import DrawCall, Pass, draw
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.habit import NEEDLES
from tallgrass.systems.trees.programs import HARD, SOFT
from tallgrass.systems.trees.stream import CARDS, WOOD, Uniforms
from tallgrass.systems.trees.wood import CLOSED
from tallgrass.testing import Stage, little_prairie, looking, private_world
from tallgrass.testing.little import SPARSE

SCENE = (
    SPARSE
    + """\
seed: 5
terrain: { noise: flat, size: [80, 80] }
grass: { turf: { height: [0.05, 0.08], width: 0.02, blades: 30, place: none } }
trees:
  thorn: { habit: hawthorn, positions: [[0, 0], [6, -2], [-7, -3]] }
  birch: { habit: birch, positions: [[3, -8], [-4, -9]] }
light: { azimuth: 130, elevation: 40, haze: 1e6, clouds: 0 }
"""
)
SIZE = 96
FAR_OFF = looking(0.0, 2.0, 34.0, pitch=3.0, view=20.0)
AS_CARDS = looking(0.0, 2.0, 20.0, pitch=3.0, view=10.0)
NEAR_BY = looking(0.0, 1.7, 6.0, pitch=4.0, view=50.0)
NOTHING_IS_OPAQUE = 2.0
LIKE, MUCH = 8.0, 40.0  # of 255
A_LITTLE = 0.02  # coverage
CLEAR_COLOUR = 0x0C22  # GL_COLOR_CLEAR_VALUE


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (SIZE, SIZE))


@pytest.fixture(scope="module")
def prairie(ctx: moderngl.Context, stage: Stage) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        stage.shot(made, FAR_OFF)
        yield made


def asked_for(
    stage: Stage, prairie: Prairie, ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, opaque_from: float
) -> int:
    """Return of how many pixels soft edges are asked for, as all of them are drawn where nothing of them is opaque."""
    assert prairie.painter is not None
    part, query = prairie.painter.part(TreePart), ctx.query(samples=True)

    def draw_soft(beyond: float) -> int:
        del beyond
        with monkeypatch.context() as meanwhile, query:
            meanwhile.setattr("tallgrass.systems.trees.call.CLOSED", NOTHING_IS_OPAQUE)
            vars(part)["_calls"].clear()
            part.begin_soft()
            return TreePart.draw_soft(part)

    with monkeypatch.context() as meanwhile:
        meanwhile.setattr("tallgrass.systems.trees.call.CLOSED", opaque_from)
        meanwhile.setattr(part, "draw_soft", draw_soft)
        vars(part)["_calls"].clear()
        stage.shot(prairie, FAR_OFF)
    vars(part)["_calls"].clear()
    return int(query.samples)


def test_n6_where_a_far_tree_is_opaque_nobody_asks_for_its_soft_edges(
    stage: Stage, prairie: Prairie, ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    everything = asked_for(stage, prairie, ctx, monkeypatch, NOTHING_IS_OPAQUE)
    edges = asked_for(stage, prairie, ctx, monkeypatch, CLOSED)
    assert 0 < edges < 0.8 * everything


def test_what_is_told_only_once_is_what_each_call_would_be_told(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Calls leave out what those before them have told and bound."""

    def each_alone(calls: Sequence[DrawCall], numbers: Uniforms) -> int:
        for one in calls:
            for told, *_ in one.state.uniforms:
                told[0] = None
        return sum(draw([one], numbers) for one in calls)

    first = stage.shot(prairie, FAR_OFF)
    assert prairie.painter is not None
    monkeypatch.setattr("tallgrass.systems.trees.draw.draw", each_alone)
    np.testing.assert_array_equal(stage.shot(prairie, FAR_OFF), first)


def test_nothing_that_casts_a_shadow_is_told_that_it_is_farther_off_than_it_is(stage: Stage, prairie: Prairie) -> None:
    """In a picture wood is, as it hides leaves."""
    stage.shot(prairie, looking(0.0, 1.7, 4.0, pitch=4.0, view=12.0))
    assert prairie.painter is not None
    calls = vars(prairie.painter.part(TreePart))["_calls"]

    def behind(*, casts: bool) -> list[object]:
        told = [(one.state, one.state.array.program.extra.get("behind")) for one in calls.of_pass(Pass(HARD, casts))]
        return [value for state, own in told for each, value, _ in state.uniforms if each is own]

    assert behind(casts=False)
    assert behind(casts=True) == [(0.0,)] * len(behind(casts=False))


@pytest.mark.parametrize(("off", "behind"), [(34.0, False), (2.0 * CRESTS_FROM, True)])
def test_thin_grass_on_crests_is_drawn_over_edges_of_trees_far_off_and_under_those_nearer(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch, off: float, *, behind: bool
) -> None:
    stage.shot(prairie, eye := looking(0.0, 2.0, off, pitch=1.0, view=600.0 / off))
    assert prairie.painter is not None
    part, draw_thin, done = prairie.painter.part(TreePart), CarpetPainter.draw_thin, list[bool]()

    def draw_thin_noting(painter: CarpetPainter, target: moderngl.Framebuffer) -> int:
        done.append(part.soft_distance() is None)
        return draw_thin(painter, target)

    monkeypatch.setattr(CarpetPainter, "draw_thin", draw_thin_noting)
    stage.shot(prairie, eye)
    assert done == [behind]
    assert part.soft_distance() is None


def test_soft_edges_are_blended_from_far_to_near_whichever_kind_is_told_first(stage: Stage, prairie: Prairie) -> None:
    first = stage.shot(prairie, FAR_OFF)
    assert prairie.painter is not None
    calls = vars(prairie.painter.part(TreePart))["_calls"]
    batches = vars(calls)["_batches"]
    calls.choose(sorted(batches, key=lambda batch: -batch.model))
    np.testing.assert_array_equal(stage.shot(prairie, FAR_OFF), first)
    calls.choose(batches)


def test_needles_are_blended_over_the_stems_that_bear_them(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage.shot(prairie, AS_CARDS)
    assert prairie.painter is not None
    part = vars(prairie.painter.part(TreePart))
    for kind in part["_kinds"]:
        needles = dataclasses.replace(kind.habit.leaf, form=NEEDLES)
        monkeypatch.setattr(kind, "habit", dataclasses.replace(kind.habit, leaf=needles))
    of_stems, of_needles = dict[int, list[float]](), dict[int, list[float]]()
    for batch in vars(part["_calls"])["_batches"]:
        _, model = vars(part["_calls"])["_models"][batch.model]
        ordered = of_stems if batch.name in model.wood else of_needles if batch.name in CARDS else None
        drawn = vars(call.Calls)["_call"](part["_calls"], batch, Pass(SOFT))
        if ordered is not None and drawn is not None:
            ordered.setdefault(batch.model, []).append(drawn.order)
    both = of_stems.keys() & of_needles.keys()
    assert both
    assert all(max(of_stems[model]) < min(of_needles[model]) for model in both)
    calls = part["_calls"]
    calls.choose([batch for batch in part["_batches"] if batch.name not in CARDS])  # all twigs are out of the picture
    assert any(
        batch.name.startswith(WOOD) and vars(call.Calls)["_call"](calls, batch, Pass(SOFT))
        for batch in vars(calls)["_batches"]
    )
    calls.choose(part["_batches"])
    calls.clear()


def test_d6_maps_of_shade_leave_the_clear_colour_of_a_host_that_sets_it_once(
    stage: Stage, prairie: Prairie, ctx: moderngl.Context
) -> None:
    stage.begin()
    stage.target.clear(1.0, 1.0, 1.0, 1.0)
    prairie.draw(*stage.matrices(looking(8.0, 2.0, 30.0)), viewer="elsewhere")  # maps of shade lie about the viewer
    found = (c_int * 4)()
    functions_of(ctx).glGetIntegerv(CLEAR_COLOUR, addressof(found))
    assert min(found) > 0


def test_nothing_of_trees_is_made_in_a_scene_without_any(ctx: moderngl.Context, stage: Stage) -> None:
    with private_world(), little_prairie(ctx=ctx) as without:
        stage.shot(without, FAR_OFF)
        assert without.painter is not None
        assert "TREES" not in without.painter.block.defines
        made = vars(without.painter.part(TreePart))
        assert (made["_programs"], made["_shade"], made["_kinds"]) == (None, None, [])


@pytest.mark.parametrize("camera", [FAR_OFF, NEAR_BY])
def test_n6_what_covers_pixels_wholly_is_all_within_its_own_outline(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch, camera: Camera
) -> None:
    assert prairie.painter is not None
    part = vars(prairie.painter.part(TreePart))
    seen = stage.shot(prairie, camera)
    for kind in part["_kinds"]:
        assert area_of(kind.solid_outline) < area_of(kind.outline)
        monkeypatch.setattr(kind, "solid_outline", kind.outline)
        for model in kind.models:
            assert np.mean(model.solid_outline.reaches) < np.mean(model.outline.reaches)
            monkeypatch.setattr(model, "solid_outline", model.outline)
    part["_calls"].clear()
    apart = np.abs(np.asarray(stage.shot(prairie, camera), np.float64) - seen).max(axis=-1)
    part["_calls"].clear()
    assert not (apart > LIKE).any()


@pytest.mark.parametrize("camera", [FAR_OFF, NEAR_BY])
def test_what_the_opaque_pass_finds_a_little_too_faint_is_drawn_as_a_soft_edge(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch, camera: Camera
) -> None:
    """A card interpolates within each pass's own outline, and rounds differently there."""
    assert prairie.painter is not None
    part, made = vars(prairie.painter.part(TreePart)), vars(call.Calls)["_state"]

    def state(calls: call.Calls, number: int, name: str, how: Pass) -> call.State:
        with monkeypatch.context() as meanwhile:
            if how.edges == HARD:
                kind, _ = vars(calls)["_models"][number]
                meanwhile.setattr(kind, "solid", kind.solid + A_LITTLE)
                meanwhile.setattr(call, "CLOSED", CLOSED + A_LITTLE)
            again: call.State = made(calls, number, name, how)
        return again

    seen = stage.shot(prairie, camera)
    monkeypatch.setattr(call.Calls, "_state", state)
    part["_calls"].clear()
    apart = np.abs(np.asarray(stage.shot(prairie, camera), np.float64) - seen).max(axis=-1)
    part["_calls"].clear()
    assert apart.max() > 0.0
    assert apart.max() < MUCH


def area_of(corners: list[tuple[float, float]]) -> float:
    """Return the area within an outline whose corners are left and right in turn."""
    left, right = np.array(corners[::2]), np.array(corners[1::2])
    around = np.concatenate([left, right[::-1]])
    x, y = around.T
    return abs(0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()))
