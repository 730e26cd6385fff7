"""What frames have to do on a walk, counted: times say as much of the machine (R2, R3)."""

from collections.abc import Callable

import numpy as np

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

PACE, STEP = 1.6, 0.1
"""How fast the walker goes [m/s], and time between frames [s]."""


def test_r2_on_a_walk_frames_have_as_much_to_do_however_many_patches_are_changing(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie, counts, changing = load(), [], []
    for frame in range(60):
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
