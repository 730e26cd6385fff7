"""Light that a game changes: when each part of it changes, and that it ends as asked for (F5)."""

import numpy as np
import pytest

from tallgrass.engine.declared.light import Light
from tallgrass.systems.light.daylight import Daylight, daylight
from tallgrass.systems.light.shining import Shining, Way
from tallgrass.systems.light.sky import PIECES

MORNING, EVENING = Light(hour=8.0), Light(hour=19.0, clouds=0.4, turbidity=4.0)


def drawn(light: Light = MORNING, *, live: bool = True) -> Shining:
    """Return the light of a prairie that has been drawn once."""
    shining = Shining(light, live=live)
    shining.step("main", time=0.0)
    return shining


def same(one: Daylight, other: Daylight) -> bool:
    """Return whether two lights are equal, except for rounding."""
    return one.direction == other.direction and all(
        np.allclose(a, b, rtol=1e-12)
        for a, b in ((one.sun, other.sun), (one.down, other.down), (one.sky.map, other.sky.map))
    )


def test_f5_sun_sky_and_exposure_stay_until_all_is_made_out_and_then_pass_on_together() -> None:
    shining, due, before = drawn(), daylight(EVENING), daylight(MORNING.model_copy(update={"clouds": 0.4}))
    shining.ask(EVENING, time=0.0)
    told = []
    for _ in range(2 * PIECES + 1):
        shining.step("main", time=0.0)
        told.append(shining.daylight)
    assert same(told[PIECES - 1], before)
    assert same(told[-1], due)
    numbers = [(light.sun[0], light.sky.map[-1, 0, 2], light.exposure) for light in told[PIECES - 1 :]]
    for start, *rest, end in zip(*numbers, strict=True):
        parts = (np.array(rest) - start) / (end - start)
        np.testing.assert_allclose(parts, np.arange(1, PIECES + 1) / PIECES, atol=1e-9)
    heights = [light.direction[1] for light in told[PIECES - 1 : -1]]
    assert (np.diff(heights) < 0.0).all()
    np.testing.assert_allclose(np.linalg.norm([light.direction for light in told], axis=1), 1.0)


@pytest.mark.parametrize("frames", [0, 1, 20, PIECES, PIECES + 9, 2 * PIECES + 5])
def test_n5_a_light_goes_on_as_it_would_have_from_any_frame(frames: int) -> None:
    one = drawn(Light(hour=8.0, hours_per_minute=30.0))
    one.ask(Light(hour=19.0, hours_per_minute=30.0), time=0.0)
    for frame in range(frames):
        one.step("main", time=frame / 60.0)
    asked, since = one.asked
    other = Shining(MORNING)
    way = Way.model_validate_json(one.way.model_dump_json())
    other.resume(asked, since=since, time=max(frames - 1, 0) / 60.0, way=way)
    for frame in range(frames, frames + PIECES + 3):
        for shining in (one, other):
            shining.step("main", time=frame / 60.0)
        assert one.daylight.direction == other.daylight.direction
        assert np.array_equal(one.daylight.sky.map, other.daylight.sky.map)
        assert one.daylight.exposure == other.daylight.exposure


def test_f5_a_light_that_has_come_rests() -> None:
    shining = drawn()
    before = shining.daylight
    for _ in range(3):
        shining.step("main", time=0.0)
    assert shining.daylight is before


def test_f5_a_sky_follows_a_sun_that_never_rests() -> None:
    shining, apart = drawn(), []
    for frame in range(1, 6 * PIECES):
        light = MORNING.model_copy(update={"hour": 8.0 + frame / 3600.0})
        shining.ask(light, time=0.0)
        shining.step("main", time=0.0)
        apart.append(np.abs(shining.daylight.sky.map - daylight(light).sky.map).max() if frame % 29 == 0 else 0.0)
    assert max(apart) < 0.01


def test_what_it_is_follows_from_the_calls_and_the_frames_alone() -> None:
    one, other = drawn(), drawn()
    for frame in range(2 * PIECES):
        for shining in (one, other):
            if frame in (3, 40):
                shining.ask(EVENING if frame == 3 else MORNING, time=0.0)
            shining.step("main", time=0.0)
        assert np.array_equal(one.daylight.sky.map, other.daylight.sky.map)


def test_all_who_look_in_a_frame_see_the_same_sky() -> None:
    shining, seen = drawn(), []
    shining.step("mirror", time=0.0)
    shining.ask(EVENING, time=0.0)
    for _ in range(PIECES + 4):
        for viewer in ("main", "mirror"):
            shining.step(viewer, time=0.0)
            seen.append(shining.daylight)
    assert all(a is b for a, b in zip(seen[::2], seen[1::2], strict=True))
    assert seen[-1] is not seen[-3]


@pytest.mark.parametrize("live", [True, False])
def test_before_the_first_frame_and_where_nobody_watches_it_comes_at_once(*, live: bool) -> None:
    shining = Shining(MORNING) if live else drawn(live=False)
    before = shining.leaps
    shining.ask(EVENING, time=0.0)
    shining.step("main", time=0.0)
    assert same(shining.daylight, daylight(EVENING))
    assert shining.leaps == before + 1


def test_f5_hours_pass_from_when_they_were_asked_for() -> None:
    shining = Shining(Light(hour=23.0, hours_per_minute=2.0))
    assert shining.at(45.0).hour == pytest.approx(0.5)
    shining.ask(Light(hour=6.0, hours_per_minute=60.0), time=45.0)
    assert shining.at(45.0).hour == 6.0
    assert shining.at(46.0).hour == pytest.approx(7.0)


def test_without_an_hour_none_passes() -> None:
    light = Light(elevation=20.0, hours_per_minute=2.0)
    assert Shining(light).at(30.0) is light
