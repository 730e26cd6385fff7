"""The carpet's light follows the wind that bends the grass (F6)."""

from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.app.bench.contrast import luma
from tallgrass.components.pose import Pose
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

CALM = """\
tallgrass: 2
terrain: { size: [60, 60] }
grass: { turf: { height: [0.4, 0.7], width: 0.02, taper: 0.4, blades: 800 } }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 8 }]
  strip_rings: [{ to: 2, strips: 2, texel: 0.05 }]
  carpet_to: 16
  carpet: 64
"""
COARSE = CALM + "  coarse: true\n"
RADIUS, PATCH = 6.0, 2.5
CAMERA = Camera((0.0, 4.0, 29.0), 0.0, -0.15, np.radians(14.0))


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (240, 160))


@pytest.fixture(scope="module")
def prairie(load: Load) -> Prairie:
    """Prairie of carpet alone, in calm air."""
    return load(CALM, lod="carpet")


def brighter(room: Stage, prairie: Prairie, wind: Breeze | Blast) -> NDArray[np.float64]:
    """Return each pixel's brightness in a wind relative to calm air, minus 1, shape (height, width)."""
    calm = room.shot(prairie, CAMERA).mean(axis=2)
    handle = prairie.add(wind, pose=Pose())
    blown = room.shot(prairie, CAMERA).mean(axis=2)
    prairie.remove(handle)
    return np.asarray(blown / calm - 1.0)


def test_f6_grass_that_bends_away_from_the_eye_is_brighter_and_towards_it_darker(room: Stage, prairie: Prairie) -> None:
    away, aside, towards = (
        brighter(room, prairie, Breeze(direction=yaw, strength=0.6, gustiness=0.0, swing=0.0)).mean()
        for yaw in (0.0, 90.0, 180.0)
    )
    assert away > aside + 0.03
    assert aside > towards + 0.03


def test_f6_only_where_a_wind_bends_it_the_carpet_is_lit_otherwise(room: Stage, prairie: Prairie) -> None:
    blast = Blast(outline=Shape(disc=RADIUS), strength=0.9, swing=0.0)
    change = np.abs(brighter(room, prairie, blast))
    from_middle = np.hypot(*np.moveaxis(room.ground(CAMERA, level=0.3), -1, 0))
    under, beyond = (from_middle > 1.5) & (from_middle < RADIUS - 1.5), from_middle > RADIUS + 2.0 * PATCH
    assert change[under].mean() > 0.04
    assert change[beyond].max() < 0.025  # a step of 8 bits


@pytest.mark.parametrize(
    ("text", "off"), [(CALM, 0.04), pytest.param(COARSE, 0.065, marks=pytest.mark.slow)], ids=["whole", "coarse"]
)
def test_f2_from_above_the_carpet_hides_as_much_more_of_the_ground_as_bent_blades_do(
    room: Stage, load: Load, text: str, off: float
) -> None:
    """Pale grass on dark ground: between the darkest and the brightest, it tells how much of the ground is hidden."""
    pale = text.replace("width: 0.02", 'width: 0.02, understorey: 0, root: "#c8c890", tip: "#c8c890"')
    prairie = load(pale + 'light: { ground: "#201810" }\n', lod="carpet")
    above, more = Camera((0.0, 20.0, 0.0), 0.3, -np.pi / 2.0, np.radians(30.0)), []
    for strength in (0.0, 0.3, 0.6, 0.9):
        wind = prairie.add(Breeze(direction=40.0, strength=strength, gustiness=0.0, swing=0.0), pose=Pose())
        seen = luma(room.shot(prairie, above)).mean()
        truth = luma(draw_truth(prairie, *room.matrices(above), room.size, samples=2).picture)
        bare, covered = np.percentile(truth, (1.0, 99.0))
        more.append((seen - truth.mean()) / (covered - bare))
        prairie.remove(wind)
    np.testing.assert_allclose(more, 0.0, atol=off)


def test_f2_from_a_slant_the_carpet_tells_which_way_grass_leans_as_blades_do(room: Stage, load: Load) -> None:
    broad = CALM.replace("width: 0.02", 'width: 0.026, root: "#4a5f2b", tip: "#bcc26c"')
    prairie = load(broad, lod="carpet")
    slant, ratios = Camera((0.0, 20.0, 20.0), 0.0, -0.25 * np.pi, np.radians(30.0)), []
    for yaw in (0.0, 180.0):
        wind = prairie.add(Breeze(direction=yaw, strength=0.4, gustiness=0.0, swing=0.0), pose=Pose())
        seen = room.shot(prairie, slant).mean()
        ratios.append(seen / draw_truth(prairie, *room.matrices(slant), room.size, samples=2).picture.mean())
        prairie.remove(wind)
    np.testing.assert_allclose(ratios[1], ratios[0], rtol=0.05)


@pytest.mark.parametrize("pitch", [-0.08, -0.12, -0.2, -0.35])
def test_f2_a_coarse_carpet_hides_as_much_of_the_ground_between_the_slopes_of_its_images(
    room: Stage, load: Load, pitch: float
) -> None:
    pale = 'width: 0.02, understorey: 0, root: "#c8c890", tip: "#c8c890"'
    whole, coarse = (
        load(text.replace("width: 0.02", pale) + 'light: { ground: "#201810" }\n', lod="carpet")
        for text in (CALM, COARSE)
    )
    camera = Camera((0.0, 0.5 - 20.0 * np.tan(pitch), 20.0), 0.0, pitch, np.radians(6.0))
    assert room.shot(coarse, camera).mean() == pytest.approx(room.shot(whole, camera).mean(), rel=0.022)


@pytest.mark.parametrize("text", [CALM, COARSE], ids=["whole", "coarse"])
def test_f6_leaves_of_the_carpet_go_where_the_wind_bends_them(room: Stage, load: Load, text: str) -> None:
    """From above, with north up and a wind to the east; litter on the ground stays in place."""
    prairie = load(text, lod="carpet")
    above = Camera((0.3, 20.0, 0.2), 0.0, -np.pi / 2.0, np.radians(8.0))
    calm, metre = luma(room.shot(prairie, above)), room.size[1] / (2.0 * 20.0 * np.tan(np.radians(4.0)))
    wind = prairie.add(Breeze(direction=90.0, strength=0.6, gustiness=0.0, swing=0.0), pose=Pose())
    blown = luma(room.shot(prairie, above))
    prairie.remove(wind)

    def alike(move: int) -> float:
        moved = blown[:, 40 + move : blown.shape[1] - 40 + move]
        return float(np.corrcoef(calm[:, 40:-40].ravel(), moved.ravel())[0, 1])

    best = max(range(3, 31), key=alike)
    assert 0.08 * metre < best < 0.14 * metre
    assert alike(best) > alike(-best) + 0.1


def test_grass_that_grows_half_as_densely_is_as_bright_on_the_carpet_as_its_blades_are(
    room: Stage, load: Load, tmp_path: Path
) -> None:
    """One sees farther down into it, where blades have the colour of their roots."""
    half = tmp_path / "half.png"
    Image.fromarray(np.full((8, 8), 128, np.uint8)).save(half)
    colours = f'understorey: 0, root: "#202020", tip: "#a0a0a0", place: {{ map: {half} }}'
    prairie = load(
        CALM.replace("blades: 800", f"blades: 800, {colours}") + 'light: { ground: "#101010" }\n', lod="carpet"
    )
    seen, true = room.shot(prairie, CAMERA), draw_truth(prairie, *room.matrices(CAMERA), room.size, samples=3).picture
    assert seen.mean() == pytest.approx(true.mean(), rel=0.06)


BARE = """\
tallgrass: 2
seed: 1
terrain: { size: [100, 100] }
grass: { turf: { height: [0.4, 0.7], width: 0.02, blades: 2 } }
"""


def test_behind_grass_that_hides_hardly_anything_the_ground_is_seen_where_it_lies(room: Stage, load: Load) -> None:
    """The ground is drier here and greener there: compared line by line."""
    prairie, camera = load(BARE, lod="carpet"), Camera((0.0, 1.7, 48.0), 0.0, -0.03, np.radians(4.0))
    lines = [
        picture[60:150].mean(axis=(1, 2))
        for picture in (
            room.shot(prairie, camera),
            draw_truth(prairie, *room.matrices(camera), room.size, samples=4).picture,
        )
    ]
    assert np.abs(lines[0] - lines[1]).mean() < 2.0
    assert np.ptp(lines[1]) > 10.0
