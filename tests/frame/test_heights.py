"""Pictures of ground that a game has changed equal those of a prairie loaded with that ground (F1, N5)."""

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

from tallgrass.components.arrays import Floats
from tallgrass.engine.camera import Camera
from tallgrass.engine.declared.quality import LodName
from tallgrass.systems.prairie import Prairie

Stage = Any
Aim = Callable[..., Camera]

SIDE, CELL = 81, 1.0
CORNER, HILL = (30, 24), np.outer(np.hanning(25), np.hanning(21)).astype(np.float32) * 5.0
"""Column and row of the first sample that changes; a hill beside it and a pit in front."""


def before() -> Floats:
    return np.add.outer(np.sin(np.arange(SIDE) / 9.0), np.cos(np.arange(SIDE) / 7.0)).astype(np.float32)


def after() -> Floats:
    heights = before()
    heights[CORNER[1] :][:25, CORNER[0] :][:, :21] += HILL
    heights[52:60, 36:44] -= 1.0
    return heights


def scene(heights: Floats) -> dict[str, Any]:
    return {
        "tallgrass": 2,
        "terrain": {"heights": heights, "cell": CELL},
        "grass": {"green": {"height": [0.3, 0.5]}},
        "wind": [{"kind": "breeze", "strength": 0.4}],
        "light": {"elevation": 9, "azimuth": 150},
        "quality": "low",
    }


def dig(prairie: Prairie) -> None:
    heights = after()
    for row, column, rows, columns in ((CORNER[1], CORNER[0], 25, 21), (52, 36, 8, 8)):
        part = heights[row : row + rows, column : column + columns]
        prairie.set_heights((column * CELL - 40.0, row * CELL - 40.0), part)


ALONE = [pytest.param(lod, marks=pytest.mark.slow) for lod in ("blades", "strips", "carpet")]


@pytest.mark.parametrize("lod", [*ALONE, "auto"])
def test_changed_ground_shows_what_one_shows_that_was_loaded_with_it(
    stage: Stage, ctx: moderngl.Context, camera: Aim, lod: LodName
) -> None:
    aim = camera(0.0, 6.0, 34.0, pitch=-12)
    changed, loaded = (Prairie.load(scene(each), ctx=ctx, lod=lod) for each in (before(), after()))
    untouched = stage.shot(changed, aim)
    dig(changed)
    for prairie in (changed, loaded):
        for _ in range(8):  # patches may come to another level of detail where they lie otherwise
            prairie.advance(0.5)
            stage.shot(prairie, aim)
    shown, due = stage.shot(changed, aim), stage.shot(loaded, aim)
    assert np.abs(due - untouched).max() > 40.0
    np.testing.assert_array_equal(shown, due)
    changed.release()
    loaded.release()


def test_only_what_is_touched_is_sent(
    stage: Stage, ctx: moderngl.Context, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent: list[tuple[int, int]] = []
    write = moderngl.Texture.write

    def count(texture: moderngl.Texture, data: Any, *args: Any, **options: Any) -> None:
        if texture.size == (SIDE, SIDE):
            sent.append((texture.glo, memoryview(data).nbytes))
        write(texture, data, *args, **options)

    aim, prairie = camera(0.0, 6.0, 34.0, pitch=-12), Prairie.load(scene(before()), ctx=ctx)
    stage.shot(prairie, aim)
    monkeypatch.setattr(moderngl.Texture, "write", count)
    for rims in ([4 * SIDE * SIDE], []):  # how far it is to the next rim is sent whole where there is a new one
        dig(prairie)
        stage.shot(prairie, aim)
        stage.shot(prairie, aim)
        assert sorted(size for _, size in sent) == [4 * 8 * 8, 4 * 25 * 21, *rims]
        sent.clear()
    prairie.release()


def test_who_looks_later_sees_changed_ground_as_well(stage: Stage, ctx: moderngl.Context, camera: Aim) -> None:
    aim, pictures = camera(0.0, 6.0, 34.0, pitch=-12), []
    for first, is_changed in ((before(), True), (after(), False)):
        prairie = Prairie.load(scene(first), ctx=ctx)
        prairie.draw(*stage.matrices(aim), viewer="second")
        if is_changed:
            dig(prairie)
            stage.shot(prairie, aim)
        for _ in range(8):
            prairie.advance(0.5)
            stage.begin()
            prairie.draw(*stage.matrices(aim), viewer="second")
        pictures.append(stage.read())
        prairie.release()
    np.testing.assert_array_equal(*pictures)


def test_ground_that_is_raised_keeps_its_blades_in_the_picture(
    stage: Stage, ctx: moderngl.Context, camera: Aim
) -> None:
    """Blades are culled by the ground's height: with the height before, these would be outside of the picture."""
    pictures, top = [], before()
    top[40:60, 30:50] += 6.0
    for first, is_changed in ((before(), True), (top, False)):
        prairie = Prairie.load(scene(first), ctx=ctx, lod="blades")
        aim = camera(0.0, 8.0, 22.0, pitch=0)
        stage.shot(prairie, aim)
        if is_changed:
            prairie.set_heights((-10.0, 0.0), top[40:60, 30:50])
        pictures.append(stage.shot(prairie, aim))
        prairie.release()
    np.testing.assert_array_equal(*pictures)


@pytest.mark.slow
def test_far_shadows_follow_and_are_right_in_the_end(stage: Stage, ctx: moderngl.Context, camera: Aim) -> None:
    """Shadows that reach over too much of the horizon map for one frame."""
    flat, ridge = (np.zeros((601, 601), np.float32) for _ in range(2))
    ridge[200:202, 150:450] = 9.0
    aim, pictures = camera(0.0, 90.0, 0.0, pitch=-50), []
    for first, is_changed in ((flat, True), (ridge, False)):
        prairie = Prairie.load(scene(first), ctx=ctx, lod="carpet")
        stage.shot(prairie, aim)
        if is_changed:
            prairie.set_heights((-150.0, -100.0), ridge[200:202, 150:450])
        shown = [stage.shot(prairie, aim) for _ in range(12)]
        pictures.append((shown[0], shown[-1]))
        prairie.release()
    (early, late), (_, due) = pictures
    np.testing.assert_array_equal(late, due)
    assert np.abs(early - due).max() > 15.0


@pytest.mark.slow
def test_a_frame_in_which_10_km_of_terrain_are_dug_takes_no_longer_than_half_as_long_again(
    ctx: moderngl.Context,
) -> None:
    """Measured as processor time in a process whose driver draws nothing."""
    assert ctx.version_code >= 330
    program = Path(__file__).with_name("heights_program.py")
    done = subprocess.run(
        [sys.executable, program], env=os.environ | {"GALLIUM_NOOP": "1"}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    times = json.loads(done.stdout)
    assert median(times["digs"]) < 1.5 * median(times["rests"])
