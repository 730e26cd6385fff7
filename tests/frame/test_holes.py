"""Holes in the ground, and slopes too steep: neither ground nor grass is drawn there, and no depth (T1, F4)."""

from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie

Stage = Any
Aim = Callable[..., Camera]


def scene(heights: Floats, **kind: object) -> dict[str, Any]:
    return {
        "tallgrass": 2,
        "terrain": {"heights": heights, "cell": 1.0},
        "grass": {"green": {"height": [0.3, 0.5], **kind}},
        "quality": "low",
    }


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet", "auto"])
def test_f4_a_hole_shows_what_the_game_has_drawn_there(
    stage: Stage, ctx: moderngl.Context, camera: Aim, lod: Any
) -> None:
    heights, aim = np.zeros((61, 61), np.float32), camera(0.0, 9.0, 12.0, pitch=-45)
    heights[25:36, 25:36] = np.nan
    prairie = Prairie.load(scene(heights), ctx=ctx, lod=lod)
    stage.begin()
    stage.target.clear(1.0, 0.0, 1.0, depth=0.9999)
    prairie.draw(*stage.matrices(aim))
    seen, depth = stage.read(), stage.depth()  # of something far away
    off = np.abs(stage.ground(aim)).max(axis=2)
    within, without = off < 3.5, off > 7.0
    assert within.sum() > 200
    np.testing.assert_array_equal(seen[within], np.broadcast_to((255.0, 0.0, 255.0), seen[within].shape))
    np.testing.assert_allclose(depth[within], 0.9999, atol=1e-6)
    assert not (seen[without] == (255.0, 0.0, 255.0)).all(axis=1).any()
    prairie.release()


@pytest.mark.parametrize("lod", ["blades", "carpet"])
def test_f4_a_hole_that_is_dug_late_is_one_that_was_always_there_until_it_is_filled(
    stage: Stage, ctx: moderngl.Context, camera: Aim, lod: Any
) -> None:
    flat, aim = np.zeros((61, 61), np.float32), camera(0.0, 9.0, 12.0, pitch=-45)
    dug = flat.copy()
    dug[25:36, 25:36] = np.nan
    always, late = (Prairie.load(scene(each), ctx=ctx, lod=lod) for each in (dug, flat))
    due, before = stage.shot(always, aim), stage.shot(late, aim)
    programs = set(ctx.objects) if ctx.gc_mode == "context_gc" else None
    late.set_heights((-10.0, -10.0), dug[20:41, 20:41])
    np.testing.assert_array_equal(stage.shot(late, aim), due)
    assert np.abs(due - before).max() > 40.0
    assert programs is None or programs == set(ctx.objects)
    assert (late.grass_at([(0.0, 0.0), (0.0, 9.0)]).density.sum(axis=1) > 0.5).tolist() == [False, True]
    late.set_heights((-5.0, -5.0), np.zeros((11, 11)))
    np.testing.assert_array_equal(stage.shot(late, aim), before)
    always.release()
    late.release()


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
def test_f4_ground_that_is_too_steep_shows_as_ground_without_grass(
    stage: Stage, ctx: moderngl.Context, camera: Aim, lod: Any
) -> None:
    x = np.arange(-30.0, 31.0)
    heights = np.tile(np.where(np.abs(x) < 6.0, x, 6.0 * np.sign(x)), (61, 1)).astype(np.float32)
    aim, pictures = camera(0.0, 14.0, 14.0, pitch=-40), []
    for slope in (None, 30.0):
        prairie = Prairie.load(scene(heights, slope=slope), ctx=ctx, lod=lod)
        pictures.append(stage.shot(prairie, aim))
        prairie.release()
    changed = np.abs(pictures[1] - pictures[0]).max(axis=2) > 12.0
    width = stage.size[0]
    assert changed[:, int(0.45 * width) : int(0.55 * width)].mean() > 0.5
    assert changed[:, : width // 8].mean() < 0.05
