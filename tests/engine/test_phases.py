"""The order of a frame."""

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.engine.schedule import Phase, Schedule


def recorder(heard: list[str], name: str) -> Callable[[], None]:
    return lambda: heard.append(name)


@given(st.lists(st.sampled_from(Phase), max_size=20))
def test_d3_systems_run_by_phase_and_within_one_in_the_order_they_were_added(phases: list[Phase]) -> None:
    plan, heard = Schedule(), list[str]()
    names = [f"{phase.name} {number:02}" for number, phase in enumerate(phases)]
    for phase, name in zip(phases, names, strict=True):
        plan.add(phase, name, recorder(heard, name))
    plan.run()
    assert heard == [name for name, phase in sorted(zip(names, phases, strict=True), key=lambda row: (row[1], row[0]))]


def test_d3_a_frame_tiles_before_it_sees_and_blows_before_it_draws() -> None:
    assert list(Phase) == [Phase.INPUT, Phase.TILE, Phase.SEE, Phase.BLOW, Phase.DRAW]


def test_every_system_is_timed_under_its_name_in_every_run(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 0.25, 1.0, 1.5, 2.0, 2.001, 3.0, 3.0])
    monkeypatch.setattr("tallgrass.engine.phases.perf_counter", lambda: next(clock))
    plan, heard = Schedule(), list[str]()
    plan.add(Phase.DRAW, "draw", recorder(heard, "draw"))
    plan.add(Phase.SEE, "see", recorder(heard, "see"))
    plan.run()
    assert plan.milliseconds == {"see": 250.0, "draw": 500.0}
    plan.run()
    assert plan.milliseconds == {"see": pytest.approx(1.0), "draw": 0.0}
    assert heard == ["see", "draw", "see", "draw"]


def test_a_system_that_fails_stops_the_frame_where_it_stands() -> None:
    def fails() -> None:
        raise ZeroDivisionError

    plan, heard = Schedule(), list[str]()
    plan.add(Phase.TILE, "before", recorder(heard, "before"))
    plan.add(Phase.SEE, "fails", fails)
    plan.add(Phase.DRAW, "after", recorder(heard, "after"))
    with pytest.raises(ZeroDivisionError):
        plan.run()
    assert heard == ["before"]
