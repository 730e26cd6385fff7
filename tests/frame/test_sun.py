"""A sun that moves while the prairie is drawn, by `shine` and by `hours_per_minute` (F5, F10)."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass import Lamp, Pose
from tallgrass.engine.camera import Camera
from tallgrass.systems.lamps.card import lamp_texels
from tallgrass.systems.light.color import linear
from tallgrass.systems.light.daylight import LEAF
from tallgrass.systems.light.lie import SAMPLES_A_FRAME
from tallgrass.systems.light.sky import PIECES
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, Stage

Load = Callable[..., Prairie]

SCENE = """\
tallgrass: 2
terrain: {{ heights: {heights}, scale: 1 }}
grass: {{ turf: {{ height: [0.3, 0.5], blades: 100 }} }}
light: {{ {light} }}
quality:
  models: 1
  blade_rings: [{{ to: 1, segments: 2 }}]
  strip_rings: [{{ to: 5, strips: 2, texel: 0.05 }}]
  carpet_to: 16
  carpet: 64
"""
CAMERA = Camera((6.0, 14.0, 16.0), 0.0, -0.4, np.radians(50.0))


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (64, 40))


@pytest.fixture(scope="module")
def ridge(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a map of a ridge across the terrain, on which a low sun casts a long shadow."""
    x = np.arange(201, dtype=np.float32) - 100.0
    heights = np.tile(6.0 * np.exp(-((x + 8.0) ** 2) / 6.0), (201, 1)).astype(np.float32)
    path = tmp_path_factory.mktemp("ridge") / "ridge.npy"
    np.save(path, heights)
    return path


@pytest.mark.slow
def test_f5_a_sun_that_was_moved_shines_as_if_the_scene_had_said_so(room: Stage, load: Load, ridge: Path) -> None:
    moved = load(SCENE.format(heights=ridge, light="azimuth: 60, elevation: 50"), lod="carpet")
    due = load(
        SCENE.format(heights=ridge, light="azimuth: -80, elevation: 18, clouds: 0.2, exposure: 0.5"), lod="carpet"
    )
    before = room.shot(moved, CAMERA)
    moved.shine(azimuth=-80.0, elevation=18.0, clouds=0.2, exposure=0.5)
    for _ in range(2 * PIECES + 1):
        after = room.shot(moved, CAMERA)
    picture = room.shot(due, CAMERA)
    assert np.abs(picture - before).mean() > 10.0
    assert np.abs(picture - after).max() <= 1.0


def test_f5_a_sun_that_leaps_at_once_brings_sky_and_shadows_along(room: Stage, load: Load, ridge: Path) -> None:
    night = "azimuth: -80, elevation: 3, clouds: 0.2"
    moved, due = load(SCENE.format(heights=ridge, light="hour: 12")), load(SCENE.format(heights=ridge, light=night))
    room.shot(moved, CAMERA)
    moved.shine(hour=None, azimuth=-80.0, elevation=3.0, clouds=0.2, at_once=True)
    assert np.abs(room.shot(moved, CAMERA) - room.shot(due, CAMERA)).max() <= 1.0


@pytest.mark.slow
def test_f5_light_goes_on_while_a_viewer_is_followed(room: Stage, load: Load, ridge: Path) -> None:
    drawn, followed = (load(SCENE.format(heights=ridge, light="elevation: 60"), lod="carpet") for _ in range(2))
    for prairie in (drawn, followed):
        room.shot(prairie, CAMERA)
        prairie.shine(elevation=4.0)
    for _ in range(2 * PIECES + 1):
        followed.follow(*room.matrices(CAMERA))
        due = room.shot(drawn, CAMERA)
    assert np.abs(room.shot(followed, CAMERA) - due).max() <= 1.0


@pytest.mark.slow
def test_f10_shadows_of_the_terrain_come_row_by_row_and_none_is_forgotten(room: Stage, load: Load, ridge: Path) -> None:
    prairie = load(SCENE.format(heights=ridge, light="azimuth: 90, elevation: 20"), lod="carpet")
    calls = []
    for frame in range(2 * PIECES + 5):
        if frame == 2:
            prairie.shine(azimuth=70.0)
        room.shot(prairie, CAMERA)
        assert prairie.painter is not None
        calls.append(prairie.painter.draw_calls)
    assert SAMPLES_A_FRAME < 201 * 201 < 2 * SAMPLES_A_FRAME
    rests, moves = [False] * PIECES, [True] * PIECES
    assert [call > calls[1] for call in calls] == [True, False, *rests, *moves, True, False, False]


def test_f5_hours_pass_in_a_scene_and_a_picture_follows_from_its_time_alone(
    ctx: moderngl.Context, room: Stage, ridge: Path, tmp_path: Path
) -> None:
    text = SCENE.format(heights=ridge, light="hour: 5, hours_per_minute: 60")
    (tmp_path / "day.yaml").write_text(text, "utf-8")
    whole, part = (Prairie.load(tmp_path / "day.yaml", ctx=ctx, live=False) for _ in range(2))
    for _ in range(6):
        frame = room.shot(whole, CAMERA)
        whole.advance(0.5)
    part.advance(2.5)
    np.testing.assert_array_equal(room.shot(part, CAMERA), frame)
    assert part.light.hour == pytest.approx(7.5)
    for prairie in (whole, part):
        prairie.release()


def test_f5_a_scene_that_is_read_again_keeps_the_light_of_a_game_until_its_own_changes(load: Load, ridge: Path) -> None:
    prairie = load(SCENE.format(heights=ridge, light="elevation: 40"))
    prairie.shine(elevation=10.0)
    prairie.reload()
    assert prairie.light.elevation == 10.0
    file = prairie.loaded.file
    file.write_text(file.read_text("utf-8").replace("elevation: 40", "elevation: 60"), "utf-8")
    prairie.reload()
    assert prairie.light.elevation == 60.0


@pytest.mark.parametrize("wrong", [{"brightness": 2.0}, {"elevation": 120.0}, {"hour": "noon"}])
def test_a_light_that_is_none_is_refused(load: Load, ridge: Path, wrong: dict[str, Any]) -> None:
    prairie = load(SCENE.format(heights=ridge, light="elevation: 40"))
    with pytest.raises(ValueError, match=next(iter(wrong))):
        prairie.shine(**wrong)
    assert prairie.light.elevation == 40.0


def test_a_game_is_told_of_the_sun_as_it_shines_now(load: Load) -> None:
    prairie = load(LITTLE + "light: { hour: 4.3 }\n")
    sun = prairie.sun
    assert prairie.light.elevation == pytest.approx(np.degrees(np.arcsin(sun.direction[1])), abs=1e-6)
    assert -5.0 < prairie.light.elevation < 10.0  # and not the 35 degrees of a scene without an hour
    heading = np.degrees(np.arctan2(sun.direction[0], -sun.direction[2]))
    assert prairie.light.azimuth == pytest.approx(heading, abs=1e-6)
    prairie.shine(hour=12.0)
    noon = prairie.sun
    assert noon.direction[1] > 0.8
    assert np.min(noon.colour) > np.max(noon.sky) > 0.0
    prairie.shine(hour=0.0)
    assert prairie.sun.direction[1] < 0.0
    assert prairie.sun.colour == (0.0, 0.0, 0.0)
    prairie.shine(clouds=0.5)  # what is told is no bad value where it is handed in again
    assert prairie.light.hour == 0.0


def test_a_game_is_told_what_shaders_are_told(room: Stage, load: Load) -> None:
    prairie = load(LITTLE + "light: { hour: 9.5, day: 100 }\n")
    room.shot(prairie, CAMERA)
    assert prairie.painter is not None
    told, sun = prairie.painter.record[0], prairie.sun
    np.testing.assert_allclose(sun.direction, told["sun"], atol=1e-6)
    np.testing.assert_allclose(np.multiply(sun.colour, LEAF), told["sunlight"], rtol=1e-5)
    np.testing.assert_allclose(sun.sky, told["skylight"], rtol=1e-5)
    (lamp,) = lamp_texels([(Lamp("#ff8040", candela=50.0), Pose(y=1.0))])
    colour = linear("#ff8040")
    seen = 50.0 * sun.candela * colour / (colour @ np.array((0.2126, 0.7152, 0.0722)))  # as the manual has it
    np.testing.assert_allclose(seen * LEAF, lamp[1, :3] * told["lamplight"], rtol=1e-3)
