"""Artefacts of levels of detail from odd angles: rows, combing, holes (G3, G4, X5)."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest

from tallgrass import testing
from tallgrass.app.bench.contrast import luma
from tallgrass.app.bench.flip import MOMENT
from tallgrass.components.arrays import Doubles
from tallgrass.engine.camera import Camera, camera_at
from tallgrass.engine.declared.quality import LodName
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import cropped, draw_truth, patch_distances
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

CAMERAS = Path(__file__).parents[1] / "cameras"
SAMPLES = 4


@pytest.fixture(scope="module")
def wide(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage of 240 by 270 pixels."""
    with testing.stage(ctx, (240, 270)) as made:
        yield made


@pytest.fixture(scope="module")
def narrow(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage of 120 by 270 pixels: references with all their blades take long."""
    with testing.stage(ctx, (120, 270)) as made:
        yield made


def both(stage: Stage, prairie: Prairie, camera: Camera) -> tuple[Doubles, Doubles]:
    """Return a camera's picture of a prairie, and its reference: luma, (height, width) each."""
    seen = stage.shot(prairie, camera)
    return luma(seen.astype(np.uint8)), luma(
        draw_truth(prairie, *stage.matrices(camera), stage.size, samples=SAMPLES).picture
    )


def rows(picture: Doubles) -> float:
    """Return the unevenness of the means of a picture's lines, in blocks of 120 columns."""
    blocks = [picture[120:, start : start + 120].mean(axis=1) for start in range(0, picture.shape[1], 120)]
    return float(np.mean([unevenness(block) for block in blocks]))


def unevenness(lines: Doubles) -> float:
    """Return the standard deviation of values from their running mean."""
    return float((lines - np.convolve(lines, np.ones(9) / 9, "same"))[6:-6].std())


@pytest.mark.slow
@pytest.mark.parametrize("name", ["above-30", "above-60", "lawn"])
def test_g3_no_rows_show_from_twelve_metres_up_or_in_a_lawn(ctx: moderngl.Context, narrow: Stage, name: str) -> None:
    prairie = Prairie.load(CAMERAS / f"{name}.yaml", ctx=ctx, live=False)
    prairie.advance(MOMENT)
    drawn, true = both(narrow, prairie, camera_at(prairie.scene.camera, None, prairie.height_at))
    prairie.release()
    assert rows(drawn) ** 2 < 1.5 * rows(true) ** 2


@pytest.fixture(scope="module")
def hills(load: Load) -> Prairie:
    return load("hills", preset="low")


@pytest.mark.parametrize(
    ("up", "pitch"),
    [
        pytest.param(12.0, -90.0, marks=pytest.mark.slow),
        (30.0, -60.0),
        pytest.param(60.0, -30.0, marks=pytest.mark.slow),
        pytest.param(60.0, -90.0, marks=pytest.mark.slow),
    ],
)
def test_f2_from_above_it_is_the_same_grass_without_rows(
    hills: Prairie, narrow: Stage, up: float, pitch: float
) -> None:
    ground = float(hills.height_at(np.array([[0.0, 10.0]], np.float32))[0])
    drawn, true = both(narrow, hills, Camera((0.0, ground + up, 10.0), 0.0, math.radians(pitch), math.radians(45.0)))
    assert rows(drawn) ** 2 < 1.5 * rows(true) ** 2
    bands = [band.mean() / other.mean() for band, other in zip(np.split(drawn, 5), np.split(true, 5), strict=True)]
    assert bands == pytest.approx([1.0] * 5, abs=0.05)
    step = narrow.size[1] // 5
    for start in range(0, narrow.size[0] - step, step):
        grain = drawn[step : 2 * step, start : start + step].std() / true[step : 2 * step, start : start + step].std()
        assert 0.5 < grain < 1.6


APART = """\
tallgrass: 2
terrain: {{ size: [20, 40], noise: flat }}
grass: {{ bunch: {{ height: [0.45, 0.85], width: 0.026, lean: 0.35, root: "#4a5f2b", tip: "#bcc26c" }} }}
quality:
  models: 1
  blade_rings: [{{ to: 1, segments: 2 }}]
  strip_rings: [{{ to: 16, strips: {strips}, texel: 0.02 }}]
  carpet_to: 20
  carpet: 64
"""


def test_f2_strips_far_apart_are_as_bright_from_above_as_strips_close_together(load: Load, narrow: Stage) -> None:
    camera = Camera((0.0, 6.0, 18.0), 0.0, -0.35, 0.6)
    few, many = (
        luma(narrow.shot(load(APART.format(strips=strips), lod="strips"), camera).astype(np.uint8))[60:].mean()
        for strips in (2, 8)
    )
    assert few == pytest.approx(many, rel=0.015)


@pytest.mark.slow
def test_g3_no_rows_show_where_a_whirlwind_lays_grass_towards_the_eye(ctx: moderngl.Context) -> None:
    prairie, size, part = Prairie.load("whirlwind", ctx=ctx, live=False), (480, 270), (120, 270)
    prairie.advance(7.0)
    with testing.stage(ctx, size) as whole:
        camera = camera_at(prairie.scene.camera, 7.0, prairie.height_at)
        drawn = luma(whole.shot(prairie, camera)[:, 300:420].astype(np.uint8))
        view, projection = whole.matrices(camera)
        projection = cropped(projection, (300, 0), part, size)
        true = luma(draw_truth(prairie, view, projection, part, samples=SAMPLES).picture)
    prairie.release()
    assert rows(drawn) ** 2 < 1.5 * rows(true) ** 2


@pytest.fixture(scope="module")
def plain(load: Load) -> Prairie:
    return load("plain")


FAINT = 0.05
"""Largest amplitude of rows, relative to the deviation of blades: fainter ones are invisible among blades."""


def periodic(picture: Doubles, along: Doubles, spacing: float) -> float:
    """Return the amplitude of the lines' means at the period `spacing`; `along` (lines,) are their positions."""
    powers, window = list[float](), 40
    shape = np.hanning(window)
    for start in range(0, len(along) - window + 1, window // 2):
        lines = picture[start : start + window].mean(axis=1)
        level = np.poly1d(np.polyfit(np.arange(window), lines, 3))(np.arange(window))
        spectrum = np.abs(np.fft.rfft((lines - level) * shape)) ** 2
        each = np.fft.rfftfreq(window) * spacing / abs(np.gradient(along)[start + window // 2])
        powers.append(float(spectrum[(each > 0.8) & (each < 1.2)].sum()))
    # A sine of amplitude 1 has half the window's sum in one frequency, and half of that in the two beside it.
    return math.sqrt(float(np.mean(powers)) / 1.5) / (0.5 * float(shape.sum()))


@pytest.mark.slow
def test_f2_a_plain_from_twelve_metres_up_shows_neither_rows_of_strips_nor_where_they_end(
    ctx: moderngl.Context, plain: Prairie
) -> None:
    pitch, view, (width, height) = math.radians(-30.0), math.radians(40.0), (480, 270)
    up = pitch + np.arctan((1.0 - (2.0 * np.arange(height) + 1.0) / height) * math.tan(view / 2.0))
    quality = plain.site.quality
    away, spacing = 12.0 / np.tan(-up) / quality.patch, 1.0 / quality.strip_rings[0].strips
    near, far = (away > 6.0) & (away < 10.0), (away > 14.0) & (away < 20.0)
    swings, planted, lines = [], [], np.zeros(2)
    with testing.stage(ctx, (width, height)) as stage:
        for x in (-20.0, 0.0, 20.0):
            pictures = both(stage, plain, Camera((x, 12.0, 30.0), 0.0, pitch, view))
            lines += [unevenness(picture[far].mean(axis=1)) ** 2 for picture in pictures]
            seen, along = pictures[0][near], away[near]
            grain = float((seen - seen.mean(axis=1, keepdims=True)).std())
            swings.append(periodic(seen, along, spacing) / grain)
            rows = 2.0 * FAINT * grain * np.sin(2.0 * np.pi * along / spacing)
            planted.append(periodic(seen + rows[:, None], along, spacing) / grain)
    assert np.mean(swings) < FAINT < 0.8 * np.mean(planted), "rows of twice that are measured"
    assert lines[0] < 1.5 * lines[1]


@pytest.fixture(scope="module")
def carpet(load: Load) -> Prairie:
    """Prairie of carpet alone: through a narrow lens strips reach far."""
    return load("plain", lod="carpet", preset="low")


@pytest.mark.parametrize("heading", [pytest.param(0, marks=pytest.mark.slow), 40])
def test_g4_blades_of_the_carpet_stand_upright_whichever_way_they_are_seen(
    carpet: Prairie, narrow: Stage, heading: int
) -> None:
    """If they were stretched across the line of sight, brightness would change from line to line, not along lines."""
    yaw = math.radians(heading)
    camera = Camera((-30.0 * math.sin(yaw), 6.0, 30.0 * math.cos(yaw)), yaw, -0.16, math.radians(8.0))
    drawn, true = both(narrow, carpet, camera)
    distance = patch_distances(carpet, *narrow.matrices(camera), narrow.size)
    far = ((distance >= 8) & (distance <= 20)).all(axis=1)
    upright = [
        (np.diff(each[far], axis=1) ** 2).mean() / (np.diff(each[far], axis=0) ** 2).mean() for each in (drawn, true)
    ]
    assert far.sum() > 200
    assert 0.5 < upright[0] / upright[1] < 1.2


def test_x5_the_sky_does_not_shine_through_ground_behind_a_far_crest(ctx: moderngl.Context) -> None:
    prairie = Prairie.load("hills", ctx=ctx, live=False, preset="low")
    prairie.advance(3.0)
    with testing.stage(ctx, (960, 540)) as large:
        _, green, blue = np.moveaxis(large.shot(prairie), -1, 0)
    prairie.release()
    grass, sky = blue < 0.75 * green, blue > 0.85 * green
    under = np.logical_or.accumulate(grass, axis=0)[:, 150:230]
    assert grass.any()
    assert not (under & sky[:, 150:230]).any()


@pytest.mark.slow
def test_x5_the_sky_does_not_shine_through_a_crest_at_the_terrains_edge(ctx: moderngl.Context, wide: Stage) -> None:
    prairie = Prairie.load("saucer", ctx=ctx, live=False, preset="low")
    prairie.advance(5.0)
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    _, green, blue = np.moveaxis(wide.shot(prairie, camera), -1, 0)
    prairie.release()
    far = slice(round(0.11 * len(blue)), round(0.25 * len(blue)))
    assert (blue[: far.start] > green[: far.start]).mean() > 0.4, "above it is sky"
    assert not (blue[far] > green[far] - 5.0).any()


@pytest.mark.parametrize("lod", [pytest.param("auto", marks=pytest.mark.slow), "carpet"])
def test_the_ground_goes_on_to_the_horizon_beyond_the_terrains_edge(
    ctx: moderngl.Context, wide: Stage, lod: LodName
) -> None:
    prairie = Prairie.load(CAMERAS / "edge.yaml", ctx=ctx, live=False, lod=lod, preset="low")
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    seen = wide.shot(prairie, camera)
    true = draw_truth(prairie, *wide.matrices(camera), wide.size, samples=SAMPLES).picture
    prairie.release()
    height = wide.size[1]
    up = np.arctan((1.0 - (2.0 * np.arange(height) + 1.0) / height) * math.tan(camera.view / 2.0)) + camera.pitch
    for picture in (seen, np.asarray(true)):
        below = picture[up < -math.radians(1.0)]
        assert len(below) > height / 3
        assert (below[..., 2] < 0.9 * below[..., 1]).mean() > 0.999
