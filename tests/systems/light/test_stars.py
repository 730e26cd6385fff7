"""Stars: how many there are of each magnitude, and how they turn (F5)."""

from math import cos, radians, sin

import numpy as np
import pytest

from tallgrass.engine.declared.light import Light
from tallgrass.systems.light.color import luminance
from tallgrass.systems.light.daylight import daylight
from tallgrass.systems.light.stars import star_field, starlight, turn_of
from tallgrass.systems.light.sun import to_sun


def turned(light: Light) -> np.ndarray:
    """Return directions in the scene to the stars of a seed, shape (n, 3)."""
    return star_field(seed=1)[:, :3] @ turn_of(light, to_sun(light)).T


@pytest.mark.parametrize(("magnitude", "count"), [(2.0, 40), (3.0, 150), (4.0, 530), (5.0, 1700), (6.0, 5000)])
def test_f5_there_are_as_many_stars_of_a_magnitude_as_in_the_world(magnitude: float, count: int) -> None:
    bright = luminance(star_field(seed=1)[:, 3:])
    assert np.count_nonzero(bright > 0.999 * 10.0 ** (-0.4 * magnitude)) == pytest.approx(count, rel=0.25)


def test_f5_stars_stand_evenly_over_the_whole_sky_and_those_of_another_seed_elsewhere() -> None:
    stars = star_field(seed=1)[:, :3]
    np.testing.assert_allclose(np.linalg.norm(stars, axis=1), 1.0, atol=1e-6)
    np.testing.assert_allclose(stars.mean(axis=0), 0.0, atol=0.03)
    np.testing.assert_allclose(stars.T @ stars / len(stars), np.eye(3) / 3.0, atol=0.02)
    assert np.abs(stars - star_field(seed=2)[:, :3]).max() > 1.0


@pytest.mark.parametrize("latitude", [-35.0, 0.0, 48.0, 80.0])
def test_f5_stars_turn_about_the_pole_with_the_sun(latitude: float) -> None:
    """So the sun keeps its place among them over a day. A sidereal day is four minutes short of a solar one."""
    lights = [Light(hour=hour, day=172, latitude=latitude) for hour in (0.0, 1.0, 7.0, 20.0)]
    turns = [turn_of(light, to_sun(light)) for light in lights]
    for turn in turns:
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(turn) == pytest.approx(1.0)
        np.testing.assert_allclose(turn[:, 2], (0.0, sin(radians(latitude)), -cos(radians(latitude))), atol=1e-12)
    suns = [turn.T @ to_sun(light) for light, turn in zip(lights, turns, strict=True)]
    np.testing.assert_allclose(suns, np.tile(suns[0], (len(suns), 1)), atol=1e-9)
    an_hour = turns[1] @ turns[0].T
    assert np.degrees(np.arccos((np.trace(an_hour) - 1.0) / 2.0)) == pytest.approx(15.0)
    tomorrow = turn_of(Light(hour=0.0, day=173, latitude=latitude), to_sun(lights[0]))
    assert np.degrees(np.arccos((np.trace(tomorrow @ turns[0].T) - 1.0) / 2.0)) == pytest.approx(360.0 / 365.24)


def test_f5_stars_rise_in_the_east_and_set_in_the_west() -> None:
    before, after = (turned(Light(hour=hour)) for hour in (0.0, 0.2))
    rising = (before[:, 1] < 0.0) & (after[:, 1] > 0.0)
    setting = (before[:, 1] > 0.0) & (after[:, 1] < 0.0)
    assert (before[rising, 0] > 0.0).all()
    assert (before[setting, 0] < 0.0).all()
    assert min(rising.sum(), setting.sum()) > 20


def test_f5_stars_come_out_between_civil_and_astronomical_twilight() -> None:
    """On day 80 at the equator the sun sinks by 15 degrees an hour."""
    light = {}
    for down in (0, 5, 7, 9, 12, 15, 18, 24):
        shown = daylight(Light(hour=18.0 + down / 15.0, day=80, latitude=0.0))
        light[down] = starlight(shown) / shown.exposure
    assert light[0] == light[5] == 0.0
    assert 0.0 < light[7] < light[9] < light[12] < light[15] < light[18]
    assert light[24] == pytest.approx(light[18], rel=0.01)
    assert light[12] == pytest.approx(0.075 * light[18], rel=0.1)  # 0.0006 lx of 0.008
