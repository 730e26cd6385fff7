"""The governor's ladder, and its steps on it (N11)."""

from itertools import pairwise
from math import exp, log

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.systems.govern import ABOVE, BELOW, RUNG, RUNGS, Governor, GovernorState, eased, next_state

HOLD = 0.05
LAST = len(RUNGS) - 1

shares = st.floats(0.0, 10.0)


def walked(times: list[float], *, frames: int = 4000, state: GovernorState | None = None) -> list[int]:
    """Return the rungs of a number of frames, given the time that each rung takes [s]."""
    now, rungs = state or GovernorState(), []
    for _ in range(frames):
        now = next_state(now, times[now.rung], hold=HOLD)
        rungs.append(now.rung)
    return rungs


def takes(fixed: float, ranged: float, drawn: float) -> list[float]:
    """Return each rung's frame time [s]: a constant, a term of the distances, and a term of the pixels."""
    return [HOLD * (fixed + ranged * each.range**2 + drawn * each.scale**2) for each in RUNGS]


def turns(rungs: list[int]) -> int:
    """Return the number of changes that reverse the one before."""
    ways = [one < other for one, other in pairwise(rungs) if one != other]
    return sum(one != other for one, other in pairwise(ways))


def test_n11_no_rung_takes_away_more_than_is_reckoned_with() -> None:
    for one, other in pairwise(RUNGS):
        assert other.scale <= one.scale
        assert other.range <= one.range
        assert 2.0 * log(one.scale / other.scale) <= RUNG + 1e-9
        assert 2.0 * log(one.range / other.range) <= RUNG + 1e-9
    assert (RUNGS[0].scale, RUNGS[0].range) == (1.0, 1.0)
    assert RUNGS[-1].scale >= 0.35


@given(shares, shares, shares)
def test_n11_under_a_steady_load_it_comes_to_rest_and_turns_back_once_at_most(
    fixed: float, ranged: float, drawn: float
) -> None:
    rungs = walked(takes(fixed, ranged, drawn))
    assert turns(rungs) <= 1
    assert len(set(rungs[-1000:])) == 1


@given(shares, shares, shares)
def test_n11_where_it_rests_the_time_is_held_and_no_more_is_left_out_than_that_takes(
    fixed: float, ranged: float, drawn: float
) -> None:
    times = takes(fixed, ranged, drawn)
    rung = walked(times)[-1]
    assert times[rung] <= HOLD * exp(ABOVE) * 1.001 or rung == LAST
    assert times[rung] >= HOLD * exp(-BELOW) * 0.999 or rung == 0


@given(st.lists(st.floats(0.0, 1e6), max_size=300), st.floats(1e-3, 10.0))
def test_n11_whatever_frames_take_it_stays_on_the_ladder(times: list[float], hold: float) -> None:
    state = GovernorState()
    for seconds in times:
        state = next_state(state, seconds, hold=hold)
        assert 0 <= state.rung <= LAST


@given(st.integers(0, LAST), st.floats(0.3, 3.0))
def test_n11_when_the_load_goes_everything_is_drawn_again(rung: int, load: float) -> None:
    heavy = walked(takes(0.2, 0.5 * load, load), state=GovernorState(rung))
    assert walked(takes(0.1, 0.1, 0.1), state=GovernorState(heavy[-1]))[-1] == 0


def test_n11_a_load_that_comes_and_goes_is_followed_ever_more_patiently() -> None:
    state, climbs = GovernorState(), []
    for _ in range(6000):
        before, alone = state, 0.84 if state.rung else 1.2  # as if all of a frame's time went at once
        state = next_state(state, HOLD * alone, hold=HOLD)
        climbs.append(state.rung < before.rung)
    early, late = sum(climbs[:500]), sum(climbs[-500:])
    assert 0 < 2 * late <= early


def test_n11_a_single_slow_frame_changes_nothing() -> None:
    state = GovernorState()
    for number in range(600):
        state = next_state(state, 0.4 if number % 10 == 7 else 0.9 * HOLD, hold=HOLD)
        assert state.rung == 0


def test_n11_the_first_frames_do_not_count() -> None:
    state = GovernorState()
    for seconds in (3.0, 0.5, *[0.9 * HOLD] * 30):
        state = next_state(state, seconds, hold=HOLD)
        assert state.rung == 0


def test_ranges_follow_little_by_little_and_arrive() -> None:
    place, last = 1.0, 1.0
    for _ in range(300):
        last, place = place, eased(place, 0.5, dt=1 / 60)
        assert 0.0 <= last - place < 0.03
    assert place == 0.5
    assert eased(0.5, 1.0, dt=1e9) == 1.0


@pytest.mark.parametrize("seconds", [0.0, -1.0, float("nan"), float("inf"), 60, "1/60", [0.02]])
def test_what_is_no_time_cannot_be_held(seconds: object) -> None:
    with pytest.raises(ValueError, match="hold is a time above 0 s and up to 5 s, such as 1 / 60, or None"):
        Governor(seconds)  # type: ignore[arg-type]
