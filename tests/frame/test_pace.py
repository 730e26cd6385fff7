"""Work of frames on a walk, by counts: times would depend on the machine, too (R2, R3)."""

from collections.abc import Callable
from functools import partial

import moderngl
import numpy as np

from tallgrass.app.studio.timing import timed
from tallgrass.engine.camera import Camera, camera_at, view_of
from tallgrass.engine.gl.rasteriser import draws_in_software
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.show.carpet.air import FAR_LEVELS
from tallgrass.testing import Stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

PACE, STEP = 1.6, 0.1
"""Speed of the walker [m/s], and time between frames [s]."""


def test_r2_on_a_walk_frames_have_as_much_to_do_however_many_patches_are_changing(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie, counts, changing = load(), [], []
    for frame in range(40):
        z = 20.0 - PACE * STEP * frame
        height = float(prairie.height_at([[0.6, z]])[0])
        stage.shot(prairie, camera(0.6, height + 1.7, z, pitch=-10))
        prairie.advance(STEP)
        told = prairie.statistics
        counts.append((told.blades_submitted, told.receivers, told.draw_calls))
        changing.append(told.transitions)
    most, median = np.max(counts[1:], axis=0), np.median(counts[1:], axis=0)
    assert (most < 1.4 * median).all()
    assert max(changing) > 5


def test_r3_moving_the_grass_takes_a_small_part_of_a_frame(ctx: moderngl.Context, load: Load) -> None:
    """Systems and the receivers' passes, against whole frames: the least of several times, measured in turn.

    In so small a picture a card draws while calls are made, so calls are most of both times.
    """
    room, prairie = Stage(ctx, (640, 360)), load()
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    frames, moving = [], []
    for _ in range(12):
        frames.append(timed(ctx, partial(room.shot, prairie, camera)))
        painter, systems = prairie.painter, prairie.statistics.systems_ms
        assert painter is not None
        heard = timed(ctx, partial(painter.hear, view_of(*room.matrices(camera))))
        moving.append(heard + systems["press"] + systems["wind"])
        prairie.advance(STEP)
    room.release()
    assert min(moving[2:]) < (0.12 if draws_in_software(ctx) else 0.5) * min(frames[2:])


def test_r3_receivers_are_asked_in_one_draw_a_pool_however_many_patches_there_are(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie = load()
    stage.shot(prairie, camera(0.6, 3, 20, pitch=-10))
    assert prairie.painter is not None
    pools = sum(len(each.receivers(prairie.viewers["main"])) for each in prairie.painter.painters.values())
    calls = prairie.painter.hear(view_of(*stage.matrices(camera(0.6, 3, 20, pitch=-10))))
    assert calls <= pools + 2 + FAR_LEVELS
