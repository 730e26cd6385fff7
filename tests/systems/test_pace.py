"""Pace of time for a viewer: while it idles, changes progress by the frame (X2)."""

from itertools import chain, cycle, islice, repeat

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.viewer import Viewer
from tallgrass.systems.around.pace import IDLE, Pace, change_step
from tallgrass.systems.transition import FADE

PLAYED = [1.0 / 60.0] * 120
"""Two seconds of play."""

EVENLY: dict[str, list[float]] = {
    "60 frames a second": [1.0 / 60.0],
    "a slow machine": [0.2],
    "the fastest of screens": [1.0 / 240.0],
    "looking up at the sky makes frames three times as fast": [*[1.0 / 60.0] * 90, *[1.0 / 180.0] * 90],
    "both eyes drawn as one viewer": [1.0 / 60.0, 0.0],
    "ticks of a thirtieth on a screen of 144": [1.0 / 30.0, 0.0, 0.0, 0.0, 0.0],
}


def idled(*passed: float) -> list[bool]:
    pace = Pace()
    return [pace.idles(dt) for dt in (1e9, *passed)][1:]


@pytest.mark.parametrize("how", EVENLY)
def test_x2_in_play_no_change_goes_faster_than_time(how: str) -> None:
    assert not any(idled(*islice(cycle(EVENLY[how]), 2000)))


@given(st.lists(st.floats(1.0 / 120.0, 1.0), min_size=1, max_size=100))
def test_x2_nor_on_a_machine_that_stutters(passed: list[float]) -> None:
    assert not any(idled(*passed))


@pytest.mark.parametrize("dt", [0.0, 1.0 / 600.0, 1.0 / 1200.0], ids=["pause", "slow motion", "slower motion"])
def test_x2_time_idles_a_moment_after_it_is_slowed_down_and_no_longer_when_it_goes_on(dt: float) -> None:
    slowed = idled(*chain(PLAYED, repeat(dt, 300), PLAYED))
    assert not any(slowed[:120])
    assert all(slowed[150:420])
    assert not any(slowed[430:])


def test_x2_nobody_gets_used_to_a_pause_but_to_fast_frames_everybody_does() -> None:
    assert all(idled(*chain(PLAYED, repeat(0.0, 20_000)))[150:])
    assert not any(idled(*repeat(1.0 / 500.0, 1500))[600:])


def test_x2_two_changes_in_a_row_are_over_within_sixty_frames_of_idle_time() -> None:
    assert 2 * FADE / IDLE < 50
    assert change_step(Viewer(dt=0.001, idles=True)) == IDLE
    assert change_step(Viewer(dt=0.2, idles=True)) == 0.2
    assert change_step(Viewer(dt=0.001)) == 0.001
