"""Rims of cliffs against the sky: grass is as high and as dense as in the reference (G4)."""

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import testing
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.testing import Stage, looking

SIZE = 240, 160
HEIGHT, AWAY = 10.0, 60.0
"""Height of the cliff, and distance of its foot [m]."""

GRASS = slice(90, 110)
"""Rows of a picture that show the cliff's grass alone."""

WITHIN = 0.12
"""Largest distance of its outline from the reference's, as a mean over a metre and a half [m].

It is told by colours, so it depends on the hue of the light, too: by 0.006."""


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage as large as the pictures."""
    with testing.stage(ctx, SIZE) as made:
        yield made


@pytest.mark.parametrize("run", [10.0, 4.0, 1.5])
def test_g4_a_cliffs_rim_stands_out_from_the_sky_as_every_blade_does(
    ctx: moderngl.Context, stage: Stage, run: float
) -> None:
    x, z = np.meshgrid(np.arange(61) - 30.0, np.arange(121) - 60.0)
    far = -z - 10.0 + 2.0 * np.sin(x / 8.0)
    heights = (HEIGHT * np.clip(far / run, 0.0, 1.0)).astype(np.float32)
    scene = {
        "tallgrass": 2,
        "terrain": {"heights": heights, "cell": 1.0},
        "grass": {"green": {"height": [0.4, 0.7]}},
        "light": {"azimuth": 150, "elevation": 40},
        "quality": "medium",
    }
    prairie = Prairie.load(scene, ctx=ctx)
    aim = looking(0.0, 1.7, AWAY - 10.0, pitch=9, view=10)
    drawn = covered(stage.shot(prairie, aim))
    truth = covered(draw_truth(prairie, *stage.matrices(aim), SIZE, samples=4).picture)
    prairie.release()
    metre = SIZE[1] / 2 / np.tan(aim.view / 2) / np.hypot(AWAY, HEIGHT)
    along = np.ones(int(1.5 * metre)) / int(1.5 * metre)
    off = np.convolve(drawn.sum(axis=0) - truth.sum(axis=0), along, "valid") / metre
    assert np.abs(off).max() < WITHIN


def covered(picture: NDArray[np.float64] | NDArray[np.uint8]) -> NDArray[np.float64]:
    """Return the fraction of each pixel that hides the sky, which is bluer than grass."""
    blue = picture[..., 2].astype(np.float64) - picture[..., 1]
    sky, grass = blue[:4].mean(axis=0), blue[GRASS].mean()
    return np.asarray(np.clip((sky - blue) / (sky - grass), 0.0, 1.0), np.float64)
