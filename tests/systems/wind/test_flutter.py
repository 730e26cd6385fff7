"""Small oscillations of random direction and strength on every wind (W10)."""

from collections.abc import Callable
from itertools import permutations
from math import cos, pi, radians, sin

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import WindPrimitive
from tallgrass.systems.light.repeating import CLOUDS_SIDE, FASTER, drifted
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.blow import mean_yaw
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.flutter import CARRIED, FREQUENCIES, flutter
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.turbulence import Turbulence
from tallgrass.systems.wind.whirlwind import Whirlwind

Feel = Callable[..., Floats]

FIELD = np.random.default_rng(4).uniform(-6.0, 6.0, (3000, 2)).astype(np.float32)
WINDS: list[WindPrimitive] = [
    Breeze(gustiness=0.0),
    Gust(position=[-10.0, 0.0], hold=3.0, ragged=0.0, strength=0.5),
    Whirlwind(radius=20.0, strength=0.5),
    Blast(outline=Shape(disc=20.0), strength=0.5),
]
kinds = pytest.mark.parametrize("wind", WINDS, ids=lambda wind: wind.kind)


def added(feel: Feel, wind: WindPrimitive, *, time: float = 2.5, place: Floats = FIELD, seed: int = 7) -> Floats:
    """Return the small oscillations in a wind's messages, relative to its `swing`."""
    still = feel(wind.model_copy(update={"swing": 0.0}), place=place, time=time, seed=seed)
    moving = feel(wind.model_copy(update={"swing": 0.1}), place=place, time=time, seed=seed)
    return np.asarray((moving - still) / np.float32(0.1))


@kinds
def test_w10_every_wind_swings_in_random_directions_and_strengths(feel: Feel, wind: WindPrimitive) -> None:
    extra = added(feel, wind)
    strength, angle = np.linalg.norm(extra, axis=1), np.arctan2(extra[:, 1], extra[:, 0])
    assert np.std(strength) > 0.15
    counted, _ = np.histogram(angle, bins=8, range=(-np.pi, np.pi))
    assert counted.min() > 0.04 * len(FIELD)


def test_w10_a_field_does_not_sway_in_step() -> None:
    wide = np.random.default_rng(8).uniform(-30.0, 30.0, (8000, 2)).astype(np.float32)
    means = np.stack([flutter(wide, time=0.1 * step, seed=7).mean(axis=0) for step in range(60)])
    own = flutter(wide, time=2.5, seed=7)
    assert np.sqrt((means**2).sum(axis=1).mean()) < 0.1 * np.sqrt((own**2).sum(axis=1).mean())


@kinds
def test_w10_nothing_is_uniform_under_any_wind(feel: Feel, wind: WindPrimitive) -> None:
    message = feel(wind, place=FIELD, time=2.5)
    assert len(np.unique(message, axis=0)) > 0.99 * len(FIELD)
    apart = np.linalg.norm(message[1:] - message[:-1], axis=1)
    assert np.quantile(apart, 0.05) > 0.01


@kinds
def test_w10_the_oscillations_go_on_in_time(feel: Feel, wind: WindPrimitive) -> None:
    story = np.stack([added(feel, wind, time=2.0 + 0.1 * step, place=FIELD[:50]) for step in range(20)])
    assert story.std(axis=0).min() > 0.03
    beats = (np.diff(np.sign(story[:, :, 0]), axis=0) != 0).sum(axis=0)
    assert np.median(beats) >= 2


@kinds
def test_w10_a_swing_of_0_is_the_prescribed_motion_exactly(feel: Feel, wind: WindPrimitive) -> None:
    """Then messages are those of the wind's own action."""
    still = wind.model_copy(update={"swing": 0.0, "weight": 1.0})
    np.testing.assert_array_equal(feel(still, place=FIELD, time=2.5), feel(still, place=FIELD, time=2.5))
    assert (added(feel, wind) != 0.0).any(axis=1).mean() > 0.99
    steady = Breeze(gustiness=0.0, swing=0.0, strength=0.25, direction=30.0)
    message = feel(steady, place=FIELD, time=2.5)
    assert len(np.unique(message, axis=0)) == 1
    np.testing.assert_allclose(message[0, 0], 0.25 * sin(radians(30.0)), atol=1e-7)


@kinds
def test_w10_a_wind_that_passes_does_not_drag_their_noise_along(feel: Feel, wind: WindPrimitive) -> None:
    here = added(feel, wind)
    if isinstance(wind, Breeze):
        np.testing.assert_allclose(here, flutter(FIELD, time=2.5, seed=7), atol=2e-5)
        return
    pose = wind.pose(time=2.5)
    moved = Pose(pose.x + 0.7, pose.z - 0.4, pose.yaw + 0.5)
    still, moving = (
        feel(wind.model_copy(update={"swing": swing}), place=FIELD, time=2.5, poses=[moved]) for swing in (0.0, 0.1)
    )
    both = (here != 0.0).any(axis=1) & (moving != still).any(axis=1)
    assert both.mean() > 0.8
    np.testing.assert_allclose(((moving - still) / np.float32(0.1))[both], here[both], atol=2e-5)


@kinds
def test_w10_swings_are_as_large_as_they_are_declared(feel: Feel, wind: WindPrimitive) -> None:
    extra = np.concatenate([added(feel, wind, time=2.0 + 0.31 * step) for step in range(5)])
    assert 0.3 < np.linalg.norm(extra, axis=1).mean() < 1.0
    assert np.abs(extra).max() <= 1.5 + 1e-4


def test_w10_another_seed_swings_otherwise(feel: Feel) -> None:
    one, other = (added(feel, WINDS[2], seed=seed) for seed in (1, 2))
    assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.2


@pytest.mark.parametrize("to", [0.0, 0.5 * pi, 2.3])
@pytest.mark.parametrize("time", [0.0, 1000.0, 36000.0])
def test_f8_the_mean_wind_carries_the_oscillations_along(to: float, time: float) -> None:
    """Compared after a whole period of the slowest beat, with their drift in that time."""
    later = 2.0 * pi / FREQUENCIES[1]
    before = flutter(FIELD, time=time, seed=7, yaw=to)[:, 1]
    away = np.linspace(-1.5, 1.5, 31)
    ahead = np.array([sin(to), -cos(to)])
    found = [
        np.corrcoef(before, flutter((FIELD + on * ahead).astype(np.float32), time=time + later, seed=7, yaw=to)[:, 1])
        for on in away
    ]
    best = np.array([each[0, 1] for each in found])
    assert away[best.argmax()] == pytest.approx(CARRIED * later, abs=0.35)
    assert best.max() > 0.45
    assert np.abs(best[np.abs(away) < 0.05]).max() < 0.5 * best.max(), "nothing stands on the spot"


@pytest.mark.parametrize("to", [0.0, 0.5 * pi])
def test_f8_the_oscillations_do_not_come_again_within_an_hour(to: float) -> None:
    """They are carried in any direction, also along an axis of the noise's table."""
    steps = np.arange(0.0, 2.0 * 3600.0, 0.5)
    story = np.stack([flutter(FIELD[:60], time=time, seed=7, yaw=to) for time in steps], axis=2)
    power = (np.abs(np.fft.rfft(story, 2 * len(steps), axis=2)) ** 2).mean(axis=0)
    correlation = np.fft.irfft(power)[:, : len(steps)] / (len(steps) - np.arange(len(steps)))
    within = correlation[:, 20 : 3600 * 2 + 1] / correlation[:, :1]
    assert np.abs(within).max() < 0.05


def test_f8_the_mean_wind_is_that_which_claims_least_of_those_everywhere() -> None:
    winds: list[WindPrimitive] = [
        Gust(direction=10.0, priority=-9),
        Turbulence(direction=200.0),
        Breeze(direction=-45.0),
        Breeze(direction=20.0, start=3.0),
    ]
    assert all(mean_yaw(order) == pytest.approx(radians(-45.0)) for order in permutations(winds))
    assert mean_yaw(winds[:2]) == pytest.approx(radians(200.0))
    assert mean_yaw(winds[:1]) == mean_yaw([]) == mean_yaw([Breeze()])


def test_clouds_go_with_the_same_mean_wind_as_the_oscillations() -> None:
    winds: list[WindPrimitive] = [Breeze(direction=20.0, start=3.0), Breeze(direction=90.0, speed=6.0)]
    assert mean_yaw(winds) == pytest.approx(radians(90.0))
    x, z = drifted(winds, 10.0)
    assert (x, z % 1.0) == pytest.approx((FASTER * 6.0 * 10.0 / CLOUDS_SIDE, 0.0), abs=1e-9)
    assert drifted(winds, 10.0) == drifted(winds[::-1], 10.0)
    assert drifted([Gust()], 10.0) == (0.0, 0.0)


def test_f8_after_ten_hours_they_go_on_as_smoothly_as_at_first() -> None:
    changes = [
        np.abs(flutter(FIELD, time=time + 1e-3, seed=7, yaw=1.0) - flutter(FIELD, time=time, seed=7, yaw=1.0)).max()
        for time in (0.0, 36000.0)
    ]
    assert max(changes) < 0.05
