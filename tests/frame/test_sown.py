"""Sowing and clearing in frames: alike in all representations, at once, and in another process (F4, N5)."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass import Footprint, Pose, Road
from tallgrass.components.arrays import Bytes
from tallgrass.engine.camera import Camera
from tallgrass.systems.mow.card import PlotsPart
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

FLAT = LITTLE.replace("scale: 4", "scale: 0").replace("blades: 60", "blades: 300")
ALL = Footprint(radius=90.0)
KEPT = ["blades", "strips", "carpet", "auto"]


def build(prairie: Prairie) -> None:
    prairie.sow("short", ALL, 1.0)
    prairie.clear(Footprint(corners=((-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0))), pose=Pose(1.0, 4.0, 0.3))
    prairie.clear(Road(((-20.0, 9.0), (20.0, 12.0)), 2.0), soft=0.5)
    prairie.sow("tall", Footprint(radius=3.0), 0.8, soft=1.0, pose=Pose(-8.0, 2.0))
    prairie.cut(Footprint(radius=1.5), 0.1, pose=Pose(8.0, 4.0))


@pytest.mark.parametrize("lod", KEPT)
def test_f4_what_is_sown_in_front_of_a_viewer_looks_as_if_it_had_always_been(
    stage: Stage, load: Load, camera: Aim, lod: str
) -> None:
    aim, pictures = camera(0.0, 7.0, 20.0, pitch=-22), []
    for late in (False, True):
        prairie = load(FLAT, lod=lod)
        untouched = stage.shot(prairie, aim) if late else None
        build(prairie)
        if not late:
            pictures.append(stage.shot(prairie, aim))
    pictures.append(stage.shot(prairie, aim))
    np.testing.assert_array_equal(*pictures)
    assert untouched is not None
    assert np.abs(pictures[0] - untouched).max() > 40.0


def test_f4_a_kind_that_is_placed_nowhere_stands_where_it_is_sown(load: Load) -> None:
    prairie, place = (
        load(FLAT.replace("tall: {", "tall: { place: none,")),
        np.array([(0.0, 0.0), (9.0, 9.0)], np.float32),
    )
    assert prairie.grass_at(place).density.tolist() == [[0.0, 1.0], [0.0, 1.0]]
    prairie.sow("tall", Footprint(radius=3.0), 1.0)
    assert prairie.grass_at(place).density.tolist() == [[1.0, 0.0], [0.0, 1.0]]


@pytest.mark.parametrize("lod", KEPT)
def test_f4_on_a_road_no_wider_than_half_a_patch_stands_nothing(
    stage: Stage, load: Load, camera: Aim, lod: str
) -> None:
    white = FLAT + 'light: { ground: "#000000", zenith: "#404040", horizon: "#404040" }\n'
    prairie, aim = load(white, lod=lod), camera(0.0, 9.0, 14.0, pitch=-32)
    prairie.clear(Road(((0.0, -20.0), (0.0, 20.0)), 1.5))
    shown, place = stage.shot(prairie, aim).mean(axis=2), stage.ground(aim)
    ahead = np.abs(place[..., 1] + 4.0) < 5.0
    on, beside = ahead & (np.abs(place[..., 0]) < 0.3), ahead & (np.abs(place[..., 0] - 4.0) < 1.5)
    assert shown[on].mean() < 0.3 * shown[beside].mean()


@pytest.mark.parametrize("lod", KEPT)
def test_f4_where_all_is_cleared_stands_nothing(stage: Stage, load: Load, camera: Aim, lod: str) -> None:
    prairie, aim = load(FLAT + "parts: [sky, ground, grass]\n", lod=lod), camera(0.0, 0.3, 20.0)
    stage.shot(prairie, aim)
    prairie.clear(ALL)
    above = stage.shot(prairie, aim)[: stage.size[1] // 2]
    assert np.abs(np.diff(above, axis=1)).max() < 8.0, "the sky alone is seen"


def test_f4_beyond_the_terrain_lies_what_the_scene_declares_whatever_a_game_does(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie, aim = load(FLAT), camera(0.0, 9.0, 0.0, pitch=-14)
    (_, z), before = np.moveaxis(stage.ground(aim, level=0.0), -1, 0), stage.shot(prairie, aim)
    prairie.clear(Road(((-30.0, -24.0), (30.0, -24.0)), 6.0))
    change = np.abs(stage.shot(prairie, aim) - before).max(axis=-1)
    assert np.median(change[(z > -25.5) & (z < -22.5)]) > 15.0
    assert change[(z > -38.0) & (z < -34.0)].max() <= 8.0, "a mirror image of it would be seen"


def test_f4_only_plots_that_were_touched_are_sent(
    stage: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    prairie, aim, sent = load(FLAT), camera(0.0, 7.0, 20.0, pitch=-22), list[tuple[int, tuple[int, ...]]]()
    build(prairie)
    stage.shot(prairie, aim)
    assert prairie.painter is not None
    part = prairie.painter.part(PlotsPart)
    write = PlotsPart._write_texels  # noqa: SLF001 - every rectangle goes through it

    def noted(part: PlotsPart, texels: Bytes, level: int, viewport: tuple[int, int, int, int]) -> None:
        sent.append((level, viewport))
        write(part, texels, level, viewport)

    monkeypatch.setattr(PlotsPart, "_write_texels", noted)
    prairie.clear(Footprint(radius=0.5), pose=Pose(6.0, 6.0))
    stage.shot(prairie, aim)
    assert [(level, across * down) for level, (_, _, across, down) in sent] == [
        (level, 4 ** (6 - level)) for level in range(7)
    ]
    sent.clear()
    stage.shot(prairie, aim)
    assert not sent
    assert part.texture.size[0] > 1


def test_f4_nobody_pays_for_sowing_where_nothing_was_sown(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(FLAT)
    stage.shot(prairie, camera(0.0, 3.0, 20.0))
    assert prairie.painter is not None
    assert prairie.painter.part(PlotsPart).texture.size == (1, 1)
    prairie.release()
    with pytest.raises(RuntimeError, match="this prairie has been released"):
        prairie.sow("tall", ALL, 1.0)
    with pytest.raises(RuntimeError, match="this prairie has been released"):
        prairie.clear(ALL)


def test_f4_a_scene_read_again_keeps_what_was_sown(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(FLAT), camera(0.0, 7.0, 20.0, pitch=-22)
    build(prairie)
    before = stage.shot(prairie, aim)
    for size in ("[60, 60]", "[80, 80]", "[60, 60]"):
        prairie.loaded.file.write_text(FLAT.replace("[60, 60]", size), "utf-8")
        prairie.reload()
        last = stage.shot(prairie, aim)
    assert np.abs(last - before).max() <= 2.0


@pytest.mark.slow
def test_n5_a_village_a_crater_and_a_field_are_loaded_in_another_process_to_the_byte(
    ctx: moderngl.Context, tmp_path: Path
) -> None:
    assert ctx.version_code >= 330
    program, pictures = Path(__file__).with_name("village_program.py"), []
    for how in ("make", "load"):
        picture = tmp_path / f"{how}.npy"
        command = [sys.executable, "-W", "error", str(program), str(tmp_path / "state"), str(picture), how]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        pictures.append(np.load(picture))
    np.testing.assert_array_equal(*pictures)
    assert pictures[0].std(axis=(0, 1)).min() > 10.0


@pytest.mark.slow
def test_a_thousand_strokes_take_a_second_and_a_frame_that_sows_400_square_metres_is_no_standstill(
    ctx: moderngl.Context,
) -> None:
    """Measured as processor time in a process whose driver draws nothing, relative to frames without changes."""
    assert ctx.version_code >= 330
    program = Path(__file__).with_name("sown_program.py")
    done = subprocess.run(
        [sys.executable, program], env=os.environ | {"GALLIUM_NOOP": "1"}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    times = json.loads(done.stdout)
    rest = median(times["rests"])
    assert median(times["strokes"]) < 1.8 * rest
    assert times["thousand"][0] < 400.0 * rest
