"""The gust (W6, W12): a strip that travels, its profile the response over time."""

from collections.abc import Callable
from math import cos, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass
from tallgrass.systems.grow.record import Response
from tallgrass.systems.wind.gust import Gust

Feel = Callable[..., Floats]
Answer = Callable[..., Grass]

STILL = Gust(width=30, speed=6, reach=200, hold=2.0, tail=6.0, ragged=0.0, swing=0.0, direction=0.0)
"""Straight, northwards, without small oscillations."""

gusts = st.builds(
    Gust,
    position=st.lists(st.floats(-50, 50), min_size=2, max_size=2),
    direction=st.floats(-360, 360),
    width=st.floats(1, 80),
    speed=st.floats(0.5, 40),
    reach=st.floats(1, 200),
    strength=st.floats(0, 1),
    hold=st.floats(0, 5),
    tail=st.floats(0.1, 8),
    ragged=st.floats(0, 5),
    soft=st.floats(0, 10),
    swing=st.just(0.0),
)


def index(message: Floats) -> Floats:
    return np.asarray(np.linalg.norm(message, axis=1))


def line(start: float, stop: float, count: int = 400) -> Floats:
    """Return places on the z axis."""
    return np.stack([np.zeros(count), np.linspace(start, stop, count)], axis=1).astype(np.float32)


@pytest.mark.parametrize("direction", [0.0, 37.0, 90.0, 180.0, -120.0])
def test_w6_grass_bends_along_its_travel_and_in_its_tail_along_the_same_line(feel: Feel, direction: float) -> None:
    gust = STILL.model_copy(update={"direction": direction})
    ahead = np.array([sin(radians(direction)), -cos(radians(direction))], np.float32)
    aside = np.array([-ahead[1], ahead[0]])
    behind = np.linspace(0.1, 40.0, 200, dtype=np.float32)
    message = feel(gust, place=(60.0 - behind)[:, None] * ahead, time=10.0)
    np.testing.assert_allclose(message @ aside, 0.0, atol=1e-5)
    along = message @ ahead
    assert along.max() > STILL.strength
    assert along.min() < -0.02


@given(gusts, st.floats(0.0, 30.0), st.integers(0, 2**31 - 1))
def test_w6_nothing_ahead_of_the_front_or_beside_it_is_moved(feel: Feel, gust: Gust, time: float, seed: int) -> None:
    rng = np.random.default_rng(3)
    own = np.concatenate([rng.uniform([-60, -80], [60, 0], (60, 2)), rng.uniform([-90, -80], [90, 80], (60, 2))])
    pose = gust.pose(time=time)
    place = (pose.outside(own.astype(np.float32)) + np.array([pose.x, pose.z], np.float32)).astype(np.float32)
    message = feel(gust, place=place, time=time, seed=seed)
    free = (own[:, 1] <= -2e-3) | (np.abs(own[:, 0]) > gust.width / 2 + 2e-3)
    assert (message[free] == 0.0).all()


def test_w6_the_front_is_where_its_speed_has_taken_it(feel: Feel) -> None:
    for time in (2.0, 5.0, 11.0):
        place = line(5.0, -100.0, 4000)
        reached = place[index(feel(STILL, place=place, time=time)) > 1e-4, 1]
        assert reached.min() == pytest.approx(-STILL.speed * time, abs=0.3)


@given(st.integers(0, 1), st.floats(0.0, 7.5))
def test_w6_its_profile_in_space_is_the_response_in_time(
    feel: Feel, responses: list[Response], kind: int, behind: float
) -> None:
    """Grass begins to move at the front, and is let go `hold` later, by its own response (figures 7 and 8)."""
    response, strength, hold = responses[kind], STILL.strength, STILL.hold

    def curve(values: Floats, elapsed: float) -> float:
        return float(np.interp(elapsed, np.arange(len(values)) * response.step, values))

    expected = strength * (curve(response.rise, behind) + curve(response.fall, behind - hold) - 1.0)
    expected *= np.clip((hold + STILL.tail - behind) / (0.5 * STILL.tail), 0.0, 1.0)
    place = np.array([[0.0, -60.0 + STILL.speed * behind]], np.float32)
    message = feel(STILL, place=place, time=10.0, kind=kind)
    np.testing.assert_allclose(message, [[0.0, -np.clip(expected, -1.0, 1.0)]], atol=2e-3)


@given(st.floats(0.0, 7.9))
def test_w6_what_one_place_goes_through_in_time_stands_behind_the_front_in_space(feel: Feel, behind: float) -> None:
    here = np.array([[3.0, -60.0]], np.float32)
    back = np.array([[3.0, -60.0 + STILL.speed * behind]], np.float32)
    later = feel(STILL, place=here, time=10.0 + behind)
    np.testing.assert_allclose(later, feel(STILL, place=back, time=10.0), atol=5e-3)


def test_w6_its_tail_swings_past_rest_and_back_and_comes_to_rest(feel: Feel) -> None:
    place = line(-60.0 + STILL.speed * STILL.hold, -60.0 + STILL.speed * (STILL.hold + STILL.tail), 600)
    along = -feel(STILL, place=place, time=10.0)[:, 1]
    turns = np.flatnonzero(np.diff(np.sign(along[np.abs(along) > 1e-3])))
    assert len(turns) >= 3
    assert along.min() < -0.1
    assert np.abs(along[-1]) < 1e-3
    assert np.abs(along[-60:]).max() < 0.05


def test_w6_grass_is_at_rest_before_it_and_after_it(feel: Feel) -> None:
    place = line(-30.0, -30.0, 1)
    came, gone = 30.0 / STILL.speed, 30.0 / STILL.speed + STILL.hold + STILL.tail
    story = [float(index(feel(STILL, place=place, time=time))[0]) for time in (came - 0.05, came + 0.8, gone + 0.05)]
    assert story[0] == story[2] == 0.0
    assert story[1] > 0.3


def test_w6_it_dies_where_its_reach_ends(feel: Feel) -> None:
    gust = STILL.model_copy(update={"reach": 20.0})
    for time in np.arange(0.0, 16.0, 0.5):
        assert (feel(gust, place=line(-20.01, -80.0), time=float(time)) == 0.0).all()
    assert gust.parts(time=gust.life + 0.01, seed=1) == ()


def test_w6_a_ragged_front_lags_here_and_there_and_never_leads(feel: Feel) -> None:
    gust = STILL.model_copy(update={"ragged": 3.0, "width": 60.0})
    across = np.linspace(-25, 25, 120)
    depth = np.linspace(0.0, 6.0, 240)
    place = np.stack(np.meshgrid(across, -60.0 + depth), -1).reshape(-1, 2).astype(np.float32)
    moved = (index(feel(gust, place=place, time=10.0)) > 1e-3).reshape(len(depth), len(across))
    lag = depth[moved.argmax(axis=0)]
    assert lag.min() >= 0.0
    assert lag.max() <= 3.0 + 0.3
    assert np.ptp(lag) > 1.0


@given(
    seed=st.integers(0, 2**31 - 1),
    shortest=st.floats(0.5, 20.0),
    more=st.floats(0.0, 30.0),
    start=st.floats(0.0, 100.0),
    wander=st.floats(0.0, 40.0),
)
def test_w6_it_comes_again_at_random_intervals_that_the_seed_decides(
    seed: int, shortest: float, more: float, start: float, wander: float
) -> None:
    gust = Gust(
        start=start, every=[shortest, shortest + more], reach=1000.0, speed=10.0, wander=wander, direction=0.0, ragged=0
    )
    parts = gust.parts(time=start + 90.0, seed=seed)
    began = np.array([part.start for part in parts])
    assert began[0] == start
    assert began[-1] <= start + 90.0
    waits = np.diff(began)
    assert (waits >= shortest - 1e-9).all()
    assert (waits <= shortest + more + 1e-9).all()
    assert len(parts) >= 1 + int(90.0 / (shortest + more))
    sides = np.array([part.pose(time=part.start).x for part in parts if isinstance(part, Gust)])
    assert sides[0] == 0.0
    assert (np.abs(sides) <= wander + 1e-9).all()
    assert parts == gust.parts(time=start + 90.0, seed=seed)


def test_w6_repetitions_differ_in_wait_and_place_and_between_seeds() -> None:
    gust = Gust(every=[4.0, 9.0], wander=10.0, reach=1000.0, speed=5.0)
    first, other = ([part.start for part in gust.parts(time=150.0, seed=seed)] for seed in (1, 2))
    assert len(set(np.diff(first).round(6))) == len(first) - 1
    assert first[1:] != other[1:]
    aside = [part.pose(time=part.start).z for part in gust.parts(time=150.0, seed=1)]
    assert np.ptp(aside) > 5.0


@pytest.mark.parametrize("time", [35999.0, 60000.0, 5e6])
def test_w6_it_comes_again_however_long_a_game_has_run(time: float) -> None:
    gust = Gust(every=[4.0, 9.0], reach=1000.0, speed=5.0)
    began = np.array([part.start for part in gust.parts(time=time, seed=1)])
    assert time - 9.0 <= began[-1] <= time
    assert began[0] <= time - gust.life + 9.0
    assert (np.diff(began) >= 4.0 - 1e-6).all()
    assert (np.diff(began) <= 9.0 + 1e-6).all()


def test_w6_a_game_that_has_run_for_a_day_sets_off_a_gust_as_at_its_first_instant(feel: Feel) -> None:
    late = 86400.0
    place = np.array([[4.0, 0.0], [9.0, 3.0]], np.float32)
    then = feel(Gust(start=late, stop=late + 60.0, swing=0.0), place=place, time=late + 2.0)
    np.testing.assert_allclose(then, feel(Gust(stop=60.0, swing=0.0), place=place, time=2.0), atol=1e-4)
    assert np.abs(then).max() > 0.3


def test_w6_once_is_once_without_every() -> None:
    gust = Gust(start=3.0)
    assert gust.parts(time=2.999, seed=1) == ()
    assert gust.parts(time=3.0, seed=1) == (gust,)


@given(speed=st.floats(1.0, 40.0), reach=st.floats(5.0, 300.0), start=st.floats(0.0, 20000.0))
def test_w6_where_rounding_ends_a_gust_a_moment_late_its_extent_is_not_turned_round(
    speed: float, reach: float, start: float
) -> None:
    gust = Gust(speed=speed, reach=reach, start=start)
    held = gust.extent(time=start + gust.life + 1e-9)
    assert held.left <= held.right
    assert held.ahead <= held.behind


def test_w6_each_repetition_blows_as_the_first_one_did(feel: Feel) -> None:
    gust = STILL.model_copy(update={"every": [30.0, 40.0]})
    second = gust.parts(time=45.0, seed=7)[-1].start
    assert 30.0 <= second <= 40.0
    place = line(-60.0, 0.0)
    again = gust.parts(time=second + 8.0, seed=7)[-1].model_copy(update={"ease": 0.0})
    fresh = feel(STILL, place=place, time=8.0)
    late = feel(again, place=place, time=second + 8.0)
    np.testing.assert_allclose(late, fresh, atol=2e-3)


def test_w12_two_kinds_differ_under_one_gust_and_one_kind_does_not(feel: Feel) -> None:
    place = line(-60.0, -20.0)
    soft, stiff = (feel(STILL, place=place, time=10.0, kind=kind) for kind in (0, 1))
    assert index(soft - stiff).max() > 0.3
    assert index(soft - stiff).mean() > 0.05
    np.testing.assert_array_equal(soft, feel(STILL, place=place, time=10.0, kind=0))


def test_w12_what_a_blade_feels_does_not_depend_on_its_neighbours_kinds(answer: Answer) -> None:
    place = line(-5.0, 25.0, 60)
    soft = answer(60)
    mixed = Grass(np.arange(60) % 2, soft.step, soft.rise, soft.fall)
    message = STILL.action(place, time=10.0, seed=1, grass=mixed)
    np.testing.assert_array_equal(message[::2], STILL.action(place[::2], time=10.0, seed=1, grass=answer(30)))
    np.testing.assert_array_equal(message[1::2], STILL.action(place[1::2], time=10.0, seed=1, grass=answer(30, kind=1)))
