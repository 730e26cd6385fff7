"""Pictures of whole frames: grass, ground and sky in their places (G1, T1, T2, G3)."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tallgrass.engine.camera import Camera, view_of
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import carpet_painter, draw_truth
from tallgrass.systems.show.blades.plant import standing_blades
from tallgrass.systems.show.blades.pool import BladesKept
from tallgrass.systems.show.blades.representation import BladeRepresentation
from tallgrass.systems.show.strips.gather import Batch
from tallgrass.systems.show.strips.painter import StripsPainter
from tallgrass.systems.tile import patch_models

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

LODS = ["auto", "blades", "strips", "carpet"]
QUALITY = """
quality:
  blades: 250
  models: 2
  blade_rings: [{ to: 2, segments: 3 }]
  strip_rings:
    - { to: 5, strips: 4, columns: 2, sections: 2, texel: 0.02 }
    - { to: 8, strips: 2, columns: 1, sections: 1, texel: 0.03 }
  carpet_to: 12
  carpet: 32
"""
PURPLE = (
    """\
tallgrass: 2
terrain: { noise: flat, size: [60, 60] }
grass:
  green: { height: [0.4, 0.6], width: 0.03, root: "#1a4010", tip: "#408020", lean: 0.2 }
light: { zenith: "#ff00ff", horizon: "#ff00ff", haze: 1000000, ground: "#ff0000" }
"""
    + QUALITY
)
TWO = (
    """\
tallgrass: 2
terrain: { noise: flat, size: [60, 60] }
grass:
  red: { height: [0.4, 0.6], width: 0.02, root: "#601010", tip: "#ff2020" }
  blue: { height: [0.4, 0.6], width: 0.02, root: "#101060", tip: "#2020ff" }
light: { elevation: 90 }
"""
    + QUALITY
)
HILLY = (
    """\
tallgrass: 2
terrain: { noise: hills, seed: 3, size: [60, 60], scale: 12, feature: 30 }
grass:
  white: { height: [0.4, 0.6], width: 0.03, root: "#c0c0c0", tip: "#ffffff", lean: 0.2 }
light: { zenith: "#000000", horizon: "#000000", haze: 1000000, ground: "#000000" }
"""
    + QUALITY
)
SQUARE = 10
"""Side of the squares by which pictures are compared [pixels]."""

LONE = """\
tallgrass: 2
terrain: { noise: hills, seed: 3, size: [80, 80], scale: 12, feature: 30 }
grass:
  lone: { height: [0.8, 0.8], width: 0.1, root: "#ffffff", tip: "#ffffff", lean: 0.0 }
light: { ground: "#000000", zenith: "#202020", horizon: "#202020" }
quality:
  patch: 20
  blades: 1
  models: 1
  blade_rings: [{ to: 1, segments: 4 }]
  strip_rings: [{ to: 2, strips: 1, columns: 1, sections: 1, texel: 0.05 }]
  carpet_to: 3
  carpet: 8
"""
PALE = """\
tallgrass: 2
terrain: { noise: flat, size: [60, 60] }
grass:
  pale: { height: [0.3, 0.3], width: 0.02, blades: 60, root: "#303030", tip: "#ffffff" }
light: { elevation: 70 }
quality:
  models: 4
  blade_rings: [{ to: 2, segments: 3 }]
  strip_rings: [{ to: 8, strips: 2, columns: 1, sections: 1, texel: 0.05 }]
  carpet_to: 12
  carpet: 16
"""
VIEWS: dict[str, dict[str, float]] = {
    "along": {"x": 0.7, "y": 1.7, "z": 20, "pitch": -5},
    "steep": {"x": 1, "y": 4, "z": 3, "pitch": -50, "yaw": 250},
    "straight down": {"x": 0.7, "y": 6, "z": 0.3, "pitch": -90, "yaw": 20},
    "across": {"x": 3, "y": 2, "z": 3, "pitch": -20, "yaw": 130},
}


@pytest.mark.parametrize("lod", LODS)
def test_t1_no_sky_shows_through_the_field(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    prairie = load(PURPLE, lod=lod)
    for name, place in VIEWS.items():
        aim = camera(**place)
        picture = stage.shot(prairie, aim)
        inside = (np.abs(stage.ground(aim)) < 29.0).all(axis=-1)
        assert inside.mean() > 0.5
        purple = np.minimum(picture[..., 0], picture[..., 2]) - picture[..., 1]
        sky = stage.shot(prairie, camera(0, 2, 0, pitch=60))
        assert (sky[..., 0] - sky[..., 1]).min() > 150, "the sky is purple"
        assert purple[inside].max() < 30, name


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
def test_t1_no_line_of_bare_ground_shows_where_patches_meet(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    aim = camera(1.2, 7, 3.8, pitch=-60, yaw=30)
    bare = stage.shot(load(PURPLE, lod=lod), aim)[..., 0]
    at = stage.ground(aim, level=0.2) / 2.5
    border = np.abs(at - np.round(at)).min(axis=-1) < 0.04
    inner = np.abs(at - np.round(at)).min(axis=-1) > 0.15
    assert border.sum() > 1000
    assert bare[border].mean() == pytest.approx(bare[inner].mean(), rel=0.08)


@pytest.mark.parametrize("lod", ["auto", "blades", "strips"])
def test_g1_both_kinds_are_seen(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    picture = stage.shot(load(TWO, lod=lod), camera(0, 2.5, 20, pitch=-25))
    red = picture[..., 0] - picture[..., 2]
    red -= np.median(red)
    assert (red > 10).mean() > 0.08
    assert (red < -10).mean() > 0.08
    assert 0.4 < (red > 10).sum() / (red < -10).sum() < 2.5


def test_g1_the_carpet_has_the_hue_of_both_kinds_together(stage: Stage, load: Load, camera: Aim) -> None:
    aim = camera(0, 2.5, 20, pitch=-25)
    pictures = {lod: stage.shot(load(TWO, lod=lod), aim)[30:].mean(axis=(0, 1)) for lod in ("strips", "carpet")}
    np.testing.assert_allclose(pictures["carpet"], pictures["strips"], rtol=0.12)


def test_g1_each_patch_of_the_carpet_shows_the_patch_model_that_its_blades_are_of(
    stage: Stage, load: Load, camera: Aim
) -> None:
    """If images of every second model show tips alone and the others roots, patches are bright and dark."""
    prairie, aim = load(PALE, lod="carpet"), camera(0.1, 30, 0.1, pitch=-89.9, view=40)
    stage.shot(prairie, aim)
    assert prairie.painter is not None
    images, patches = carpet_painter(prairie.painter).images, prairie.viewers["main"].patches
    columns, rows, layers = images.size
    texels = np.full((layers, rows, columns, 4), 255, np.uint8)
    texels[..., 0] = (np.arange(layers) * 4 // layers % 2 * 255)[:, None, None]
    images.write(texels.tobytes())
    images.build_mipmaps()
    seen = stage.project(aim, np.insert(patches.middle.astype(np.float64), 1, 0.15, axis=1)).astype(int)
    inside = patches.alive & (seen > 3).all(axis=1) & (seen < np.array(stage.size) - 3).all(axis=1)
    bright = stage.shot(prairie, aim).mean(axis=2)[seen[inside, 1], seen[inside, 0]]
    odd = patches.model[inside] % 2 == 1
    assert min(odd.sum(), (~odd).sum()) > 10
    assert bright[odd].min() > 1.3 * bright[~odd].max()


@pytest.mark.parametrize("yaw", [0, 90, 200])
def test_g1_all_representations_are_equally_bright(stage: Stage, load: Load, camera: Aim, yaw: float) -> None:
    aim = camera(0.4, 1.7, 0.6, pitch=-9, yaw=yaw)
    mean = {lod: stage.shot(load("plain", preset="low", lod=lod), aim)[45:].mean(axis=(0, 1)) for lod in LODS}
    for lod in LODS:
        np.testing.assert_allclose(mean[lod], mean["blades"], rtol=0.06)


def test_each_representation_draws_something_else(stage: Stage, load: Load) -> None:
    pictures = [stage.shot(load("plain", preset="low", lod=lod)) for lod in LODS]
    for number, one in enumerate(pictures):
        for other in pictures[number + 1 :]:
            assert np.abs(one - other).mean() > 0.1


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
def test_t1_on_hillsides_grass_stands_where_every_blade_does(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    prairie = load(HILLY, lod=lod)
    aim = camera(0.0, float(prairie.height_at([(0.0, 25.0)])[0]) + 2.0, 25.0, pitch=-6.0)
    picture = stage.shot(prairie, aim)
    view, projection = stage.matrices(aim)
    every = draw_truth(prairie, view, projection, stage.size, samples=2).picture.astype(np.float64)
    width, height = (size // SQUARE * SQUARE for size in stage.size)
    shown, due = (
        each[:height, :width].reshape(height // SQUARE, SQUARE, width // SQUARE, SQUARE, 3).mean(axis=(1, 3, 4))
        for each in (picture, every)
    )
    assert np.abs(shown - due).mean() < 0.1 * due.mean()


def test_t1_blades_grow_out_of_the_ground_and_do_not_float(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(LONE, lod="blades")
    stage.shot(prairie, camera(0, 10, 0, pitch=-89, view=125))
    pool, site, near = prairie.viewers["main"].keeps(BladesKept).pool, prairie.site, prairie.site.representations[0]
    assert isinstance(near, BladeRepresentation)
    cells = pool.stamp[pool.present.any(axis=1)]
    standing, grows = standing_blades(
        near.stock, cells, *patch_models(cells, seed=site.scene.seed, models=site.quality.models), site.ground
    )
    blades = standing[grows]
    seen = 0
    for blade in blades[np.abs(blades["root"][:, ::2]).max(axis=1) < 36.0]:
        root, away = blade["root"].astype(float), 3.0 * blade["facing"].astype(float)
        x, z = root[0] + away[0], root[2] + away[1]
        y = max(float(prairie.height_at([[x, z]])[0]) + 0.7, root[1] + 1.5)
        yaw, pitch = np.degrees(np.arctan2(-away[0], away[1])), np.degrees(np.arctan2(root[1] + 0.3 - y, 3.0))
        aim = camera(x, y, z, yaw=yaw, pitch=pitch, view=30)
        picture = stage.shot(prairie, aim)
        stage.target.clear(depth=1.0)
        assert prairie.painter is not None
        prairie.painter.draw(view_of(*stage.matrices(aim)), blades=[])
        rows, columns = np.nonzero(np.abs(picture - stage.read()).max(axis=-1) > 6)
        column, row = stage.project(aim, root[None])[0]
        rows, columns = rows[np.abs(columns - column) < 12], columns[np.abs(columns - column) < 12]
        assert len(rows) > 20, "the blade is seen"
        assert abs(rows.max() + 1 - row) <= 1.5, "in pixels of 18 mm"
        assert np.abs(columns[rows > rows.max() - 3].mean() + 0.5 - column) <= 1.0
        seen += 1
    assert seen >= 8


def test_drawing_twice_at_the_same_time_gives_the_same_picture(stage: Stage, load: Load) -> None:
    prairie = load()
    first = stage.shot(prairie)
    np.testing.assert_array_equal(stage.shot(prairie), first)
    prairie.advance(0.0)
    np.testing.assert_array_equal(stage.shot(prairie), first)


def test_w7_as_time_goes_on_the_wind_moves_the_grass_and_nothing_else(stage: Stage, load: Load) -> None:
    prairie = load()
    first, sky = stage.shot(prairie), stage.depth() == 1.0
    prairie.advance(0.5)
    later = stage.shot(prairie)
    assert np.abs(later - first)[30:].mean() > 0.5
    assert np.abs(later - first)[:10][sky[:10]].max() <= 1.0


def test_another_seed_is_other_grass_of_the_same_look(stage: Stage, load: Load) -> None:
    prairie = load()
    first = stage.shot(prairie)
    other = prairie.reseeded(99)
    second = stage.shot(other)
    other.release()
    assert np.abs(second - first)[30:].mean() > 2.0
    np.testing.assert_allclose(second[30:].mean(axis=(0, 1)), first[30:].mean(axis=(0, 1)), rtol=0.08)


def test_t2_a_banked_camera_sees_grass_in_all_its_corners(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(PURPLE)
    view, projection = stage.matrices(camera(0.7, 1.7, 20, pitch=-58))
    for bank in np.radians([30.0, 90.0, -60.0, 180.0]):
        roll = np.eye(4)
        roll[:2, :2] = [[np.cos(bank), -np.sin(bank)], [np.sin(bank), np.cos(bank)]]
        stage.target.use()
        stage.target.clear(depth=1.0)
        prairie.draw(roll @ view, projection)
        turned = stage.read()
        green = turned[..., 1] - turned[..., 2]
        corners = [green[:15, :25], green[:15, -25:], green[-15:, :25], green[-15:, -25:]]
        assert min(float(corner.mean()) for corner in corners) > 12.0


def test_t5_strips_look_the_same_in_many_draws_as_in_few(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(PURPLE, lod="strips")
    aim = camera(0.7, 1.7, 20, pitch=-5)
    picture, painter = stage.shot(prairie, aim), prairie.painter
    assert painter is not None
    strips = painter.painters["strips"]
    assert isinstance(strips, StripsPainter)
    few = list(strips.batches)
    strips.batches = [
        Batch(first + start, min(7, count - start), mode) for first, count, mode in few for start in range(0, count, 7)
    ]
    stage.target.clear(depth=1.0)
    painter.draw(view_of(*stage.matrices(aim)))
    assert len(strips.batches) > 4 * len(few)
    np.testing.assert_array_equal(stage.read(), picture)


def test_statistics_tell_what_was_drawn(stage: Stage, load: Load) -> None:
    prairie = load()
    stage.shot(prairie)
    told, patches = prairie.statistics, prairie.viewers["main"].patches
    visible = patches.alive & patches.visible
    assert sum(told.patches.values()) == visible.sum()
    assert told.blades_field == 60 * 24 * 24
    assert told.blades_considered == 60 * visible.sum()
    assert 0 < told.blades_submitted <= told.blades_considered
    assert told.receivers > told.blades_submitted
    assert 4 <= told.draw_calls < 40
    assert set(told.systems_ms) == {"press", "tile", "cull", "lod", "transition", "see", "plant", "wind", "gather"}


@pytest.mark.slow
def test_t1_ten_kilometres_of_hills_are_drawn_without_speckles(stage: Stage, load: Load, camera: Aim) -> None:
    land = "{ noise: ridges, seed: 4, size: [10240, 10240], scale: 400, feature: 900 }"
    prairie = load(PURPLE.replace("{ noise: flat, size: [60, 60] }", land).replace(', ground: "#ff0000"', ""))
    top = float(prairie.site.ground.terrain.heights.max())
    picture = stage.shot(prairie, camera(100, top + 50, 300, yaw=60, pitch=-12))
    grass = stage.depth() < 1.0
    assert grass.mean() > 0.5
    inside = grass[:, 2:] & grass[:, :-2]
    specks = np.abs(np.diff(picture, n=2, axis=1)).mean(axis=2)[inside]
    assert (specks > 20.0).mean() < 0.02
