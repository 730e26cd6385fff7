"""The same scene, seed and time are the same prairie, in every process (N4, N5)."""

import hashlib
import os
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
OnCard = Callable[[Prairie], Any]

PROGRAM = """
import hashlib, sys
import moderngl, numpy as np
from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import carpet_painter

ctx = moderngl.create_context(standalone=True, backend="egl", require=330)
size = (160, 90)
target = ctx.framebuffer([ctx.texture(size, 3, alignment=1)], ctx.depth_renderbuffer(size))
prairie = Prairie.load("meadow", ctx=ctx, preset="low")
for step in range(6):
    camera = camera_at(prairie.scene.camera, prairie.time, prairie.height_at)
    target.use()
    target.clear(depth=1.0)
    prairie.draw(view_matrix(camera), projection_matrix(camera.view, 160 / 90))
    prairie.advance(0.25)
np.save(sys.argv[1], np.frombuffer(target.read(components=3, alignment=1), np.uint8).reshape(90, 160, 3))
told = hashlib.blake2b(digest_size=8)
outlook, painter = prairie.viewers["main"], prairie.painter
for receiving in (*outlook.kept["blades"].receiving, *outlook.kept["strips"].receiving):
    slots = receiving.slots
    told.update(slots.tobytes() + receiving.pool.places(slots).tobytes() + receiving.messages.heard(slots).tobytes())
counts = [count for each in painter.painters.values() for count in each.receivers(outlook)]
texels = np.frombuffer(painter.received.texture.read(), np.float32).reshape(-1, 4)
for first, count in zip(painter.received.allocate(counts), counts[:-1], strict=False):
    told.update(texels[first : first + count].tobytes())
told.update(carpet_painter(painter).air.texture.read())
patches = outlook.patches
told.update(patches.representation.tobytes() + patches.progress.tobytes() + patches.model.tobytes())
print(told.hexdigest())
"""


@pytest.fixture(scope="module")
def played(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> list[tuple[str, Any]]:
    """A walk through the meadow, played in two processes: a hash of all receivers and patches, and the last picture."""
    assert ctx.error == "GL_NO_ERROR"
    folder = tmp_path_factory.mktemp("replay")
    runs = []
    for number in range(2):
        path = folder / f"{number}.npy"
        settings = os.environ | {"PYTHONHASHSEED": str(number + 1)}
        command = [sys.executable, "-W", "error", "-c", PROGRAM, str(path)]
        done = subprocess.run(command, cwd=folder, env=settings, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        runs.append((done.stdout.strip(), np.load(path).astype(int)))
    return runs


@pytest.mark.slow
def test_n5_a_walk_replays_bit_for_bit_in_another_process(played: list[tuple[str, Any]]) -> None:
    assert played[0][0] == played[1][0]
    assert len(played[0][0]) == 16


@pytest.mark.slow
def test_n5_its_pictures_are_the_same_within_one_level_in_another_process(played: list[tuple[str, Any]]) -> None:
    (_, one), (_, other) = played
    assert np.abs(one - other).max() <= 1
    assert len(np.unique(one.reshape(-1, 3), axis=0)) > 500


def test_n5_the_wind_does_not_depend_on_the_steps_that_time_took(
    stage: Stage, load: Load, camera: Aim, on_card: OnCard
) -> None:
    aim = camera(0.3, 4.1, 12.0, pitch=-14)
    stories = []
    for steps in ([2.0], [0.25] * 8, [1.5, 0.0, 0.5]):
        prairie = load()
        for dt in steps:
            prairie.advance(dt)
            stage.shot(prairie, aim)
        told = hashlib.blake2b(digest_size=8)
        for receiving, texels in on_card(prairie):
            told.update(texels.tobytes() + receiving.messages.heard(receiving.slots).tobytes())
        stories.append(told.hexdigest())
    assert len(set(stories)) == 1


def test_n5_a_prairie_comes_back_to_the_same_picture(stage: Stage, load: Load, camera: Aim) -> None:
    aims = [camera(x, 2.5, z, pitch=-20, yaw=yaw) for x, z, yaw in ((0.3, 12.0, 0), (9.0, -4.0, 200), (0.3, 12.0, 0))]
    still = load()
    pictures = [stage.shot(still, aim) for aim in aims]
    np.testing.assert_array_equal(pictures[0], pictures[2])


def test_n4_what_the_wind_is_asked_is_what_the_grass_feels(
    stage: Stage, load: Load, camera: Aim, on_card: OnCard
) -> None:
    prairie = load()
    prairie.advance(1.7)
    stage.shot(prairie, camera(0.3, 4.1, 12.0, pitch=-14))
    felt = 0
    for receiving, texels in on_card(prairie):
        slots = receiving.slots
        asked = prairie.wind_at(receiving.pool.places(slots).reshape(-1, 2))
        np.testing.assert_array_equal(receiving.messages.current(slots).reshape(-1, 2), asked)
        np.testing.assert_allclose(texels[..., :2].reshape(-1, 2), asked, atol=1e-3)
        assert np.linalg.norm(asked, axis=1).max() > 0.1
        felt += len(asked)
    assert felt == prairie.statistics.receivers
