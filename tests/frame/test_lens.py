"""Grain through a long lens, and of tall plants far off: as sharp as every blade in 3D (G3, G5)."""

from collections.abc import Iterator
from pathlib import Path

import moderngl
import pytest

from tallgrass import testing
from tallgrass.app.bench.contrast import contrast
from tallgrass.app.bench.flip import MOMENT
from tallgrass.engine.camera import camera_at
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth, patch_distances
from tallgrass.testing import Stage

CAMERAS = Path(__file__).parents[1] / "cameras"
SIZE = (160, 720)
"""As many lines as a whole picture, as grain is measured in pixels; few columns, as references take long [pixels]."""

GOAL = 0.8


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage as large as the pictures."""
    with testing.stage(ctx, SIZE) as made:
        yield made


@pytest.mark.parametrize("camera", ["telephoto", "saucer", pytest.param("reeds", marks=pytest.mark.slow)])
def test_g5_grass_keeps_its_grain_however_large_a_lens_or_its_height_makes_it(
    ctx: moderngl.Context, stage: Stage, camera: str
) -> None:
    prairie = Prairie.load(CAMERAS / f"{camera}.yaml", ctx=ctx, live=False)
    try:
        prairie.advance(MOMENT)
        view, projection = stage.matrices(camera_at(prairie.scene.camera, None, prairie.height_at))
        stage.begin()
        prairie.draw(view, projection)
        seen = stage.read().astype("uint8")
        truth = draw_truth(prairie, view, projection, SIZE, samples=4)
        kept = contrast(seen, truth, patch_distances(prairie, view, projection, SIZE) >= 0)
    finally:
        prairie.release()
    assert kept is not None
    assert kept >= GOAL
