"""The schedule of a frame: order, turns, and systems that fail."""

import logging
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.engine.schedule import Phase, Schedule, UnknownSystemError


class BallError(Exception):
    """A game's error whose text cannot be read."""

    def __str__(self) -> str:
        raise RuntimeError("no words")


class Ball:
    """A game's own system."""

    def __init__(self, *heard: str) -> None:
        self.heard = list(heard)

    def run(self) -> None:
        self.heard.append("ball")


def nothing() -> None:
    pass


def fails() -> None:
    raise ZeroDivisionError("division by zero")


def recorder(heard: list[str], name: str) -> Callable[[], None]:
    return partial(heard.append, name)


def schedule(heard: list[str], *names: str, phase: Phase = Phase.SEE) -> Schedule:
    """Schedule of systems that record their names when they run."""
    made = Schedule()
    for name in names:
        made.add(phase, name, recorder(heard, name))
    return made


def order(of: Schedule) -> list[str]:
    return [system.name for system in of]


# ---- Order ---------------------------------------------------------------------------------------


def test_d3_a_frame_tiles_before_it_sees_and_blows_before_it_draws() -> None:
    assert list(Phase) == [Phase.INPUT, Phase.TILE, Phase.SEE, Phase.BLOW, Phase.DRAW]


@given(st.lists(st.sampled_from(Phase), max_size=20))
def test_d3_systems_run_by_phase_and_within_one_in_the_order_they_were_added(phases: list[Phase]) -> None:
    plan, heard = Schedule(), list[str]()
    names = [f"{phase.name} {number:02}" for number, phase in enumerate(phases)]
    for phase, name in zip(phases, names, strict=True):
        plan.add(phase, name, recorder(heard, name))
    plan.run()
    assert heard == [name for name, phase in sorted(zip(names, phases, strict=True), key=lambda row: (row[1], row[0]))]
    assert heard == order(plan) == list(plan.milliseconds)


NEIGHBOUR = st.none() | st.integers(0, 11)


@given(st.lists(st.tuples(st.sampled_from(Phase), NEIGHBOUR, NEIGHBOUR), max_size=12), st.data())
def test_every_order_that_is_taken_holds_and_every_other_one_is_refused(rows: list[Any], data: st.DataObject) -> None:
    plan, held = Schedule(), list[tuple[str, str]]()
    for number, (phase, *others) in enumerate(rows):
        known = order(plan)
        before, after = (None if pick is None or not known else known[pick % len(known)] for pick in others)
        possible = (
            (before is None or plan[before].phase >= phase)
            and (after is None or plan[after].phase <= phase)
            and (before is None or after is None or known.index(after) < known.index(before))
        )
        if not possible:
            with pytest.raises(ValueError, match=f"^'{number}' cannot run (before|after) '"):
                plan.add(phase, str(number), nothing, before=before, after=after)
            continue
        plan.add(phase, str(number), nothing, before=before, after=after)
        held += [(str(number), before)] if before else []
        held += [(after, str(number))] if after else []
        assert [name for name in order(plan) if name != str(number)] == known, "the others stay as they were"
        if data.draw(st.integers(0, 9)) == 0:
            gone = data.draw(st.sampled_from(order(plan)))
            plan.remove(gone)
            held = [pair for pair in held if gone not in pair]
        assert all(order(plan).index(first) < order(plan).index(second) for first, second in held)
        assert [system.phase for system in plan] == sorted(system.phase for system in plan)


def test_those_that_run_before_one_keep_the_order_in_which_they_were_added() -> None:
    plan = schedule([], "cull", "lod")
    plan.add("see", "hawk", nothing, before="lod", after="cull")
    plan.add("See", "owl", nothing, before="lod")
    plan.add("SEE", "late", nothing, after="cull")
    plan.add("tile", "early", nothing, before="cull")
    assert order(plan) == ["early", "cull", "hawk", "owl", "lod", "late"]


def test_an_order_that_cannot_be_is_refused_in_one_sentence_and_adds_nothing() -> None:
    plan = schedule([], "cull", "lod")
    for names, why in [
        (("blow", "before"), "'x' cannot run before 'cull': phase SEE comes before phase BLOW"),
        (("tile", "after"), "'x' cannot run after 'cull': phase TILE comes before phase SEE"),
    ]:
        with pytest.raises(ValueError, match=f"^{why}$"):
            plan.add(names[0], "x", nothing, **{names[1]: "cull"})  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"^'x' cannot run before 'cull' and after 'lod', which runs later$"):
        plan.add("see", "x", nothing, before="cull", after="lod")
    assert order(plan) == ["cull", "lod"]


LATE = "system 'x' would never run: it is async or yields, and a frame does not wait for it"


async def awaited() -> None:
    """Begins when it is called, and does nothing before it is awaited."""


def yielding() -> Iterator[None]:
    """A generator function as a system: its steps run only when it is iterated."""
    yield


class Later:
    """A system whose turn is awaited."""

    async def run(self) -> None:
        """Begin."""


@pytest.mark.parametrize(
    ("phase", "name", "run", "error", "why"),
    [
        ("see", "cull", nothing, ValueError, "there is a system 'cull' already; replace it, or take another name"),
        ("see", " ", nothing, ValueError, "a system's name is a text that is not empty, unlike ' '"),
        ("see", None, nothing, ValueError, "a system's name is a text that is not empty, unlike None"),
        ("sea", "x", nothing, ValueError, "no phase 'sea'; there are INPUT, TILE, SEE, BLOW, DRAW"),
        ("see", "x", 3, TypeError, "system 'x' needs a function without arguments or an object with run(), unlike int"),
        ("see", "x", Ball, TypeError, "system 'x' was handed the class Ball; hand it an object made from that"),
        *(("see", "x", late, TypeError, LATE) for late in (awaited, partial(awaited), yielding, Later())),
    ],
)
def test_what_cannot_be_a_system_is_refused_in_one_sentence(
    phase: Any, name: Any, run: Any, error: type[Exception], why: str
) -> None:
    plan = schedule([], "cull")
    with pytest.raises(error) as refusal:
        plan.add(phase, name, run)
    assert str(refusal.value) == why
    assert order(plan) == ["cull"]


# ---- Reading and changing ------------------------------------------------------------------------


def test_a_system_is_a_record_that_can_be_read_and_not_written() -> None:
    plan = Schedule()
    plan.add("blow", "ball", Ball())
    plan.add(Phase.TILE, "tile", nothing, trusted=True)
    assert (len(plan), "ball" in plan, "bal" in plan, repr(plan)) == (2, True, False, "Schedule(TILE tile, BLOW ball)")
    ball = plan["ball"]
    assert (ball.name, ball.phase, ball.enabled, ball.trusted) == ("ball", Phase.BLOW, True, False)
    assert (ball.origin, plan["tile"].origin) == (f"{__name__}.Ball", f"{__name__}.nothing")
    with pytest.raises(AttributeError):
        ball.enabled = False  # type: ignore[misc]


@pytest.mark.parametrize("ask", ["__getitem__", "remove", "enable", "disable", "step", "replace", "before", "after"])
def test_an_unknown_name_is_told_with_the_one_it_resembles(ask: str) -> None:
    plan = schedule([], "cull", "lod")

    def asked(name: str) -> None:
        if ask in {"before", "after"}:
            plan.add("see", "x", nothing, **{ask: name})  # type: ignore[arg-type]
        else:
            getattr(plan, ask)(name, *([nothing] if ask == "replace" else []))

    with pytest.raises(KeyError) as refusal:
        asked("cul")
    assert str(refusal.value) == "no system 'cul', did you mean 'cull'?"
    with pytest.raises(UnknownSystemError) as refusal:
        asked("zzz")
    assert str(refusal.value) == "no system 'zzz'; there are cull, lod"
    assert order(plan) == ["cull", "lod"]


def test_one_that_is_replaced_keeps_its_place_and_whether_it_is_enabled() -> None:
    heard, ball = list[str](), Ball()
    plan = schedule(heard, "a", "b", "c")
    plan.disable("b")
    plan.replace("b", ball)
    plan.run()
    assert (heard, ball.heard, plan["b"].phase) == (["a", "c"], [], Phase.SEE)
    plan.enable("b")
    plan.run()
    assert (heard, ball.heard, order(plan)) == (["a", "c"] * 2, ["ball"], ["a", "b", "c"])


def test_one_that_is_removed_has_no_turn_and_its_name_is_free() -> None:
    heard = list[str]()
    plan = schedule(heard, "a", "b")
    plan.run()
    plan.remove("a")
    assert (order(plan), list(plan.milliseconds)) == (["b"], ["b"])
    plan.add("draw", "a", recorder(heard, "new"))
    plan.run()
    assert heard == ["a", "b", "b", "new"]
    plan.clear()
    assert (len(plan), plan.milliseconds) == (0, {})


# ---- Turns ---------------------------------------------------------------------------------------


def test_every_system_that_ran_is_timed_under_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 0.25, 1.0, 1.5, 2.0, 2.001])
    monkeypatch.setattr("tallgrass.engine.schedule.perf_counter", lambda: next(clock))
    plan = Schedule()
    plan.add(Phase.DRAW, "draw", nothing)
    plan.add(Phase.SEE, "see", nothing)
    plan.run()
    assert plan.milliseconds == {"see": 250.0, "draw": 500.0}
    plan.disable("see")
    plan.run()
    assert plan.milliseconds == {"draw": pytest.approx(1.0)}


def test_a_frame_may_be_run_in_parts_and_its_times_come_together() -> None:
    heard, plan = list[str](), Schedule()
    for phase in Phase:
        plan.add(phase, phase.name, recorder(heard, phase.name))
    plan.run(last=Phase.SEE)
    assert heard == list(plan.milliseconds) == ["INPUT", "TILE", "SEE"]
    plan.run(first=Phase.BLOW)
    assert heard == list(plan.milliseconds) == [phase.name for phase in Phase]


def test_one_system_or_one_phase_can_be_run_out_of_order() -> None:
    heard = list[str]()
    plan = schedule(heard, "a", "b", "c")
    plan.add("blow", "d", recorder(heard, "d"))
    plan.disable("b")
    plan.step("d")
    plan.step(Phase.SEE)
    plan.step("b")
    assert (heard, plan.milliseconds) == (["d", "a", "c", "b"], {})


def test_a_running_system_may_change_the_schedule() -> None:
    heard = list[str]()
    plan = schedule(heard, "first", "removed", "disabled", "replaced", "again", "last")

    def change() -> None:
        heard.append("change")
        plan.remove("removed")
        plan.remove("first")
        plan.disable("disabled")
        plan.replace("replaced", recorder(heard, "new"))
        plan.remove("again")
        plan.add("see", "again", recorder(heard, "again"))
        plan.add("draw", "added", recorder(heard, "added"))
        plan.remove("change")

    plan.add("see", "change", change, before="removed")
    plan.run()
    assert heard == ["first", "change", "new", "last"]
    assert list(plan.milliseconds) == ["replaced", "last"]
    heard.clear()
    plan.run()
    assert heard == ["new", "last", "again", "added"]


# ---- Failures ------------------------------------------------------------------------------------


def test_a_system_that_raises_is_named_once_and_left_out_and_the_frame_goes_on(
    caplog: pytest.LogCaptureFixture,
) -> None:
    heard = list[str]()
    plan = schedule(heard, "a", "b")
    plan.run()
    plan.replace("a", fails)
    plan.run()
    plan.run()
    why = f"system 'a' of {__name__}.fails: run raised ZeroDivisionError: division by zero"
    assert caplog.record_tuples == [("tallgrass", logging.WARNING, f"{why}; it is left out from now on")]
    assert (heard, plan.failures, list(plan.milliseconds)) == (["a", "b", "b", "b"], {"a": why}, ["b"])
    assert plan["a"].enabled


def test_an_error_that_cannot_be_told_is_named_all_the_same(caplog: pytest.LogCaptureFixture) -> None:
    class Bad(Ball):
        def run(self) -> None:
            raise BallError

    plan = Schedule()
    plan.add("blow", "ball", Bad())
    plan.run()
    (told,) = caplog.messages
    assert told == f"system 'ball' of {__name__}.{Bad.__qualname__}: run raised BallError; it is left out from now on"


@pytest.mark.parametrize("mend", ["enable", "replace"])
def test_one_that_failed_runs_again_when_it_is_enabled_or_replaced(mend: str) -> None:
    heard, broken = list[str](), [True]

    def run() -> None:
        if broken.pop():
            fails()

    plan = schedule(heard, "before")
    plan.add("see", "ball", run)
    plan.run()
    assert list(plan.failures) == ["ball"]
    broken.append(False)
    if mend == "enable":
        plan.enable("ball")
    else:
        plan.replace("ball", run)
    plan.run()
    assert (plan.failures, list(plan.milliseconds), broken) == ({}, ["before", "ball"], [])


def test_of_a_trusted_system_errors_go_through_until_a_game_replaces_it() -> None:
    heard, plan = list[str](), Schedule()
    plan.add("tile", "before", recorder(heard, "before"))
    plan.add("see", "fails", fails, trusted=True)
    plan.add("draw", "after", recorder(heard, "after"))
    with pytest.raises(ZeroDivisionError):
        plan.run()
    assert (heard, plan.failures, list(plan.milliseconds)) == (["before"], {}, ["before"])
    plan.replace("fails", fails)
    plan.run()
    assert (heard, list(plan.failures)) == (["before", "before", "after"], ["fails"])


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (KeyboardInterrupt(), []),
        (SystemExit(3), [f"system 'stop' of {__name__}._raised ends the program: run raised SystemExit: 3"]),
    ],
)
def test_a_user_and_a_system_can_stop_the_program_and_a_system_that_does_is_named(
    error: BaseException, told: list[str], caplog: pytest.LogCaptureFixture
) -> None:
    came_back = list[str]()

    def come_back() -> str:
        came_back.append("")
        return ""

    plan = Schedule(come_back=come_back)
    plan.add("blow", "stop", partial(_raised, error))
    with pytest.raises(type(error)):
        plan.run()
    assert (plan.failures, came_back, caplog.messages) == ({}, [""], told)


def _raised(error: BaseException) -> None:
    raise error


def test_an_error_in_a_single_step_goes_through_for_a_test_to_see() -> None:
    plan = Schedule()
    plan.add("blow", "fails", fails)
    for which in ("fails", Phase.BLOW):
        with pytest.raises(ZeroDivisionError):
            plan.step(which)
    assert plan.failures == {}


def test_what_fails_after_it_replaced_or_removed_itself_is_not_held_against_the_name() -> None:
    plan = Schedule()

    def leave() -> None:
        plan.replace("a", nothing)
        plan.remove("b")
        fails()

    plan.add("see", "a", leave)
    plan.add("see", "b", nothing)
    plan.run()
    assert (order(plan), plan.failures) == (["a"], {})
