"""Mown grass in frames: cut to the same height in all representations, and nothing else changed (F4)."""

from collections.abc import Callable
from math import inf
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Footprint, Pose, Presser
from tallgrass.components.arrays import Doubles
from tallgrass.engine.camera import Camera
from tallgrass.systems.mow.card import PlotsPart
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

FLAT = LITTLE.replace("scale: 4", "scale: 0")
LAWN = FLAT.replace("short: { height: [0.2, 0.4]", "short: { height: [0.5, 0.9]").replace("blades: 60", "blades: 400")

MEADOW = """\
tallgrass: 2
terrain: { noise: flat, size: [100, 100] }
grass: { lawn: { height: [0.25, 0.5] } }
light: { azimuth: 130, elevation: 40 }
quality:
  blades: 160
  models: 1
  blade_rings: [{ to: 8, segments: 3 }]
  strip_rings: [{ to: 12, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 24
  carpet: 32
"""
ALL = Footprint(radius=90.0)
KEPT = ["blades", "strips", "carpet", "auto"]


def above_horizon(picture: Doubles) -> Doubles:
    return picture[: len(picture) // 2]


@pytest.mark.parametrize("lod", KEPT)
def test_f4_grass_stands_as_high_as_it_was_cut_and_no_higher(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    prairie, seen = load(FLAT, lod=lod), {}
    for height in (0.0, 0.25):
        prairie.cut(ALL, 0.0)
        prairie.grow(ALL, height)
        for eye in (0.15, 0.45):
            seen[height, eye] = above_horizon(stage.shot(prairie, camera(0.0, eye, 20.0)))
    np.testing.assert_array_equal(seen[0.25, 0.45], seen[0.0, 0.45])
    assert (np.abs(seen[0.25, 0.15] - seen[0.0, 0.15]).max(axis=2) > 20.0).mean() > 0.01


@pytest.mark.parametrize("lod", KEPT)
def test_f4_only_what_lies_under_the_footprint_is_cut(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    prairie, aim = load(LAWN, lod=lod), camera(0.0, 12.0, 12.0, pitch=-50)
    before = stage.shot(prairie, aim)
    prairie.cut(Footprint(radius=2.0), 0.05, pose=Pose(2.0, 0.0))
    changed = np.abs(stage.shot(prairie, aim) - before).max(axis=2) > 2.0
    away = np.hypot(*np.moveaxis(stage.ground(aim) - (2.0, 0.0), -1, 0))
    assert changed[away < 1.5].mean() > 0.4
    assert changed[away > 4.0].mean() < 6e-4, "but for single pixels in which strips are as near as the carpet"


@pytest.mark.slow
def test_f4_cuts_and_ways_in_low_grass_show_from_above(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(MEADOW), camera(0.0, 14.0, 0.0, pitch=-90, view=40)
    before = stage.shot(prairie, aim)
    prairie.cut(Footprint(radius=1.5), 0.05, pose=Pose(-2.5, 0.0))
    entity = esper.create_entity(Presser(radius=1.0, length=3.0), Pose(2.5, 0.0))
    prairie.advance(0.5)
    changed = (stage.shot(prairie, aim) - before).mean(axis=2)
    esper.delete_entity(entity, immediate=True)
    place = stage.ground(aim)
    cut, way = (np.hypot(*np.moveaxis(place - (x, 0.0), -1, 0)) < 0.7 for x in (-2.5, 2.5))
    assert changed[cut].mean() > 7.0
    assert changed[way].mean() < -5.0
    prairie.release()


def test_g2_without_low_leaves_the_ground_is_what_the_scene_says(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(MEADOW.replace("0.5] }", "0.5], understorey: 0 }")), camera(0.0, 6.0, 0.0, pitch=-60)
    prairie.cut(ALL, 0.0)
    cut = stage.shot(prairie, aim)
    prairie.clear(ALL)
    np.testing.assert_allclose(cut.mean(axis=(0, 1)), stage.shot(prairie, aim).mean(axis=(0, 1)), atol=2.0)
    prairie.release()


@pytest.mark.parametrize("height", [0.08, pytest.param(0.3, marks=pytest.mark.slow)])
def test_f4_a_lawn_is_as_bright_on_all_representations_as_every_blade_of_it(
    stage: Stage, load: Load, camera: Aim, height: float
) -> None:
    aim, means = camera(0.0, 6.0, 20.0, pitch=-25), {}
    for lod in KEPT[:3]:
        prairie = load(LAWN, lod=lod)
        prairie.cut(ALL, height)
        means[lod] = stage.shot(prairie, aim)[20:].mean(axis=(0, 1))
        if lod == "blades":
            view, projection = stage.matrices(aim)
            due = draw_truth(prairie, view, projection, stage.size).picture[20:].mean(axis=(0, 1))
    for lod, mean in means.items():
        np.testing.assert_allclose(mean, due, rtol=0.06, err_msg=lod)


def test_f4_to_a_walker_half_of_high_grass_is_as_bright_on_the_carpet_as_on_blades(
    stage: Stage, load: Load, camera: Aim
) -> None:
    means = []
    for lod in ("blades", "carpet"):
        prairie = load(LAWN, lod=lod)
        prairie.cut(ALL, 0.3)
        means.append(stage.shot(prairie, camera(0.0, 1.7, 20.0, pitch=-8))[-30:].mean(axis=(0, 1)))
    np.testing.assert_allclose(means[1], means[0], rtol=0.08)


@pytest.mark.parametrize("lod", KEPT)
def test_f4_grass_that_was_grown_again_looks_as_if_it_had_never_been_cut(
    stage: Stage, load: Load, camera: Aim, lod: str
) -> None:
    prairie, aim = load(LITTLE, lod=lod), camera(0.0, 6.0, 20.0, pitch=-25)
    before = stage.shot(prairie, aim)
    prairie.cut(ALL, 0.1)
    cut = stage.shot(prairie, aim)
    prairie.grow(ALL)
    assert np.abs(cut - before).max() > 40.0
    assert np.abs(stage.shot(prairie, aim) - before).max() <= 2.0


def test_n5_the_same_strokes_in_the_same_order_give_the_same_picture(stage: Stage, load: Load, camera: Aim) -> None:
    aim, pictures = camera(0.0, 5.0, 18.0, pitch=-25), []
    for late in (False, True):
        prairie = load(LITTLE)
        if not late:
            stage.shot(prairie, aim)
        for number in range(8):
            prairie.cut(Footprint(radius=0.6, length=20.0), 0.05 + 0.01 * number, pose=Pose(-6.0 + 1.5 * number, 4.0))
            if not late:
                stage.shot(prairie, aim)
        prairie.grow(Footprint(radius=2.0), 0.2, pose=Pose(0.0, 6.0))
        pictures.append(stage.shot(prairie, aim))
    np.testing.assert_array_equal(*pictures)


def test_f4_blades_that_come_to_no_harm_by_the_cut_are_those_that_are_shorter(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie, aim = load(FLAT), camera(0.0, 3.0, 20.0, pitch=-15)
    before = stage.shot(prairie, aim)
    prairie.cut(ALL, prairie.site.tallest)
    assert np.abs(stage.shot(prairie, aim) - before).max() <= 2.0


def test_f4_mown_grass_is_trodden_too(stage: Stage, load: Load, camera: Aim) -> None:
    for lod in KEPT[:3]:
        prairie, aim = load(FLAT, lod=lod), camera(0.0, 1.5, 14.0, pitch=-10)
        prairie.cut(ALL, 0.2)
        before = stage.shot(prairie, aim)
        entity = esper.create_entity(Presser(radius=1.5), Pose(0.0, 6.0))
        prairie.advance(0.5)
        trodden = stage.shot(prairie, aim)
        esper.delete_entity(entity, immediate=True)
        assert np.abs(trodden - before).max() >= 2.0, lod
        prairie.release()


def test_f4_a_scene_read_again_keeps_what_was_cut(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(FLAT), camera(0.0, 6.0, 20.0, pitch=-25)
    prairie.cut(ALL, 0.1)
    before = stage.shot(prairie, aim)
    for seed in ("seed: 5", "seed: 6", "seed: 5"):
        prairie.loaded.file.write_text(FLAT.replace("seed: 5", seed), "utf-8")
        prairie.reload()
        last = stage.shot(prairie, aim)
    np.testing.assert_array_equal(last, before)


def test_f4_nobody_knows_of_mowing_where_nothing_was_cut(
    ctx: moderngl.Context, stage: Stage, load: Load, camera: Aim
) -> None:
    prairie = load(FLAT)
    prairie.grow(ALL, inf)
    stage.shot(prairie, camera(0.0, 3.0, 20.0))
    assert prairie.painter is not None
    assert prairie.painter.part(PlotsPart).texture.size == (1, 1)
    assert ctx.error == "GL_NO_ERROR"


def test_f4_a_prairie_that_was_released_is_not_cut(load: Load) -> None:
    prairie = load(FLAT)
    prairie.release()
    for stroke in (prairie.cut, prairie.grow):
        with pytest.raises(RuntimeError, match="this prairie has been released"):
            stroke(ALL, 0.1)
