"""Ground that goes on beyond the terrain as its mirror image: up to the horizon, in its own light (T1, F10)."""

from collections.abc import Callable
from math import radians
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass import testing
from tallgrass.engine.camera import Camera
from tallgrass.engine.scene import parse_scene
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.carpet.ground import GroundPainter
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

GROUND = "terrain: { noise: rolling, seed: 2, size: [60, 60], feature: 30, scale: 4 }"

SOUTH, NORTH = 160.0, -20.0
"""Two azimuths of the sun, one opposite to the other [degrees]."""


def lit(azimuth: float) -> str:
    return f"light: {{ azimuth: {azimuth}, elevation: 5, haze: 1000000 }}\n"


def mirrored(text: str) -> str:
    return text.replace(GROUND, GROUND.replace(" }", ", beyond: mirror }"))


def from_above(camera: Aim) -> Camera:
    return camera(0.0, 60.0, 20.0, yaw=20, pitch=-12, view=40)


def below_horizon(stage: Stage, aim: Camera, degrees: float) -> Any:
    """Return the mask of rows whose pixels all look down by more than an angle."""
    away = aim.position[1] / np.tan(radians(degrees))
    seen = stage.ground(aim) - np.array(aim.position)[[0, 2]]
    return (np.linalg.norm(seen, axis=-1) < away).all(axis=1)


@pytest.mark.parametrize("lod", [pytest.param("auto", marks=pytest.mark.slow), "carpet"])
def test_t1_from_high_up_no_sky_is_seen_below_the_horizon(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    aim = from_above(camera)
    below, sky = below_horizon(stage, aim, 0.9), []
    assert below.sum() > 60
    for text in (LITTLE, mirrored(LITTLE)):
        stage.shot(load(text, lod=lod), aim)
        sky.append((stage.depth()[below] == 1.0).mean())
    assert sky[0] > 0.1, "level ground ends 600 m beyond the terrain"
    assert sky[1] == 0.0


def test_t1_mirrored_ground_ends_in_the_haze_and_not_in_an_edge(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(mirrored(LITTLE) + "light: { haze: 1000000 }\n", lod="carpet")
    rows = stage.shot(prairie, camera(0.0, 60.0, 20.0, yaw=20, pitch=-1.4, view=3)).mean(axis=1)
    assert np.ptp(rows, axis=0).max() > 60.0, "the air alone hides nothing there"
    assert np.abs(np.diff(rows, axis=0)).max() < 0.12 * np.ptp(rows, axis=0).max()


def test_f10_light_and_shadow_of_a_low_sun_lie_in_the_mirror_as_on_the_ground_that_is_seen_in_it(
    stage: Stage, load: Load, camera: Aim, tmp_path: Path
) -> None:
    aim, brighter = camera(10.0, 40.0, -20.0, yaw=30, pitch=-24, view=40), []
    terrain = load(LITTLE).site.ground.terrain
    np.save(tmp_path / "seen.npy", np.pad(terrain.heights, 3 * (len(terrain.heights) - 1), mode="reflect"))
    seen = LITTLE.replace(GROUND, f"terrain: {{ heights: {tmp_path / 'seen.npy'}, cell: {terrain.cell} }}")
    for ground in (mirrored(LITTLE), seen):
        suns = [stage.shot(load(ground + lit(each), lod="carpet"), aim)[..., 1] for each in (SOUTH, NORTH)]
        brighter.append(suns[0] - suns[1])
    away = np.abs(stage.ground(aim)).max(axis=-1)
    beyond = (away > 35.0) & (away < 180.0)
    assert brighter[0][beyond].std() > 5.0
    assert np.corrcoef(*(each[beyond] for each in brighter))[0, 1] > 0.98


def test_ground_that_is_not_mirrored_knows_nothing_of_it(stage: Stage, load: Load, camera: Aim) -> None:
    told = []
    for text in (LITTLE, mirrored(LITTLE)):
        prairie = load(text, lod="carpet")
        stage.shot(prairie, camera(0.0, 2.0, 20.0))
        assert prairie.painter is not None
        told.append("MIRRORED" in prairie.painter.block.defines)
    assert told == [False, True]


def test_n7_a_scene_that_is_read_again_with_or_without_a_mirror_is_drawn_as_it_says(
    stage: Stage, load: Load, camera: Aim
) -> None:
    aim, texts = from_above(camera), [LITTLE + lit(SOUTH), mirrored(LITTLE) + lit(SOUTH)]
    level, image = (stage.shot(load(text, lod="carpet"), aim) for text in texts)
    assert (level != image).mean() > 0.3
    prairie = load(texts[0], lod="carpet")
    stage.shot(prairie, aim)
    for text, due in ((texts[1], image), (texts[0], level)):
        prairie.reload(parse_scene(text))
        np.testing.assert_array_equal(stage.shot(prairie, aim), due)


def test_f10_heights_that_a_game_changes_are_seen_in_the_mirror_and_shade_what_is_there(
    stage: Stage, load: Load, camera: Aim, tmp_path: Path
) -> None:
    aim, heights = camera(10.0, 40.0, -20.0, yaw=30, pitch=-24, view=40), load(LITTLE).site.ground.terrain.heights
    file = f"terrain: {{ heights: {tmp_path / 'heights.npy'}, beyond: mirror }}"
    ground, pictures = LITTLE.replace(GROUND, file) + lit(SOUTH), []
    dike = heights[8:11].copy() + 4.0
    for late in (True, False):
        if not late:
            heights = np.concatenate([heights[:8], dike, heights[11:]])
        np.save(tmp_path / "heights.npy", heights)
        prairie = load(ground, lod="carpet")
        pictures.append(stage.shot(prairie, aim))
        if late:
            prairie.set_heights((-30.0, -22.0), dike)
            pictures.append(stage.shot(prairie, aim))
    away = np.abs(stage.ground(aim)).max(axis=-1)
    assert np.abs(pictures[1] - pictures[0])[(away > 35.0) & (away < 120.0)].max() > 40.0
    np.testing.assert_array_equal(pictures[1], pictures[2])


def test_t1_where_hills_far_off_fall_away_nobody_looks_down_to_the_roots_of_their_grass(
    ctx: moderngl.Context, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    hills = "terrain: { noise: hills, seed: 11, size: [300, 300], feature: 90, scale: 15, beyond: mirror }"
    text = LITTLE.replace(GROUND, hills) + "light: { haze: 1000000 }\n"
    for root, tip in (("5a5a2c", "dcc98f"), ("27401a", "8fae4a")):
        text = text.replace(root, "1010ff").replace(tip, "ff1010")
    prairie, aim = load(text, lod="carpet"), camera(0.0, 60.0, 0.0, yaw=30, pitch=-5, view=8)
    with testing.stage(ctx, (480, 270)) as stage:
        whole = stage.shot(prairie, aim)
        monkeypatch.setattr(GroundPainter, "draw_carpet", lambda *_: 0)
        under = stage.shot(prairie, aim)
        ground = stage.depth() < 1.0
    seen = ground & (whole == under).all(axis=-1)
    bluer = whole[..., 2] / whole[..., 0].clip(1.0)
    assert seen.sum() > 300, "over a crest, the carpet lets through what is under it"
    assert np.median(bluer[seen]) < np.median(bluer[ground])
