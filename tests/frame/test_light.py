"""Light on whole pictures: shadows, slopes away from the sun, clouds, nights, and what a host may ask for (F5, F10)."""

from collections.abc import Callable
from itertools import product

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Shade
from tallgrass.engine.camera import Camera
from tallgrass.engine.declared.light import Light
from tallgrass.systems.light.color import display, shown_as
from tallgrass.systems.light.daylight import daylight
from tallgrass.systems.light.repeating import CLOUDS_SIDE
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage

Load = Callable[..., Prairie]
Picture = NDArray[np.float64]

SCENE = """\
tallgrass: 2
terrain: { size: [60, 60] }
grass: { turf: { height: [0.3, 0.5], blades: 300 } }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 5, strips: 2, texel: 0.05 }]
  carpet_to: 16
  carpet: 64
"""
CAMERA = Camera((0.0, 9.0, 16.0), 0.0, -0.6, np.radians(40.0))
NOON = "light: { azimuth: 90, elevation: 60 }\n"


UP, BREEZE = 0.75, "wind: [{ kind: breeze, direction: 90, strength: 0.0, speed: 20, swing: 0 }]\n"
"""An elevation to look up at [rad], and clouds that drift."""


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (240, 160))


def bright(picture: Picture) -> NDArray[np.float64]:
    return np.asarray(picture.mean(axis=2, dtype=np.float64))


def test_what_a_game_puts_between_sun_and_grass_casts_a_shadow_there_and_nowhere_else(room: Stage, load: Load) -> None:
    prairie = load(SCENE + NOON)
    before = bright(room.shot(prairie, CAMERA))
    away = 4.0 / np.tan(np.radians(60.0))
    handle = prairie.world.create(Shade((away, 4.0, 0.0), 1.5))
    after = bright(room.shot(prairie, CAMERA))
    prairie.world.delete(handle)
    ratio, from_middle = after / before, np.hypot(*np.moveaxis(room.ground(CAMERA, level=0.2), -1, 0))
    assert ratio[from_middle < 0.8].mean() < 0.75
    assert ratio[from_middle > 4.5].min() > 0.99
    np.testing.assert_array_equal(bright(room.shot(prairie, CAMERA)), before)


def test_a_shade_of_arrays_is_one_of_tuples_also_where_it_replaces_another(room: Stage, load: Load) -> None:
    prairie, three = load(SCENE + NOON), np.array([0.0, 3.0, 0.0])
    made = [Shade(three, size=iter((2, 2, 2)), up=np.array([0, 1, 0], np.float32)) for _ in range(2)]
    assert made[0] == made[1] == Shade((0.0, 3.0, 0.0), size=(2.0, 2.0, 2.0))
    handle = prairie.world.create(made[0])
    for each in made:
        prairie.world.add(handle, each)
        room.shot(prairie, CAMERA)


@pytest.mark.parametrize("wrong", [(0.0, 1.0), (0.0, float("nan"), 0.0), None, "abc"])
def test_a_shade_that_is_nowhere_is_refused(wrong: object) -> None:
    with pytest.raises(ValueError, match="a shade's place is three finite numbers"):
        Shade(wrong, 1.0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="a shade's radius is above 0 m"):
        Shade((0.0, 0.0, 0.0), 0.0)
    with pytest.raises(ValueError, match="a shade's radius is above 0 m"):
        Shade((0.0, 0.0, 0.0), "a")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="a shade's height is above 0 m"):
        Shade((0.0, 0.0, 0.0), 1.0, -1.0)
    with pytest.raises(ValueError, match="a shade's up is a direction"):
        Shade((0.0, 0.0, 0.0), 1.0, 1.0, (0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("keys", "why"),
    [
        ({}, "a shade has a radius, or the size of a box"),
        ({"radius": 1.0, "capsule": True}, "a capsule's height is at least twice its radius, 1.0, not None"),
        (
            {"radius": 1.0, "height": 1.9, "capsule": True},
            "a capsule's height is at least twice its radius, 1.0, not 1.9",
        ),
        ({"size": (1.0, 0.0, 1.0)}, "a shade's size is three lengths above 0 m, not (1.0, 0.0, 1.0)"),
        ({"size": 2.0}, "a shade's size is three lengths above 0 m, not 2.0"),
        (
            {"size": (1.0, 1.0, 1.0), "radius": 1.0},
            "a shade with a size is a box: it has no radius, no height, and is no capsule",
        ),
        ({"size": (1.0, 1.0, 1.0), "yaw": float("inf")}, "a shade's yaw is finite, not inf"),
    ],
)
def test_a_shade_of_no_shape_is_refused(keys: dict[str, object], why: str) -> None:
    with pytest.raises(ValueError, match=r"shade|capsule") as caught:
        Shade((0.0, 0.0, 0.0), **keys)  # type: ignore[arg-type]
    assert str(caught.value) == why


FLAT, ROUND, TALL = 0.3, 3.0, 6.0
"""Heights of shades, each of radius 1.5 [m]."""


def test_f10_the_flatter_a_shade_the_shorter_is_its_shadow_under_a_low_sun(room: Stage, load: Load) -> None:
    prairie = load(SCENE + "light: { azimuth: 90, elevation: 25 }\n")
    before, above = bright(room.shot(prairie, CAMERA)), 4.0 * np.tan(np.radians(25.0))
    ground = room.ground(CAMERA, level=0.2)
    along, aside = ground[np.abs(ground[..., 1]) < 0.5][:, 0], ground[np.abs(ground[..., 0]) < 0.5][:, 1]
    lengths, widths = [], []
    for height in (FLAT, ROUND, TALL):
        handle = prairie.world.create(Shade((4.0, above, 0.0), 1.5, height))
        dark = before - bright(room.shot(prairie, CAMERA)) > 0.1 * before
        prairie.world.delete(handle)
        lengths.append(np.ptp(along[dark[np.abs(ground[..., 1]) < 0.5]]))
        widths.append(np.ptp(aside[dark[np.abs(ground[..., 0]) < 0.5]]))
    assert lengths[0] < 0.7 * lengths[1] < 0.7 * 0.8 * lengths[2]
    assert max(widths) < 1.35 * min(widths)


def test_a_shade_as_high_as_it_is_wide_is_a_ball_whichever_way_it_stands(room: Stage, load: Load) -> None:
    prairie, pictures = load(SCENE + NOON), []
    for shape in ((), (3.0,), (3.0, (1.0, -2.0, 0.5))):
        handle = prairie.world.create(Shade((2.3, 4.0, 0.0), 1.5, *shape))
        pictures.append(room.shot(prairie, CAMERA))
        prairie.world.delete(handle)
    np.testing.assert_allclose(pictures[1:], pictures[:1] * 2, atol=1.0)


def test_of_many_shades_all_count_whose_shadows_are_seen(room: Stage, load: Load) -> None:
    prairie = load(SCENE + NOON)
    before = bright(room.shot(prairie, CAMERA))
    far = [prairie.world.create(Shade((0.0, 4.0, 400.0 + number), 1.0)) for number in range(300)]
    assert (bright(room.shot(prairie, CAMERA)) == before).all()
    near = [prairie.world.create(Shade((x, 4.0, z), 0.5)) for x in range(-4, 7) for z in range(-8, 4)]
    after = bright(room.shot(prairie, CAMERA))
    for entity in (*far, *near):
        prairie.world.delete(entity)
    ground = np.add(room.ground(CAMERA, level=0.2), (4.0 / np.tan(np.radians(60.0)), 0.0))
    shaded = np.abs(ground - np.rint(ground)).max(axis=-1) < 0.2
    inside = (np.abs(ground[..., 0] - 1.0) < 4.0) & (np.abs(ground[..., 1] + 2.0) < 5.0)
    assert (after[shaded & inside] < 0.8 * before[shaded & inside]).mean() > 0.95


def test_a_ridge_casts_its_shadow_behind_it_and_light_comes_back_with_distance(
    room: Stage, load: Load, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("ridge")
    x = np.arange(61, dtype=np.float32) - 30.0
    np.save(folder / "ridge.npy", np.tile(5.0 * np.exp(-((x + 8.0) ** 2) / 6.0), (61, 1)).astype(np.float32))
    low = "light: { azimuth: -90, elevation: 25 }\n"
    text = SCENE.replace("{ size: [60, 60] }", f"{{ heights: {folder / 'ridge.npy'}, scale: 1 }}") + low
    prairie = load(text)
    picture = bright(room.shot(prairie, Camera((6.0, 14.0, 16.0), 0.0, -0.7, np.radians(50.0))))
    ground = room.ground(Camera((6.0, 14.0, 16.0), 0.0, -0.7, np.radians(50.0)), level=0.2)
    near = np.abs(ground[..., 1]) < 8.0
    shaded = picture[near & (ground[..., 0] > -3.0) & (ground[..., 0] < 0.0)].mean()
    lit = picture[near & (ground[..., 0] > 8.0) & (ground[..., 0] < 12.0)].mean()
    assert shaded < 0.8 * lit


def test_a_slope_away_from_the_sun_is_not_crushed(
    room: Stage, load: Load, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("roof")
    x = np.abs(np.arange(61, dtype=np.float32) - 30.0)
    np.save(folder / "roof.npy", np.tile((30.0 - x) * np.tan(np.radians(35.0)), (61, 1)).astype(np.float32))
    text = SCENE.replace("{ size: [60, 60] }", f"{{ heights: {folder / 'roof.npy'}, scale: 1 }}")
    prairie = load(text + "light: { azimuth: 90, elevation: 35 }\n")
    top = 30.0 * np.tan(np.radians(35.0))
    views = [Camera((side * 15.0, top + 4.0, 0.0), 0.0, -1.2, np.radians(30.0)) for side in (1.0, -1.0)]
    facing, away = ((room.shot(prairie, view).astype(np.float64) / 255.0) ** 2.2 for view in views)
    assert away.mean() > 0.12 * facing.mean()
    assert away.mean() < 0.9 * facing.mean()


def test_clouds_cast_shadows_that_drift_with_the_breeze(room: Stage, load: Load) -> None:
    clear, cloudy = load(SCENE + NOON + BREEZE), load(SCENE + NOON.replace("60 }", "60, clouds: 0.6 }") + BREEZE)
    ratios = []
    for _ in range(6):
        ratios.append(bright(room.shot(cloudy, CAMERA)) / bright(room.shot(clear, CAMERA)))
        for prairie in (clear, cloudy):
            prairie.advance(4.0)
    means = [ratio.mean() for ratio in ratios]
    assert max(means) - min(means) > 0.05


def sky_over(room: Stage, load: Load, clouds: float, *, up: float = UP, azimuth: float = 90.0) -> Picture:
    """What is seen of the sky over a noon, by rows from the top, shape (n, 3)."""
    prairie = load(SCENE + f"light: {{ azimuth: {azimuth}, elevation: 60, clouds: {clouds} }}")
    return room.shot(prairie, Camera((0.0, 2.0, 0.0), 0.0, up, np.radians(50.0))).reshape(-1, 3)


def test_f5_an_overcast_sky_is_grey_all_over_down_to_the_horizon(room: Stage, load: Load) -> None:
    for up in (0.45, 1.3):
        sky, clear = sky_over(room, load, 1.0, up=up), sky_over(room, load, 0.0, up=up)
        assert np.ptp(sky, axis=1).max() < 0.35 * np.ptp(clear, axis=1).max()
        assert np.ptp(bright(sky[None])) < 90.0


@pytest.mark.parametrize("elevation", [15.0, 45.0])
def test_f5_an_overcast_sky_is_as_bright_as_the_ground_below_is_lit(room: Stage, load: Load, elevation: float) -> None:
    """An eighth of that light has come up from the ground."""
    prairie, seen = load(f"{SCENE}light: {{ elevation: {elevation}, clouds: 1 }}"), []
    for x in np.arange(3) * CLOUDS_SIDE / 3.0:
        up = Camera((float(x), 2.0, 0.0), 0.0, 1.5, np.radians(60.0))
        seen.append(shown_as(room.shot(prairie, up) / 255.0).mean(axis=(0, 1)))
    sky = daylight(Light(elevation=elevation, clouds=1.0)).sky
    np.testing.assert_allclose(np.mean(seen, axis=0), sky.down, rtol=0.04)
    assert sky.ground.mean() > 0.15 * sky.down.mean()


def test_f5_clouds_are_brighter_on_the_side_of_the_sun(room: Stage, load: Load) -> None:
    """Where a cloud thins out towards the sun, to the right, it is brighter than with the sun on its left."""
    sides = [load(f"{SCENE}light: {{ azimuth: {side}, elevation: 45, clouds: 0.5 }}") for side in (90, -90)]
    views = [Camera((x, 2.0, 0.0), 0.0, 1.3, np.radians(50.0)) for x in np.arange(4) * CLOUDS_SIDE / 4.0]
    skies = [np.stack([room.shot(side, view) for view in views]) for side in sides]
    blue, (right, left) = sum(np.ptp(sky, axis=3) for sky in skies), (sky.mean(axis=3) for sky in skies)
    way = 16  # pixels
    thins = blue[..., 2 * way :] - blue[..., : -2 * way]
    brighter = (right - left)[..., way:-way]
    brighter -= brighter.mean(axis=(0, 1))  # about the sun all the sky is
    assert np.corrcoef(thins.ravel(), brighter.ravel())[0, 1] > 0.15


def test_f5_under_an_overcast_sky_nothing_casts_a_shadow(room: Stage, load: Load) -> None:
    prairie = load(SCENE + NOON.replace("60 }", "60, clouds: 1 }"))
    before = bright(room.shot(prairie, CAMERA))
    prairie.world.create(Shade((4.0 / np.tan(np.radians(60.0)), 4.0, 0.0), 1.5))
    assert np.abs(bright(room.shot(prairie, CAMERA)) - before).max() <= 1.0


def test_f5_clouds_have_soft_edges_and_dark_undersides(room: Stage, load: Load) -> None:
    sky, clear = sky_over(room, load, 0.4), sky_over(room, load, 0.0)
    blue = np.ptp(sky, axis=1) / np.ptp(clear, axis=1)
    clouds, edges = bright(sky[None])[0][blue < 0.25], (blue > 0.25) & (blue < 0.85)
    assert np.percentile(clouds, 10) < 0.8 * np.percentile(clouds, 90)
    assert edges.mean() > 0.15


@pytest.mark.parametrize("cover", [0.3, 0.5])
def test_f5_bases_of_clouds_are_about_a_third_as_bright_as_their_sunlit_sides(
    room: Stage, load: Load, cover: float
) -> None:
    prairie = load(f"{SCENE}light: {{ azimuth: 180, elevation: 45, clouds: {cover} }}")
    views = (Camera((x, 2.0, 0.0), 0.0, 0.6, np.radians(50.0)) for x in np.arange(4) * CLOUDS_SIDE / 4.0)
    sky = shown_as(np.stack([room.shot(prairie, view) for view in views]) / 255.0).reshape(-1, 3)
    clouds = bright(sky[None])[0][np.ptp(sky, axis=1) < 0.25 * sky.max(axis=1)]
    assert 0.25 < np.percentile(clouds, 5) / np.percentile(clouds, 95) < 0.43


def grown(mask: NDArray[np.bool_], pixels: int) -> NDArray[np.bool_]:
    """Return a mask that reaches so many pixels farther along rows and columns."""
    for axis in (0, 1):
        mask = np.logical_or.reduce([np.roll(mask, by, axis) for by in range(-pixels, pixels + 1)])
    return mask


@pytest.mark.parametrize(("pitch", "most"), [(UP, 0.042), (0.3, 0.06)])
def test_f5_hardly_any_puffs_float_beside_clouds(room: Stage, load: Load, pitch: float, most: float) -> None:
    """What is narrower than 7 pixels, and farther than 3 from what is broader, is a puff or a scrap of cloud.

    With billows as strong outside clouds as inside they were 0.05 and 0.07 of all clouds.
    """
    skies, puffs = [load(f"{SCENE}light: {{ elevation: 60, clouds: {part} }}") for part in (0.1, 0.0)], []
    for x in np.arange(4) * CLOUDS_SIDE / 4.0:
        up = Camera((float(x), 2.0, 0.0), 0.0, pitch, np.radians(40.0))
        cloudy, clear = (np.ptp(room.shot(sky, up), axis=2) for sky in skies)
        clouds = cloudy < 0.6 * clear
        broad = grown(~grown(~clouds, 3), 6)
        puffs.append((clouds & ~broad).sum() / clouds.sum())
    assert np.mean(puffs) < most


def test_f5_tops_of_clouds_do_not_twinkle_as_they_drift(room: Stage, load: Load) -> None:
    """Where they were cut off, five times as many pixels changed."""
    prairie, changed = load(f"{SCENE}{BREEZE}light: {{ elevation: 20, clouds: 0.5 }}\n"), []
    before = None
    for _ in range(12):
        sky = room.shot(prairie, Camera((0.0, 2.0, 0.0), 0.0, 0.35, np.radians(50.0))).astype(int)
        if before is not None:
            changed.append(np.mean(np.abs(sky - before).max(axis=2) > 24))
        before = sky
        prairie.advance(1.0 / 600.0)  # 5 cm
    assert np.mean(changed) < 4e-5


def test_f5_by_night_no_side_of_a_cloud_is_as_if_the_sun_lit_it(room: Stage, load: Load) -> None:
    skies = [load(f"{SCENE}light: {{ hour: 1, clouds: {part} }}") for part in (1.0, 0.4)]
    up = Camera((0.0, 2.0, 0.0), 0.0, 0.5, np.radians(50.0))
    overcast, cloudy = (bright(room.shot(sky, up)) for sky in skies)
    assert cloudy.min() > 0.8 * overcast.min()


@pytest.mark.parametrize(("cover", "off"), [pytest.param(0.2, 0.02, marks=pytest.mark.slow), (0.5, 0.045)])
def test_f5_clouds_hide_as_much_of_the_sky_as_a_scene_says(room: Stage, load: Load, cover: float, off: float) -> None:
    """Over all of their square: half of the blue is gone where they hide half of what is behind.

    With upright sides and level tops, they hid twice as much too much.
    """
    skies = [load(f"{SCENE}light: {{ elevation: 60, clouds: {part} }}") for part in (cover, 0.0)]
    hidden = []
    for x, z in product(np.arange(4) * CLOUDS_SIDE / 4.0, repeat=2):
        up = Camera((float(x), 2.0, float(z)), 0.0, 1.5, np.radians(60.0))
        cloudy, clear = (np.ptp(room.shot(sky, up), axis=2) for sky in skies)
        hidden.append(np.mean(cloudy < 0.5 * clear))
    assert np.mean(hidden) == pytest.approx(cover, abs=off)


def test_f5_heaps_far_off_are_no_stacks_of_slices(room: Stage, load: Load) -> None:
    """Where they were, a line going up met cloud and sky by turns more often."""
    sky = np.ptp(sky_over(room, load, 0.3, up=0.3), axis=1).reshape(*room.size[::-1])[40:120]
    assert (np.diff(sky < 50.0, axis=0) != 0).sum(axis=0).mean() < 6.6


def test_f10_the_sun_is_hidden_where_a_cloud_casts_its_shadow(ctx: moderngl.Context, load: Load) -> None:
    """It is looked at from many places on the ground, and each is looked at from above."""
    stage, light = Stage(ctx, (24, 24)), "azimuth: 90, elevation: 60, exposure: -4"
    clear, cloudy = (load(f"{SCENE}{BREEZE}light: {{ {light}, clouds: {part} }}\n") for part in (0.0, 0.5))
    sun = Camera((0.0, 1.0, 0.0), np.pi / 2.0, np.radians(60.0), np.radians(0.3))
    ground = Camera((0.0, 9.0, 0.0), 0.0, -1.5, np.radians(6.0))
    due = [stage.shot(clear, camera).mean() for camera in (sun, ground)]
    seen = []
    for _ in range(24):
        seen.append([stage.shot(cloudy, camera).mean() for camera in (sun, ground)])
        cloudy.advance(1.3)
    disc, lit = (np.array(seen) / due).T
    assert disc.min() < 0.35
    assert disc.max() > 0.9
    assert np.corrcoef(disc, lit)[0, 1] > 0.85  # the sides of clouds hide it a little before their bases do


def test_f5_a_low_sun_is_hidden_by_the_clouds_that_are_seen_before_it(ctx: moderngl.Context, load: Load) -> None:
    """It once shone through all of them, half as bright as without, as they fade into the haze."""
    stage, light = Stage(ctx, (24, 24)), "azimuth: 90, elevation: 5, exposure: -3"
    clear, cloudy = (load(f"{SCENE}light: {{ {light}, clouds: {part} }}\n") for part in (0.0, 0.5))
    places = np.arange(24) * CLOUDS_SIDE / 24.0
    suns = [Camera((0.0, 1.0, z), np.pi / 2.0, np.radians(5.0), np.radians(0.3)) for z in places]
    seen = [stage.shot(cloudy, sun).mean() / stage.shot(clear, sun).mean() for sun in suns]
    assert np.median(seen) < 0.4
    assert max(seen) > 0.9


def test_f5_bright_edges_of_clouds_before_the_sun_fade_without_a_line(room: Stage, load: Load) -> None:
    """Neighbouring pixels inside of clouds are alike; such a line once followed all of their outline."""
    prairie, steps = load(f"{SCENE}light: {{ azimuth: 0, elevation: 45, clouds: 0.4 }}"), []
    for x in np.arange(4) * CLOUDS_SIDE / 4.0:
        sky = room.shot(prairie, Camera((float(x), 2.0, 0.0), 0.0, 0.9, np.radians(40.0)))
        inside = np.ptp(sky, axis=2) < 16.0
        step = np.abs(np.diff(bright(sky), axis=1))[inside[:, 1:] & inside[:, :-1]]
        steps.append(np.quantile(step, 0.99))
    assert np.mean(steps) < 12.0  # of 255; 15.9 with the line


def test_a_night_is_dark_and_not_black(room: Stage, load: Load) -> None:
    day, night = (room.shot(load(SCENE + f"light: {{ hour: {hour} }}\n"), CAMERA) for hour in (12, 1))
    assert bright(night).mean() < 0.5 * bright(day).mean()
    assert (night.max(axis=2) > 2).mean() > 0.99


def test_a_linear_prairie_draws_the_radiance_that_others_show(ctx: moderngl.Context, load: Load) -> None:
    size = 96, 64
    shown = Stage(ctx, size).shot(load(SCENE + NOON), CAMERA)
    prairie = load(SCENE + NOON, linear=True)
    target = ctx.framebuffer([ctx.texture(size, 4, dtype="f4")], ctx.depth_renderbuffer(size))
    target.use()
    target.clear()
    prairie.draw(*Stage(ctx, size).matrices(CAMERA))
    radiance = np.frombuffer(target.read(components=3, dtype="f4"), np.float32).reshape(size[1], size[0], 3)[::-1]
    told = display(radiance) * 255.0
    assert np.abs(told - shown).mean() < 8.0
    sky = np.zeros(size[::-1], np.bool_)
    sky[:2] = shown[:2, :, 2] > shown[:2, :, 1] + 20
    np.testing.assert_allclose(told[sky], shown[sky], atol=2.0)


def test_scenes_of_format_1_keep_their_sky(room: Stage, load: Load) -> None:
    old = load(SCENE.replace("tallgrass: 2", "tallgrass: 1") + NOON)
    up = room.shot(old, Camera((0.0, 2.0, 0.0), 0.0, 1.5, np.radians(30.0)))
    middle = up[60:100, 100:140].reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(middle, (0x4F, 0x86, 0xC6), atol=30)
