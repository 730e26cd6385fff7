"""Systems that keep a frame waiting."""

from collections.abc import Callable
from functools import partial
from time import sleep

import pytest

from tallgrass.engine import schedule as scheduling
from tallgrass.engine.schedule import PATIENCE, WAITED, WINDOW, Schedule


@pytest.fixture
def waits(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Return the function that advances the clock while a system waits, by a time [s]."""
    waited = [0.0]
    monkeypatch.setattr(scheduling, "perf_counter", lambda: waited[0])

    def wait(seconds: float) -> None:
        waited[0] += seconds

    return wait


def test_a_system_that_waits_is_named_once_and_in_a_game_left_out_at_the_third_time(
    waits: Callable[..., None], caplog: pytest.LogCaptureFixture
) -> None:
    systems = Schedule()
    systems.add("blow", "disk", partial(waits, 5.0))
    for _ in range(PATIENCE - 1):
        systems.run()
    (named,) = caplog.messages
    assert named.startswith("system 'disk' of ")
    assert "run waits: for 5.0 s" in named
    assert not systems.failures
    systems.run()
    assert "run waits: for 5.0 s" in systems.failures["disk"]
    assert caplog.messages[1].endswith("it is left out from now on")
    systems.enable("disk")
    systems.run()
    assert not systems.failures
    assert len(caplog.messages) == 2


def test_for_a_film_a_system_that_waits_is_only_named(
    waits: Callable[..., None], caplog: pytest.LogCaptureFixture
) -> None:
    systems = Schedule(live=False)
    systems.add("blow", "disk", partial(waits, 5.0))
    for _ in range(3 * PATIENCE):
        systems.run()
    assert not systems.failures
    assert len(caplog.messages) == 1


def test_who_waits_now_and_then_works_or_is_the_engines_own_is_not_left_out(
    waits: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    systems, turns = Schedule(), iter(range(10**6))
    systems.add("blow", "seldom", lambda: waits(5.0 if next(turns) % (WINDOW // 2) == 0 else 0.9 * WAITED))
    systems.add("blow", "ours", partial(waits, 5.0), trusted=True)
    for _ in range(5 * WINDOW):
        systems.run()
    assert not systems.failures
    monkeypatch.setattr(scheduling, "thread_time", lambda: 0.2 * vars(scheduling)["perf_counter"]())
    systems.add("blow", "busy", partial(waits, 5.0))
    for _ in range(WINDOW):
        systems.run()
    assert not systems.failures


def test_a_system_that_sleeps_is_one_that_waits(caplog: pytest.LogCaptureFixture) -> None:
    systems = Schedule()
    systems.add("input", "sleeper", partial(sleep, WAITED + 0.05))
    systems.run()
    assert "waits" in caplog.text
