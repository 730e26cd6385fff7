"""Stars in whole pictures: by night, behind clouds and hills, in pictures of any size (F5)."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera
from tallgrass.engine.declared.light import Light
from tallgrass.systems.light.stars import Stars, star_field, turn_of
from tallgrass.systems.light.sun import to_sun
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage, looking

Load = Callable[..., Prairie]
Picture = NDArray[np.floating]
Shot = Callable[[Prairie, Camera], Picture]

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: rolling, seed: 5, size: [60, 60], feature: 20, scale: 8 }
grass: { turf: { height: [0.3, 0.5], blades: 300 } }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 5, strips: 2, texel: 0.05 }]
  carpet_to: 16
  carpet: 64
"""
UP = looking(0.0, 10.0, 0.0, pitch=40.0, view=50.0)
NIGHT = "light: { hour: 1 }\n"


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (480, 270))


def added(shot: Shot, prairie: Prairie, camera: Camera = UP) -> Picture:
    """Return what stars add to a picture, by channel."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Stars, "draw", lambda _: 0)
        without = shot(prairie, camera)
    return shot(prairie, camera) - without


def test_f5_stars_are_seen_by_night_and_none_by_day(room: Stage, load: Load) -> None:
    night, day = (added(room.shot, load(f"{SCENE}light: {{ hour: {hour} }}")).max(axis=2) for hour in (1, 12))
    assert not day.any()
    assert 20 < np.count_nonzero(night > 20.0) < 800
    assert np.count_nonzero(night > 2.0) < 0.05 * night.size


@pytest.mark.parametrize("hour", [0.0, 3.0])
def test_f5_stars_stand_in_the_picture_where_they_have_turned_to(room: Stage, load: Load, hour: float) -> None:
    """In a night of midwinter."""
    light = Light(hour=hour, day=355)
    night = added(room.shot, load(f"{SCENE}light: {{ hour: {hour}, day: 355 }}")).max(axis=2)
    toward = star_field(seed=5)[:200, :3] @ turn_of(light, to_sun(light)).T
    toward = toward[toward @ (0.0, np.sin(0.7), -np.cos(0.7)) > 0.5]
    across, down = room.project(UP, UP.position + 1e5 * toward).T
    seen = (across > 2) & (across < room.size[0] - 2) & (down > 2) & (down < 200)
    assert seen.sum() > 5
    assert (night[down[seen].astype(int), across[seen].astype(int)] > 8.0).all()


def test_f5_no_star_shines_through_an_overcast_or_a_hill(room: Stage, load: Load) -> None:
    assert not added(room.shot, load(f"{SCENE}light: {{ hour: 1, clouds: 1 }}")).any()
    prairie = load(SCENE.replace("scale: 8", "scale: 20") + NIGHT)

    def shot(prairie: Prairie, camera: Camera) -> Picture:
        room.begin()
        prairie.draw(*room.matrices(camera), parts=("sky", "ground"))
        return room.read()

    places = np.stack(np.meshgrid(np.arange(-20.0, 21.0), np.arange(-20.0, 21.0)), axis=-1).reshape(-1, 2)
    heights = prairie.height_at(places)
    x, z = places[heights.argmin()]
    night = added(shot, prairie, looking(x, float(heights.min()) + 0.3, z, pitch=24.0, view=40.0)).max(axis=2)
    hills = room.depth() < 1.0
    assert 0.2 < hills.mean() < 0.6  # the lowest tenth is below the horizon
    assert night[~hills].max() > 30.0
    assert not night[hills].any()


@pytest.fixture(scope="module")
def dark(load: Load) -> Prairie:
    return load(SCENE + NIGHT, linear=True)


def radiance(ctx: moderngl.Context, dark: Prairie, camera: Camera, width: int) -> Picture:
    """Return the radiance that stars add to a picture half as high as wide, top row last."""
    stage = Stage(ctx, (width, width // 2))
    stage.target = ctx.framebuffer([ctx.texture(stage.size, 4, dtype="f4")], stage.depth_map)

    def shot(prairie: Prairie, camera: Camera) -> Picture:
        stage.begin()
        prairie.draw(*stage.matrices(camera))
        return np.frombuffer(stage.target.read(components=3, dtype="f4"), np.float32).reshape(*stage.size[::-1], 3)

    return added(shot, dark, camera)


def test_f5_stars_are_as_bright_in_pictures_of_all_sizes_and_between_pixels(
    ctx: moderngl.Context, dark: Prairie
) -> None:
    ways = (240, 0.0), (480, 0.0), (480, 0.04), (480, 0.07)
    views = [(looking(0.0, 10.0, 0.0, yaw=turned, pitch=50.0, view=50.0), width) for width, turned in ways]
    light = [radiance(ctx, dark, *view).mean() for view in views]
    np.testing.assert_allclose(light, light[0], rtol=0.02)


def test_f5_a_star_has_the_same_light_all_over_the_picture(ctx: moderngl.Context, dark: Prairie) -> None:
    """The pixels at the edge see a smaller part of the sky each, so that it is brighter there."""
    light, aside, seen = Light(hour=1.0), 25.0, []
    toward = star_field(seed=5)[:20, :3] @ turn_of(light, to_sun(light)).T
    x, y, z = toward[toward[:, 1] > 0.5][0]
    yaw, pitch = np.degrees(np.arctan2(x, -z)), np.degrees(np.arcsin(y))
    for turned in (0.0, aside):
        picture = radiance(ctx, dark, looking(0.0, 10.0, 0.0, yaw=yaw, pitch=pitch - turned, view=70.0), 320)
        column, row = np.array((160, 80 + 80 * np.tan(np.radians(turned)) / np.tan(np.radians(35.0))), int)
        seen.append(picture[row - 3 : row + 4, column - 3 : column + 4].sum())
    assert seen[1] / seen[0] == pytest.approx(np.cos(np.radians(aside)) ** -3, rel=0.05)
