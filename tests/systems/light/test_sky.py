"""Sun, air and sky (F5)."""

from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tallgrass.engine.camera import Camera, forward, projection_matrix, view_matrix, view_of
from tallgrass.engine.declared.light import Light
from tallgrass.systems.frame.block import rays
from tallgrass.systems.light.air import (
    EYE,
    GROUND,
    HEIGHTS,
    MOLECULES,
    MOLECULES_SCALE,
    OZONE,
    OZONE_HALF,
    multiple_scattering,
    sky_radiance,
    sunlight,
)
from tallgrass.systems.light.billows import SIDE as BLOCK_SIDE
from tallgrass.systems.light.billows import STEEPEST as STEEPEST_BILLOW
from tallgrass.systems.light.billows import billow_levels
from tallgrass.systems.light.clouds import (
    DIFFUSION,
    FADE,
    FARTHEST_ASIDE,
    GROUND_ALBEDO,
    SUNLIT,
    clouds_of,
    from_below,
    in_shade,
    sent_down,
    sun_scattered,
)
from tallgrass.systems.light.cloudscape import COARSE_ROWS, STEP_LENGTHS, STEP_OUTSIDE, cloud_pixel, rows_of_sky
from tallgrass.systems.light.color import display, luminance
from tallgrass.systems.light.daylight import daylight
from tallgrass.systems.light.heaps import FINEST, STEEPEST, heap_texels
from tallgrass.systems.light.repeating import CLOUDS_SIDE, SIDE, cloud_map
from tallgrass.systems.light.sky import COLUMNS, NIGHT, ROWS, SKY_BRIGHTENED, SUN, Sky, clear_air, scattered, sky_of
from tallgrass.systems.light.sun import sun_at, to_sun, transmitted


def the_sky(light: Light) -> Sky:
    return sky_of(light, clear_air(sun_at(light)[1], light.turbidity), np.zeros(3))


lights = st.builds(
    Light,
    azimuth=st.floats(-360, 360),
    elevation=st.floats(0, 90),
    strength=st.floats(0, 10),
    turbidity=st.floats(2, 9),
)


@given(lights)
def test_the_sun_stands_where_the_scene_says(light: Light) -> None:
    sun = to_sun(light)
    np.testing.assert_allclose(sun, forward(radians(light.azimuth), radians(light.elevation)), atol=1e-9)
    assert np.linalg.norm(sun) == pytest.approx(1.0)


@given(st.floats(-66.0, 66.0), st.integers(1, 365))
def test_at_noon_the_sun_stands_highest_and_over_the_meridian(latitude: float, day: int) -> None:
    noon, before, after = (sun_at(Light(hour=hour, day=day, latitude=latitude)) for hour in (12.0, 11.0, 13.0))
    assert noon[1] > before[1]
    assert noon[1] > after[1]
    assert before[1] == pytest.approx(after[1])
    assert min(abs(noon[0]), abs(abs(noon[0]) - 180.0)) < 1e-6


def test_the_sun_rises_in_the_east_and_a_midsummer_noon_is_as_high_as_it_should_be() -> None:
    azimuth, elevation = sun_at(Light(hour=6.0, day=80, latitude=48.0))
    assert azimuth == pytest.approx(90.0, abs=1.0)
    assert elevation == pytest.approx(0.0, abs=1.0)
    assert sun_at(Light(hour=12.0, day=172, latitude=48.0))[1] == pytest.approx(90.0 - 48.0 + 23.44, abs=0.1)


def test_an_hour_comes_before_an_own_azimuth_and_elevation() -> None:
    assert sun_at(Light(hour=9.0, azimuth=3.0, elevation=80.0)) == sun_at(Light(hour=9.0))


def test_the_lower_the_sun_the_less_of_it_comes_through_and_the_redder() -> None:
    through = np.array([transmitted(elevation, 2.6) for elevation in (60.0, 30.0, 10.0, 3.0, 0.5)])
    assert (np.diff(through, axis=0) < 0.0).all()
    assert (np.diff(through[:, 0] / through[:, 2]) > 0.0).all()


def test_no_sun_comes_from_below_the_horizon() -> None:
    assert transmitted(-6.0, 2.6) == pytest.approx(0.0, abs=1e-9)


def test_from_outside_the_air_all_of_the_sun_is_seen() -> None:
    np.testing.assert_allclose(sunlight(np.array([GROUND + 100.0]), np.array([1.0]), 2.6)[0], 1.0, atol=1e-3)


def test_light_that_is_scattered_again_makes_the_sky_brighter_and_never_endless() -> None:
    sun = np.array([0.0, 0.5, -np.sqrt(0.75)])
    up = np.array([[0.0, 1.0, 0.0], [0.0, 0.05, 1.0]])
    apart = (up @ sun)[:, None]
    once, often = (
        sky_radiance(up[:, 1], apart, 0.5, 2.6, multiple=each)
        for each in (None, multiple_scattering(sun, 2.6, heights=HEIGHTS))
    )
    assert (often > once).all()
    assert (often < 3.0 * once + 0.05).all()
    assert EYE > GROUND


@settings(max_examples=12)
@given(lights)
def test_every_sky_is_a_map_of_finite_colours_with_a_horizon(light: Light) -> None:
    sky = the_sky(light)
    assert sky.map.shape == (ROWS, COLUMNS, 3)
    assert np.isfinite(sky.map).all()
    assert (sky.map >= 0.0).all()
    cosine = np.cos(np.linspace(0.0, np.pi, COLUMNS)) * np.cos(np.radians(sun_at(light)[1]))
    np.testing.assert_allclose(scattered(cosine) @ sky.horizon, sky.map[0], atol=1e-9)


@pytest.mark.parametrize("turbidity", [2.0, 2.6, 6.0])
@pytest.mark.parametrize("hour", [4.0, 4.3, 4.5, 5.0, 6.0, 12.0])
def test_f5_all_round_the_horizon_a_sky_is_as_the_air_has_it(hour: float, turbidity: float) -> None:
    """A low sun's glow is narrow: smoothing once removed it, and left a teal band at 85 degrees from the sun."""
    light = Light(hour=hour, turbidity=turbidity)
    air = clear_air(sun_at(light)[1], turbidity)[0] * (SUN * SKY_BRIGHTENED) + NIGHT
    np.testing.assert_allclose(the_sky(light).map[0], air, rtol=0.08)


def test_a_clear_sky_is_blue_above_and_paler_below_and_brightest_about_the_sun() -> None:
    sky = the_sky(Light(elevation=35.0))
    zenith, horizon = sky.map[-1, 0], sky.map[0, -1]
    assert zenith[2] > 2.0 * zenith[0]
    assert horizon[0] / horizon[2] > zenith[0] / zenith[2]
    bright = luminance(sky.map)
    assert bright[8, 0] > bright[8, -1]


def test_gaps_between_many_clouds_show_blue_sky_but_where_clouds_fade_into_the_haze() -> None:
    sine = (np.arange(ROWS) / (ROWS - 1.0)) ** 2
    skies = (daylight(Light(elevation=30.0, clouds=cover)).sky.map for cover in (0.0, 0.85, 1.0))
    blue, left, clouds = (each[:, -1, 2] / each[:, -1, 0] - 1.0 for each in skies)  # away from the sun
    assert (left > 0.1 * blue)[sine > 2.0 * FADE[1]].all()
    assert (abs(left - clouds) < 0.1)[sine < FADE[1]].all()


@pytest.mark.parametrize(
    ("airs", "red", "blue"), [(1.0, 1.04, 0.89), (2.0, 1.09, 0.79), (5.6, 1.30, 0.52), (10.4, 1.65, 0.286)]
)
def test_f5_sunlight_has_the_colour_that_its_spectrum_has_on_a_screen(airs: float, red: float, blue: float) -> None:
    """By how much red and blue are left over green after so much air, relative to sunlight above it (ASTM G173)."""
    columns = MOLECULES_SCALE * MOLECULES + OZONE_HALF * OZONE
    left = np.exp(-airs * columns)
    np.testing.assert_allclose(left[[0, 2]] / left[1], (red, blue), rtol=0.05)


@pytest.mark.parametrize("elevation", [15.0, 30.0, 60.0])
def test_an_overcast_is_grey_and_hardly_blue_and_never_pink(elevation: float) -> None:
    red, green, blue = daylight(Light(elevation=elevation, clouds=1.0)).clouds
    assert 0.9 * green < red < green < blue < 1.2 * green


def test_a_setting_sun_colours_the_horizon_about_it() -> None:
    sky = the_sky(Light(elevation=1.0))
    assert sky.map[2, 0, 0] > 1.5 * sky.map[2, 0, 2]


def test_a_scene_may_give_the_colours_of_its_sky() -> None:
    sky = the_sky(Light(zenith="#203040", horizon="#c0a080"))
    np.testing.assert_allclose(display(sky.map[-1, 0]) * 255.0, (0x20, 0x30, 0x40), atol=2.0)
    np.testing.assert_allclose(display(sky.map[0, 5]) * 255.0, (0xC0, 0xA0, 0x80), atol=2.0)


def test_f5_a_higher_sun_gives_more_light_and_an_exposure_makes_up_for_a_part_of_it() -> None:
    low, high = daylight(Light(elevation=8.0)), daylight(Light(elevation=50.0))
    assert luminance(low.sun) < luminance(high.sun)
    ratio = luminance(high.sun) / luminance(low.sun)
    assert 1.05 < ratio < luminance(transmitted(50.0, 2.6)) / luminance(transmitted(8.0, 2.6))


@settings(max_examples=8)
@given(st.floats(-3.0, 3.0))
def test_exposure_counts_in_stops(stops: float) -> None:
    plain, other = daylight(Light()), daylight(Light(exposure=stops))
    np.testing.assert_allclose(other.sun, plain.sun * 2.0**stops)
    np.testing.assert_allclose(other.sky.map, plain.sky.map * 2.0**stops)
    assert other.exposure == pytest.approx(plain.exposure * 2.0**stops)


def test_nights_and_dusks_can_be_seen() -> None:
    dusk, night = (daylight(Light(hour=hour)) for hour in (20.3, 1.0))
    assert 0.0 < luminance(night.down) < luminance(dusk.down) < luminance(daylight(Light(hour=12.0)).down)
    assert display(night.sky.map[-1, 0]).max() > 0.12


def test_a_night_sky_is_darker_overhead_and_sends_as_much_light_in_all() -> None:
    """With the sun far below the horizon; by day that of the night is the same all over."""
    night, day = (Light(hour=hour, day=355) for hour in (0.0, 12.0))
    sky = the_sky(night)
    assert (sky.map[-1, 0] < 0.95 * NIGHT).all()
    assert luminance(sky.map[2, 0]) > 1.4 * luminance(sky.map[-1, 0])
    assert luminance(sky.down) == pytest.approx(luminance(NIGHT), rel=0.03)
    dark = day.model_copy(update={"strength": 0.0})
    np.testing.assert_allclose(the_sky(dark).map, np.broadcast_to(NIGHT, (ROWS, COLUMNS, 3)), rtol=1e-6)


def test_clouds_are_of_heaps_and_as_many_as_a_scene_says() -> None:
    dense = cloud_map(seed=3).astype(np.float64)
    assert np.bincount(dense.astype(int).ravel(), minlength=256).tolist() == [SIDE * SIDE // 256] * 256
    apart = 20  # texels: 100 m
    around = sum(np.roll(dense, way * apart, axis) for way in (-1, 1) for axis in (0, 1)) / 4.0
    half = (dense > 60.0) & (dense < 200.0)
    assert (around - dense)[half].std() > 22.0  # 18.9 without heaps


def test_a_line_of_sight_steps_over_hardly_any_cloud() -> None:
    """Along the flattest one, at the height of the bases: with outer steps four times as long it steps over 0.07."""
    excess, rows = cloud_map(seed=3) / 255.0 - clouds_of(0.3).edge, np.arange(SIDE)
    at, looked, way = np.zeros(SIDE), np.zeros((SIDE, SIDE), np.bool_), FARTHEST_ASIDE / CLOUDS_SIDE * SIDE
    while (at < SIDE - 1).any():
        before, start = excess[rows, at.astype(int)], at
        at = np.minimum(at + way * (STEP_LENGTHS[0] + np.clip(-STEP_OUTSIDE * before, 0.0, STEP_LENGTHS[1])), SIDE - 1)
        meets = np.maximum(before, excess[rows, at.astype(int)]) > 0.0
        looked |= meets[:, None] & (rows >= start[:, None]) & (rows <= at[:, None])
    clouds = excess > 0.0
    assert (clouds & ~looked).sum() < 0.003 * clouds.sum()


def test_outlines_of_clouds_are_frayed_at_all_sizes() -> None:
    """The smaller the boxes that count it, the longer an outline is: a smooth line keeps its length."""
    clouds, sides, counts = cloud_map(seed=3) > 178, (4, 8, 16, 32), []
    for side in sides:
        boxes = clouds.reshape(SIDE // side, side, SIDE // side, side)
        counts.append((boxes.any(axis=(1, 3)) & ~boxes.all(axis=(1, 3))).sum())
    dimension = -np.polyfit(np.log(sides), np.log(counts), 1)[0]
    assert dimension > 1.05  # 0.97 with heaps of one size


def test_texels_of_clouds_tell_their_density_and_how_they_rise() -> None:
    texels = heap_texels(seed=3) / 255.0
    density = texels[..., 0] + FINEST * (2.0 * texels[..., 3] - 1.0)
    np.testing.assert_allclose(density, cloud_map(seed=3) / 255.0, atol=0.01)
    for axis, rises in ((1, texels[..., 1]), (0, texels[..., 2])):
        due = (np.roll(texels[..., 0], -5, axis) - np.roll(texels[..., 0], 5, axis)) * (SIDE / 10.0)
        np.testing.assert_allclose(STEEPEST * (2.0 * rises - 1.0), due, atol=1.5)


def test_texels_of_billows_tell_how_they_rise_at_all_levels() -> None:
    levels = billow_levels()
    assert [len(each) for each in levels] == [BLOCK_SIDE >> level for level in range(len(levels))]
    assert 0.4 < levels[0][..., 0].mean() / 255.0 < 0.6
    for level in levels:
        texels = level / 255.0
        for axis, rises in ((2, texels[..., 1]), (1, texels[..., 2]), (0, texels[..., 3])):
            due = (np.roll(texels[..., 0], -1, axis) - np.roll(texels[..., 0], 1, axis)) * (0.5 * len(level))
            due = np.clip(due, -STEEPEST_BILLOW, STEEPEST_BILLOW)
            np.testing.assert_allclose(STEEPEST_BILLOW * (2.0 * rises - 1.0), due, atol=0.2)


@pytest.mark.parametrize("pitch", [-1.2, -0.3, 0.0, 0.2, 1.0])
@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_clouds_are_looked_for_in_all_rows_that_have_sky_and_hardly_more(pitch: float, turned: float) -> None:
    camera = Camera((0.0, 2.0, 0.0), 0.4, pitch, radians(50.0))
    view = view_of(view_matrix(camera), projection_matrix(camera.view, 1.6))
    row = np.zeros(1, [(name, "3f4") for name in ("ray_ahead", "ray_across", "ray_up")])
    row["ray_ahead"], row["ray_across"], row["ray_up"] = rays(view)
    row["ray_up"] *= turned
    up, across = np.meshgrid((np.arange(90) + 0.5) / 45.0 - 1.0, (np.arange(144) + 0.5) / 72.0 - 1.0, indexing="ij")
    ray = row["ray_ahead"][0] + across[..., None] * row["ray_across"][0] + up[..., None] * row["ray_up"][0]
    (sky,) = np.nonzero((ray[..., 1] > FADE[0] * np.linalg.norm(ray, axis=-1)).any(axis=1))
    first, end = rows_of_sky(row[0], 90)
    looked, seen = set(range(first, end)), set(sky.tolist())
    assert seen <= looked
    assert len(looked - seen) <= 5


def test_clouds_have_no_more_pixels_than_can_be_seen_of_them() -> None:
    heights = 1, 360, 540, 1080, 2160
    assert [cloud_pixel(height) for height in heights] == [1, 1, 2, 3, 6]
    assert [cloud_pixel(height, most_rows=COARSE_ROWS) for height in heights] == [1, 2, 3, 6, 12]


@pytest.mark.parametrize("cover", [0.05, 0.2, 0.4, 0.6])
def test_clouds_hide_as_much_of_the_sky_as_a_scene_says(cover: float) -> None:
    assert clouds_of(cover).hidden == pytest.approx(cover, abs=0.01)


@pytest.mark.parametrize("cover", [0.1, 0.4, 0.7])
def test_bases_of_the_highest_clouds_are_about_a_third_as_bright_as_their_sides_in_the_sun(cover: float) -> None:
    """Below a high sun, and a sky that sends a fifth as much light."""
    for elevation in (30.0, 45.0, 60.0):
        sun, high = np.ones(3), np.sin(np.radians(elevation))
        base = in_shade(sun, high, 0.2 * sun, clouds_of(cover)) / (1.0 + DIFFUSION)
        assert 0.25 < base[0] / SUNLIT < 0.4


@settings(max_examples=40)
@given(st.floats(0.01, 1.0), st.floats(0.0, 1.0))
def test_clouds_send_no_more_sunlight_than_they_get(cover: float, high: float) -> None:
    sun, clouds = np.ones(3), clouds_of(cover)
    assert sun_scattered(high, clouds.edge) <= 1.0
    sent = sent_down(sun, high, in_shade(sun, high, np.zeros(3), clouds), clouds)
    assert (sent > 0.0).all() or high < 0.01
    assert (sent <= SUNLIT * clouds.hidden).all()


@settings(max_examples=40)
@given(st.floats(0.01, 1.0), st.floats(0.0, 1.0))
def test_ground_below_clouds_takes_no_more_light_than_there_is(cover: float, high: float) -> None:
    sun, sky, clouds = np.ones(3), np.full(3, 0.2), clouds_of(cover)
    down = sky * (1.0 - clouds.hidden) + sent_down(sun, high, in_shade(sun, high, sky, clouds), clouds)
    ground = from_below(sun, high, down, clouds)
    due = SUNLIT * high * clouds.past * sun + down + ground * (clouds.hidden - clouds.scattered)
    np.testing.assert_allclose(ground, GROUND_ALBEDO * due)
    if clouds.edge <= 0.0:  # lone clouds gather light with their sides, too
        assert (due - ground <= SUNLIT * high * sun + sky).all()
