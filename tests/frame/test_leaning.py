"""Grass that leans away from the eye shows its faces, and grass that leans towards it its tips (G3, G4, F2)."""

from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import testing
from tallgrass.components.pose import Pose
from tallgrass.engine.camera import Camera, camera_at
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.testing import Stage

Load = Callable[..., Prairie]
Pixels = NDArray[np.float64]

CAMERAS = Path(__file__).parents[1] / "cameras"

PALE = """\
tallgrass: 2
terrain: { size: [80, 80] }
light: { ground: "#201810" }
grass: { turf: { height: [0.4, 0.7], width: 0.02, understorey: 0, root: "#c8c890", tip: "#c8c890", variety: 0.5 } }
quality: high
"""
YAW = 15.0
"""Heading of the camera: strips along the world's axes are not quite across the view [degrees]."""

CAMERA = Camera((0.0, 12.0, 20.0), np.radians(YAW), np.radians(-33.0), np.radians(18.0))


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (200, 120))


def seen_and_true(room: Stage, prairie: Prairie, heading: float) -> tuple[Pixels, Pixels]:
    """Return pictures of grass in a wind, and of all its blades; the heading is relative to the camera's [degrees]."""
    wind = prairie.add(Breeze(direction=YAW + heading, strength=0.55, gustiness=0.0, swing=0.0), pose=Pose())
    seen = room.shot(prairie, CAMERA).astype(np.float64)
    true = draw_truth(prairie, *room.matrices(CAMERA), room.size, samples=3).picture.astype(np.float64)
    prairie.remove(wind)
    return seen, true


@pytest.mark.parametrize("held", ["strips", "carpet"])
def test_grass_hides_as_much_of_the_ground_as_its_blades_do_whichever_way_it_leans(
    room: Stage, load: Load, held: str
) -> None:
    """Pale grass on dark ground: between the darkest and the brightest, it tells how much of the ground is hidden."""
    prairie, more = load(PALE, lod=held), []
    for heading in (0.0, 90.0, 180.0, 270.0):
        seen, true = seen_and_true(room, prairie, heading)
        bare, covered = np.percentile(true, (1.0, 99.0))
        more.append((seen.mean() - true.mean()) / (covered - bare))
    assert np.ptp(more) < 0.05


def test_each_blade_keeps_its_own_hue_on_strips(room: Stage, load: Load) -> None:
    seen, true = seen_and_true(room, load(PALE, lod="strips"), 0.0)
    redder, true_redder = ((each[..., 0] - each[..., 1]).std() for each in (seen, true))
    assert redder > 0.7 * true_redder


def slanted(pixels: Pixels) -> float:
    """Return the correlation of pixels with those up to the right, minus that with those up to the left."""
    luma = pixels.mean(axis=2)
    grain = luma - luma.mean()
    up = (grain[1:, :-1] * grain[:-1, 1:]).mean() - (grain[1:, 1:] * grain[:-1, :-1]).mean()
    return float(up / grain.var())


@pytest.mark.parametrize("preset", ["low", "high"])
def test_f2_from_above_the_carpets_grain_leans_as_the_blades_do(room: Stage, load: Load, preset: str) -> None:
    prairie = load(PALE, lod="carpet", preset=preset)
    for heading, side in ((90.0, 1.0), (270.0, -1.0)):
        seen, true = (side * slanted(each) for each in seen_and_true(room, prairie, heading))
        assert true > 0.1
        assert 0.7 * true < seen < 1.6 * true


LAID = """\
tallgrass: 2
terrain: { size: [110, 110] }
grass: { prairie: { height: [0.4, 0.7], width: 0.02 } }
quality: high
"""


@pytest.mark.parametrize("heading", [70.0, 160.0])
def test_from_the_side_strips_that_a_gale_lays_are_as_bright_as_their_blades(
    room: Stage, load: Load, heading: float
) -> None:
    """Flat blades show the middles of their arches on top, not their tips."""
    prairie = load(LAID, lod="strips")
    prairie.add(Breeze(direction=heading, strength=0.9), pose=Pose())
    prairie.advance(2.0)
    camera = Camera((0.0, 1.2, 25.0), 0.0, np.radians(-4.5), np.radians(4.0))  # 11 to 27 m away
    seen = room.shot(prairie, camera).astype(np.float64)
    true = draw_truth(prairie, *room.matrices(camera), room.size, samples=4).picture.astype(np.float64)
    assert seen.mean() == pytest.approx(true.mean(), rel=0.02)


def test_where_strips_begin_on_a_slope_that_falls_away_no_dark_band_shows(ctx: moderngl.Context) -> None:
    """A metre of height hides far more of such ground than of level ground, so strips need not lean back."""
    prairie = Prairie.load(CAMERAS / "slope-down.yaml", ctx=ctx, live=False)
    prairie.advance(2.0)
    with testing.stage(ctx, (160, 720)) as tall:
        view, projection = tall.matrices(camera_at(prairie.scene.camera, None, prairie.height_at))
        tall.begin()
        prairie.draw(view, projection)
        seen = tall.read()[350:362].astype(np.float64)
        true = draw_truth(prairie, view, projection, tall.size, samples=4).picture[350:362].astype(np.float64)
    prairie.release()
    assert seen.mean() == pytest.approx(true.mean(), rel=0.03)
