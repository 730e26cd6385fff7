"""The gentle breeze (W2, W5, W7)."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindSource
from tallgrass.systems.wind.blow import blowing, hear, lone_receivers, mean_index
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import Quarantine

breezes = st.builds(
    Breeze,
    direction=st.floats(-360, 360),
    strength=st.floats(0, 1),
    gustiness=st.floats(0, 1),
    speed=st.floats(0, 40),
    swing=st.floats(0, 0.5),
)
times = st.floats(0.0, 36000.0)
FIELD = np.random.default_rng(5).uniform(-60.0, 60.0, (4000, 2)).astype(np.float32)


def index(message: Floats) -> Floats:
    return np.asarray(np.linalg.norm(message, axis=1))


def moved(x: float) -> Floats:
    return FIELD + np.array([x, 0.0], np.float32)


def felt(breeze: Breeze, place: Floats = FIELD, *, time: float = 3.0, seed: int = 7) -> Floats:
    """Return the messages to grass at places, small oscillations included."""
    quarantine = Quarantine()
    winds = blowing([WindSource(breeze, "breeze")], quarantine, time=time, seed=seed)
    grass = Grass(np.zeros(len(place), np.intp), *np.ones((3, 1, 2), np.float32))
    message = hear(winds, lone_receivers(place, grass), quarantine, time=time, seed=seed)
    assert not quarantine.reasons
    return message


@given(breezes, times)
def test_w2_a_message_is_a_direction_times_an_index_from_0_to_1(breeze: Breeze, time: float) -> None:
    message = felt(breeze, FIELD[:300], time=time)
    assert message.shape == (300, 2)
    assert message.dtype == np.float32
    assert np.isfinite(message).all()
    assert index(message).max() <= 1.0 + 1e-6


@given(breezes, times)
def test_w7_its_mask_is_everywhere_and_always(breeze: Breeze, time: float) -> None:
    far = (FIELD[:50] * np.float32(1000)).astype(np.float32)
    assert (breeze.mask(far, time=time) == 1.0).all()


@pytest.mark.parametrize("strength", [0.2, 0.3, 0.5])
@pytest.mark.parametrize("gustiness", [0.0, 0.5])
def test_w7_over_the_field_its_mean_index_is_its_strength(strength: float, gustiness: float) -> None:
    breeze = Breeze(strength=strength, gustiness=gustiness)
    means = [float(index(felt(breeze, time=time)).mean()) for time in np.arange(0.0, 30.0, 1.7)]
    assert np.mean(means) == pytest.approx(strength, rel=0.06)


def test_w7_the_strongest_wind_that_blows_everywhere_says_how_far_grass_bends_in_the_mean() -> None:
    winds = [Breeze(strength=0.4), Breeze(strength=0.7, ease=2.0, start=1.0), Gust(strength=1.0)]
    sources = [WindSource(wind, wind.kind) for wind in winds]

    def bent(time: float, *of: int) -> float:
        return mean_index([sources[each] for each in of], Quarantine(), time=time)

    assert bent(4.0, 2) == 0.0
    assert bent(0.5, 0, 1, 2) == pytest.approx(0.4)
    assert bent(9.0, 0, 1, 2) == pytest.approx(0.7)
    assert 0.0 < bent(2.0, 1) < 0.7


def test_n8_a_wind_everywhere_whose_strength_is_no_number_is_quarantined_and_the_others_count() -> None:
    class Wordy(Breeze):
        strength: str = "gentle"  # type: ignore[assignment]

    odd, quarantine = WindSource(Wordy(), "odd"), Quarantine()
    assert mean_index([odd, WindSource(Breeze(strength=0.4), "breeze")], quarantine, time=1.0) == pytest.approx(0.4)
    assert "its strength" in quarantine.reasons[odd]


@pytest.mark.parametrize("direction", [0.0, 60.0, 90.0, -135.0])
def test_w7_grass_bends_where_the_breeze_blows_to(direction: float) -> None:
    mean = felt(Breeze(direction=direction)).mean(axis=0)
    off = np.arctan2(mean[0], -mean[1]) - np.radians(direction)
    assert abs((off + np.pi) % (2 * np.pi) - np.pi) < np.radians(12.0)


def test_w7_neighbours_feel_alike_and_distant_places_do_not() -> None:
    breeze = Breeze(strength=0.4, gustiness=0.8)
    here = felt(breeze)
    spread = index(here - here.mean(axis=0)).mean()

    def apart(distance: float) -> float:
        return float(index(felt(breeze, moved(distance)) - here).mean() / spread)

    changes = [apart(distance) for distance in (0.01, 0.05, 0.2, 0.8)]
    assert changes[0] < 0.05
    assert all(near < far for near, far in pairwise(changes))
    assert apart(40.0) > 1.0


def test_w7_no_two_places_swing_alike() -> None:
    breeze = Breeze(gustiness=0.0, swing=0.2)
    story = np.stack([index(felt(breeze, FIELD[:40], time=time)) for time in np.arange(0.0, 8.0, 0.05)])
    story -= story.mean(axis=0)
    alike = np.corrcoef(story.T) - np.eye(40)
    assert alike.max() < 0.999
    assert abs(alike.mean()) < 0.1
    assert story.std(axis=0).min() > 0.02


@given(breezes, times)
def test_w7_it_goes_on_smoothly_in_time(breeze: Breeze, time: float) -> None:
    dt = 0.002
    before, after = felt(breeze, FIELD[:200], time=time), felt(breeze, FIELD[:200], time=time + dt)
    fastest = 60.0 * breeze.swing + 8.0 * breeze.speed / 7.0 * breeze.gustiness + 1.0
    assert index(after - before).max() <= fastest * dt + 2e-3


def test_w7_its_rest_drifts_slowly_in_strength_and_angle() -> None:
    breeze = Breeze(strength=0.4, gustiness=0.6, swing=0.0)
    place = FIELD[:50]
    story = np.stack([felt(breeze, place, time=time) for time in np.arange(0.0, 40.0, 0.5)])
    strength, angle = np.linalg.norm(story, axis=2), np.unwrap(np.arctan2(story[..., 1], story[..., 0]), axis=0)
    assert np.ptp(strength, axis=0).min() > 0.1
    assert np.ptp(angle, axis=0).min() > 0.15
    assert np.abs(np.diff(strength, axis=0)).max() < 0.5 * np.ptp(strength, axis=0).max()


def test_w7_its_waves_travel_with_it() -> None:
    breeze = Breeze(direction=90.0, gustiness=0.8, swing=0.0, speed=5.0)
    later = felt(breeze, moved(5.0 * 1.5), time=11.5)
    np.testing.assert_allclose(later, felt(breeze, time=10.0), atol=2e-3)
    against = felt(breeze, moved(-5.0 * 1.5), time=11.5)
    assert index(against - felt(breeze, time=10.0)).mean() > 0.05


def test_w7_steady_and_without_swing_it_is_one_message_everywhere() -> None:
    message = felt(Breeze(direction=90.0, strength=0.25, gustiness=0.0, swing=0.0))
    np.testing.assert_allclose(message, np.broadcast_to([0.25, 0.0], message.shape), atol=1e-6)


@given(breezes, times, st.integers(0, 2**31 - 1))
def test_w5_it_keeps_nothing_between_calls(breeze: Breeze, time: float, seed: int) -> None:
    first = felt(breeze, FIELD[:100], time=time, seed=seed)
    felt(breeze, FIELD[100:], time=time + 1.0, seed=seed ^ 1)
    np.testing.assert_array_equal(felt(breeze, FIELD[:100], time=time, seed=seed), first)
    np.testing.assert_array_equal(felt(breeze, FIELD[40:60], time=time, seed=seed), first[40:60])


def test_another_seed_is_another_breeze() -> None:
    assert index(felt(Breeze(), seed=1) - felt(Breeze(), seed=2)).mean() > 0.05


def test_no_receivers_get_no_messages() -> None:
    assert felt(Breeze(), np.zeros((0, 2), np.float32)).shape == (0, 2)
