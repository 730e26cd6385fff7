"""Pictures of ground that a game has changed: those of a prairie that was loaded with it (F1, N5)."""

from collections.abc import Callable
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


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet", "auto"])
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
    for _ in range(2):
        dig(prairie)
        stage.shot(prairie, aim)
        stage.shot(prairie, aim)
        assert sorted(size for _, size in sent) == [4 * 8 * 8, 4 * 25 * 21]
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
    """They are left out where the ground as it was is out of the picture."""
    pictures, top = [], before()
    top[40:60, 30:50] += 12.0
    for first, is_changed in ((before(), True), (top, False)):
        prairie = Prairie.load(scene(first), ctx=ctx, lod="blades")
        aim = camera(0.0, 13.0, 22.0, pitch=0)
        stage.shot(prairie, aim)
        if is_changed:
            prairie.set_heights((-10.0, 0.0), top[40:60, 30:50])
        pictures.append(stage.shot(prairie, aim))
        prairie.release()
    np.testing.assert_array_equal(*pictures)
