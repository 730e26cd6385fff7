"""Turbulence with the statistics of real wind (F8)."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tallgrass.components.arrays import Doubles, Floats
from tallgrass.components.wind import Grass, WindSource
from tallgrass.engine.noise import PERIOD, noise_table, power_left, smooth_noise
from tallgrass.systems.wind.blow import blowing, hear, lone_receivers
from tallgrass.systems.wind.eddies import CORNER, eddy_tables
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.turbulence import Turbulence

STILL = Grass(np.zeros(0, np.intp), *np.ones((3, 1, 2), np.float32))
WIND = Turbulence(direction=33.0, strength=0.3, intensity=0.2, scale=20.0, speed=8.0)
STEP, LONG = 1.0 / 64.0, 4096
"""Distance of places along the wind [length scales], and their number on a line."""

HOUR, WITHIN = 3600.0, 4.0 * 3600.0

turbulences = st.builds(
    Turbulence,
    direction=st.floats(-360, 360),
    strength=st.floats(0, 1),
    intensity=st.floats(0, 1),
    scale=st.floats(2, 1000),
    speed=st.floats(0, 40),
)
times = st.floats(0.0, 36000.0)
FIELD = np.random.default_rng(5).uniform(-60.0, 60.0, (400, 2)).astype(np.float32)


def felt(wind: Turbulence, place: Floats, *, time: float = 7.0, seed: int = 7) -> Floats:
    return wind.action(place, time=time, seed=seed, grass=STILL)


def axes(wind: Turbulence) -> Doubles:
    """Return the directions along a wind and to its right, shape (2, 2)."""
    turn = np.radians(wind.direction)
    return np.array([[np.sin(turn), -np.cos(turn)], [np.cos(turn), np.sin(turn)]])


def eddies(wind: Turbulence, place: Floats, *, time: float = 7.0, seed: int = 7) -> Doubles:
    """Return the fluctuation of a wind, along it and to its right, relative to its standard deviation, shape (2, n)."""
    message = axes(wind) @ felt(wind, place, time=time, seed=seed).T
    return np.asarray((message - [[wind.strength], [0.0]]) / (wind.strength * wind.intensity))


def lines(wind: Turbulence, count: int) -> Floats:
    """Return places on lines along a wind, from random places, shape (count * LONG, 2)."""
    start = np.random.default_rng(1).uniform(-3000.0, 3000.0, (count, 1, 2))
    way = STEP * wind.scale * np.arange(LONG)[:, None] * axes(wind)[0]
    return np.asarray((start + way).reshape(-1, 2), np.float32)


def correlation(story: Doubles, longest: int) -> Doubles:
    """Return the autocorrelation of rows (n, steps) for up to `longest` steps, shape (longest,)."""
    steps = story.shape[-1]
    power = (np.abs(np.fft.rfft(story, 2 * steps, axis=-1)) ** 2).mean(axis=0)
    found = np.fft.irfft(power)[:longest] / (steps - np.arange(longest))
    return np.asarray(found / found[0])


@pytest.fixture(scope="module")
def along() -> Doubles:
    """Fluctuations on lines of 64 length scales at one time, shape (2, 96, LONG)."""
    return eddies(WIND, lines(WIND, 96)).reshape(2, 96, LONG)


@pytest.fixture(scope="module")
def hours() -> Doubles:
    """Fluctuations at 24 places in four hours, second by second, shape (2, 24, seconds)."""
    place = np.random.default_rng(2).uniform(-2000.0, 2000.0, (24, 2)).astype(np.float32)
    return np.stack([eddies(WIND, place, time=time) for time in np.arange(0.0, WITHIN)], axis=2)


def test_f8_its_mean_is_as_strong_as_declared_and_goes_its_way(hours: Doubles) -> None:
    assert np.abs(hours.mean(axis=(1, 2))).max() < 0.05


def test_f8_its_variance_is_as_asked_over_the_ground_and_over_time(hours: Doubles) -> None:
    wide = np.random.default_rng(3).uniform(-3000.0, 3000.0, (60_000, 2)).astype(np.float32)
    for time in (0.0, 500.0, 9000.0):
        assert eddies(WIND, wide, time=time).std(axis=1) ** 2 == pytest.approx([1.0, 1.0], rel=0.03)
    assert hours.var(axis=(1, 2)) == pytest.approx([1.0, 1.0], rel=0.03)
    assert hours.var(axis=2) == pytest.approx(np.ones((2, 24)), rel=0.1), "at each place too"


@pytest.mark.parametrize("component", [0, 1])
def test_f8_its_spectrum_falls_by_five_thirds_over_a_decade(along: Doubles, component: int) -> None:
    """Wave numbers are 3 to 30 per length scale, for the components along the wind and across it."""
    power = (np.abs(np.fft.rfft(along[component] * np.hanning(LONG), axis=1)) ** 2).mean(axis=0)
    number = 2.0 * np.pi * np.fft.rfftfreq(LONG, STEP)
    edges = np.geomspace(3.0, 30.0, 13)
    mean = [power[(number >= low) & (number < high)].mean() for low, high in pairwise(edges)]
    slope, _ = np.polyfit(np.log(np.sqrt(edges[1:] * edges[:-1])), np.log(mean), 1)
    assert slope == pytest.approx(-5.0 / 3.0, abs=0.15)


def test_f8_its_spectrum_is_von_karmans(along: Doubles) -> None:
    """E(k) ~ (1 + (1.339 k L)^2)^(-5/6), from eddies of 6 length scales to those of a fifth of one."""
    power = (np.abs(np.fft.rfft(along[0] * np.hanning(LONG), axis=1)) ** 2).mean(axis=0)
    number = 2.0 * np.pi * np.fft.rfftfreq(LONG, STEP)
    edges = np.geomspace(1.0, 32.0, 11)
    held = [(number >= low) & (number < high) for low, high in pairwise(edges)]
    ratio = np.array([power[each].mean() for each in held])
    ratio /= [((1.0 + (1.339 * number[each]) ** 2) ** (-5.0 / 6.0)).mean() for each in held]
    assert np.abs(np.log(ratio / np.exp(np.log(ratio).mean()))).max() < 0.2


@pytest.mark.parametrize("wind", [Turbulence(direction=-70.0, scale=30.0, speed=9.0)])
def test_f8_what_grass_feels_in_time_falls_by_five_thirds_over_two_decades(wind: Turbulence) -> None:
    """Frequencies are 0.3 to 30 times the speed over the length scale; small oscillations are included."""
    place = np.random.default_rng(2).uniform(-500.0, 500.0, (64, 2)).astype(np.float32)
    pace, steps, quarantine = wind.speed / wind.scale, 2048, Quarantine()
    rate = 72.0 * pace
    receivers = lone_receivers(place, Grass(np.zeros(64, np.intp), *np.ones((3, 1, 2), np.float32)))
    to, source, story = np.radians(wind.direction), WindSource(wind, "turbulence"), []
    for time in np.arange(2 * steps) / rate:
        now = blowing([source], quarantine, time=float(time), seed=7)
        story.append(axes(wind)[0] @ hear(now, receivers, quarantine, time=float(time), seed=7, yaw=float(to)).T)
    parts = np.array(story, np.float64).T.reshape(64 * 2, steps)
    parts -= parts.mean(axis=1, keepdims=True)
    power = (np.abs(np.fft.rfft(parts * np.hanning(steps), axis=1)) ** 2).mean(axis=0)
    number = np.fft.rfftfreq(steps, 1.0 / rate) / pace
    edges = np.geomspace(0.3, 30.0, 15)
    mean = np.log([power[(number >= low) & (number < high)].mean() for low, high in pairwise(edges)])
    middle = np.log(np.sqrt(edges[1:] * edges[:-1]))
    assert np.polyfit(middle, mean, 1)[0] == pytest.approx(-5.0 / 3.0, abs=0.12)
    for part in (slice(5), slice(5, 10), slice(9, 14)):
        assert np.polyfit(middle[part], mean[part], 1)[0] == pytest.approx(-5.0 / 3.0, abs=0.45)


def test_f8_its_length_scale_is_as_asked_and_half_of_it_across(hours: Doubles) -> None:
    """The integral of the autocorrelation along the wind, by Taylor's hypothesis: five scales pass in 12.5 s."""
    wind = Turbulence(direction=33.0, strength=0.3, intensity=0.2, scale=80.0, speed=8.0)
    place = np.random.default_rng(2).uniform(-9000.0, 9000.0, (48, 2)).astype(np.float32)
    story = np.stack([eddies(wind, place, time=time) for time in np.arange(0.0, 3.0 * HOUR, 2.0)], axis=2)
    scales = np.arange(26) * 2.0 * wind.speed / wind.scale
    ahead, across = (np.trapezoid(correlation(part, 26), scales) for part in story)
    assert ahead == pytest.approx(1.0, rel=0.05)
    assert across == pytest.approx(0.5, rel=0.12)
    first, second = (np.trapezoid(correlation(part, 14), np.arange(14) * 0.4) for part in hours)
    assert first == pytest.approx(1.0, rel=0.05)
    assert second < 0.7 * first


@pytest.mark.parametrize("component", [0, 1])
def test_f8_it_does_not_repeat_within_an_hour(hours: Doubles, component: int) -> None:
    alike = correlation(hours[component], int(HOUR) + 1)
    assert np.abs(alike[15:]).max() < 0.05


@given(st.floats(0.0, 30000.0), st.floats(0.0, 0.4), st.sampled_from([-120.0, 0.0, 33.0, 90.0]))
@settings(max_examples=25)
def test_f8_it_is_carried_along_by_the_mean_wind(time: float, later: float, direction: float) -> None:
    wind = WIND.model_copy(update={"direction": direction})
    on = (FIELD + wind.speed * later * axes(wind)[0]).astype(np.float32)
    before, after = eddies(wind, FIELD, time=time), eddies(wind, on, time=time + later)
    assert np.sqrt(np.mean((after - before) ** 2)) < 0.02 + 0.5 * later
    if later > 0.1:
        stayed = eddies(wind, FIELD, time=time + later)
        assert np.mean((after - before) ** 2) < 0.5 * np.mean((stayed - before) ** 2)


@given(turbulences, times, st.integers(0, 2**31 - 1))
def test_w5_it_keeps_nothing_between_calls(wind: Turbulence, time: float, seed: int) -> None:
    first = felt(wind, FIELD, time=time, seed=seed)
    felt(wind, FIELD[100:], time=time + 1.0, seed=seed ^ 1)
    np.testing.assert_array_equal(felt(wind, FIELD, time=time, seed=seed), first)
    np.testing.assert_array_equal(felt(wind, FIELD[40:67], time=time, seed=seed), first[40:67])


@given(turbulences, times)
def test_w2_a_message_is_a_direction_times_an_index_from_0_to_1(wind: Turbulence, time: float) -> None:
    message = felt(wind, FIELD * np.float32(50.0), time=time)
    assert message.shape == FIELD.shape
    assert message.dtype == np.float32
    assert np.linalg.norm(message, axis=1).max() <= 1.0 + 1e-6


@given(turbulences, times)
def test_f8_it_goes_on_smoothly_in_time(wind: Turbulence, time: float) -> None:
    """Over a thousandth of the time in which the smallest eddies pass."""
    late = 1e-4 * wind.scale / max(wind.speed, 1.0)
    change = felt(wind, FIELD, time=time + late) - felt(wind, FIELD, time=time)
    assert np.linalg.norm(change, axis=1).max() < 0.02 * wind.strength * wind.intensity + 1e-3


def test_f8_without_intensity_it_is_one_message_everywhere() -> None:
    message = felt(Turbulence(direction=90.0, strength=0.25, intensity=0.0), FIELD)
    np.testing.assert_allclose(message, np.broadcast_to([0.25, 0.0], message.shape), atol=1e-6)


def test_another_seed_is_another_turbulence() -> None:
    one, other = (eddies(WIND, FIELD, seed=seed) for seed in (1, 2))
    assert np.abs(one - other).mean() > 0.5


def test_f8_the_halves_of_its_tables_are_alike_and_independent() -> None:
    """So the variance stays during a cross-fade of both; a table's mean is left out."""
    large, small = (table.reshape(-1, 4).astype(np.float64) for table in eddy_tables(5))
    for table in (large, small):
        alike = table.T @ table / len(table)
        np.testing.assert_allclose(alike[:2, :2], alike[2:, 2:], rtol=0.03, atol=0.02)
        np.testing.assert_allclose(np.diag(alike[:2, 2:]), 0.0, atol=0.02)
    with pytest.raises(ValueError, match="read-only"):
        eddy_tables(5)[0][0, 0, 0] = 0.0
    assert CORNER < 1.339


@given(st.integers(0, PERIOD - 1), st.floats(0.0, 1.0))
@settings(max_examples=20)
def test_what_is_left_of_a_wave_between_table_points_is_known(waves: int, phase: float) -> None:
    table = np.zeros_like(noise_table(0, 0))
    table[..., 0] = np.sin(2.0 * np.pi * (waves * np.arange(PERIOD) / PERIOD + phase))
    table[..., 1] = np.cos(2.0 * np.pi * (waves * np.arange(PERIOD) / PERIOD + phase))
    place = np.stack([np.arange(0.0, PERIOD, 1.0 / 16.0), np.zeros(16 * PERIOD)], axis=1).astype(np.float32)
    power = float((smooth_noise(table, place)[:, :2] ** 2).sum(axis=1).mean())
    assert power == pytest.approx(float(power_left(np.array(2.0 * np.pi * waves / PERIOD))), abs=1e-3)
