"""Grass below trees: it grows as it gets light, in all representations, and again once they are felled (F3, F4)."""

from collections.abc import Iterator
from typing import Literal

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Pose, Prairie, Tree
from tallgrass.engine.declared.quality import LodName
from tallgrass.systems.trees import fading
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.shade import SIDE, SIDES
from tallgrass.testing import Stage, little_prairie, looking, private_world

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: flat, size: [80, 80] }
grass: { turf: { height: [0.2, 0.3], width: 0.02, blades: 1500, root: "#1fa01f", tip: "#1fa01f", understorey: 0.0 } }
trees: { tree: { habit: hawthorn, height: [12, 12] } }  # a habit whose pictures other tests draw too
wind: [{ kind: breeze, strength: 0.2, speed: 4 }]
light: { azimuth: 90, elevation: 60, haze: 1e6, ground: "#e01010" }
"""
COARSE = """\
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 2, strips: 2, texel: 0.05 }]
  carpet_to: 16
  carpet: 64
  coarse: true
"""
OVER = looking(0.0, 12.0, 14.0, pitch=-40.0, view=20.0)


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (96, 96))


@pytest.fixture
def prairie(ctx: moderngl.Context, request: pytest.FixtureRequest) -> Iterator[Prairie]:
    param: LodName | Literal["coarse"] | None = getattr(request, "param", None)
    lod: LodName = "blades" if param is None else "carpet" if param == "coarse" else param
    scene = SCENE if param else SCENE.replace("blades: 1500", "blades: 60")  # where none is looked at
    if param == "coarse":
        scene = SCENE.replace("blades: 1500", "blades: 400") + COARSE
    with private_world(), little_prairie(scene=scene, ctx=ctx, lod=lod) as made:
        yield made


def dense(prairie: Prairie, x: float, z: float) -> float:
    return float(prairie.grass_at(np.array([[x, z]], np.float32)).density[0, 0])


def test_f3_as_much_grows_below_a_tree_as_it_leaves_of_the_light(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fading, "DURATION", 0.0)
    esper.create_entity(Tree("tree", 12.0), Pose(3.0, 0.0))
    half_bare = esper.create_entity(Tree("tree", 12.0, foliage=0.5), Pose(-25.0, 0.0))
    stage.shot(prairie, OVER)
    assert 0.2 < dense(prairie, 5.0, 0.0) < dense(prairie, -23.0, 0.0) < 0.7
    along = [dense(prairie, 3.0 + off, 0.0) for off in (0.0, 2.0, 5.0)]
    assert along == sorted(along)
    assert along[-1] < dense(prairie, 3.0, 20.0) == 1.0
    esper.delete_entity(half_bare, immediate=True)
    stage.shot(prairie, OVER)
    assert dense(prairie, -25.0, 0.0) == dense(prairie, -23.0, 0.0) == 1.0


def test_f3_pixels_know_how_much_grows_as_systems_do(stage: Stage, prairie: Prairie) -> None:
    for x, height in ((3.0, 12.0), (10.0, 5.0), (-14.0, 2.0)):
        esper.create_entity(Tree("tree", height), Pose(x, 0.0))
    stage.shot(prairie, OVER)
    assert prairie.painter is not None
    texture = vars(vars(prairie.painter.part(TreePart))["_shade"])["_texture"]
    texels = np.frombuffer(texture.read(), np.float16).reshape(SIDE, 3, SIDE, 2)[:, 2, :, 1].astype(np.float64)
    middle = (np.arange(SIDE) + 0.5) / SIDE * SIDES[2] - SIDES[2] / 2.0
    near = np.abs(middle) < 30.0
    place = np.stack(np.meshgrid(middle[near], middle[near]), axis=-1).reshape(-1, 2).astype(np.float32)
    left = prairie.site.ground.density.crowns.left_at(place)
    assert left is not None
    told = 0.15 + 0.85 * np.exp(-texels[np.ix_(near, near)].ravel())
    assert left.min() < 0.4
    np.testing.assert_allclose(told, left, atol=0.01)


def test_f4_below_a_felled_tree_grass_comes_back_into_the_sun_by_and_by(stage: Stage, prairie: Prairie) -> None:
    tree = esper.create_entity(Tree("tree", 12.0), Pose(0.0, 0.0))
    stage.shot(prairie, OVER)
    esper.delete_entity(tree, immediate=True)
    dense_then, light_then = [], []
    for _ in range(6):
        light_then.append(stage.shot(prairie, OVER)[40:56, 40:56].mean())
        dense_then.append(dense(prairie, 2.5, 0.0))
        prairie.advance(fading.DURATION / 4.0)
    assert dense_then[0] < 0.45
    assert dense_then == sorted(dense_then)
    assert max(np.diff(dense_then)) < 0.4
    assert dense_then[4:] == [1.0, 1.0]
    assert light_then[0] < 0.75 * light_then[4]
    assert max(np.diff(light_then)) < 0.6 * (light_then[4] - light_then[0])


@pytest.mark.parametrize(
    "prairie",
    [None, "coarse", *(pytest.param(lod, marks=pytest.mark.slow) for lod in ("strips", "carpet"))],
    indirect=True,
)
def test_f4_grass_in_every_representation_lies_in_a_trees_shade(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(TreePart, "draw_solid", lambda _: 0)
    monkeypatch.setattr(TreePart, "draw_soft", lambda *_: 0)
    in_the_sun = stage.shot(prairie, OVER)[..., 1]
    tree = esper.create_entity(Tree("tree", 12.0), Pose(7.0, 0.0))  # towards the sun
    shaded = stage.shot(prairie, OVER)[..., 1]
    esper.delete_entity(tree, immediate=True)
    green = in_the_sun > 0.5 * in_the_sun.max()
    assert green.mean() > 0.02
    assert shaded[green].mean() < 0.6 * in_the_sun[green].mean()  # without its shadow it is 0.68, as it hides sky


@pytest.mark.slow
@pytest.mark.parametrize("prairie", ["blades", "strips", "carpet"], indirect=True)
def test_f4_more_soil_is_seen_below_a_tree_in_every_representation_and_less_once_it_is_felled(
    stage: Stage, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fading, "DURATION", 0.0)
    monkeypatch.setattr(TreePart, "draw_solid", lambda _: 0)
    monkeypatch.setattr(TreePart, "draw_soft", lambda *_: 0)
    open_ground = stage.shot(prairie, OVER)
    tree = esper.create_entity(Tree("tree", 12.0), Pose(0.0, 0.0))
    below = stage.shot(prairie, OVER)
    esper.delete_entity(tree, immediate=True)
    assert np.array_equal(stage.shot(prairie, OVER), open_ground)
    red = [float((each[..., 0] / each[..., :2].sum(axis=-1))[24:72, 24:72].mean()) for each in (open_ground, below)]
    assert red[1] == pytest.approx(0.84, abs=0.02)  # soil is red, and grass green
    assert 0.64 < red[0] < 0.74  # from above, strips hide less of it
