"""A wind that fails is left out with one warning that names it, and the frame goes on with the others."""

import logging
from collections.abc import Callable
from time import sleep, thread_time
from typing import Any

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Extent, Grass, Mixing, WindPrimitive, WindSource
from tallgrass.engine.schedule import PATIENCE, WINDOW
from tallgrass.systems.wind import quarantine as quarantine_module
from tallgrass.systems.wind.blast import Blast
from tallgrass.systems.wind.blow import blowing, hear, lone_receivers
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import LONGEST_WAIT, WAIT, Quarantine, QuarantinedError
from tallgrass.systems.wind.turbulence import Turbulence
from tallgrass.systems.wind.whirlwind import Whirlwind

PLACES = np.stack(np.meshgrid(np.linspace(-5, 5, 11), np.linspace(-5, 5, 11)), -1).reshape(-1, 2).astype(np.float32)
GRASS = Grass(np.zeros(len(PLACES), np.intp), *np.ones((3, 1, 2), np.float32))


class UnspeakableError(Exception):
    def __str__(self) -> str:
        raise RuntimeError("there is nothing to say")


def _raise(error: BaseException) -> Any:
    raise error


class Failing(WindPrimitive):
    """A wind with the answers that a test gives."""

    kind: str = "failing"
    priority: int = 50
    swing: float = 0.0
    where: str = "action"
    part: str = "fine"

    def _answer(self, where: str, otherwise: Any, place: Floats | None = None) -> Any:
        return ANSWERS[self.part](otherwise, place) if where == self.where else otherwise

    def parts(self, *, time: float, seed: int) -> Any:
        return self._answer("parts", (self,))

    def pose(self, *, time: float) -> Any:
        return self._answer("pose", Pose())

    def extent(self, *, time: float) -> Any:
        return self._answer("extent", Extent(-2.5, 2.5, -2.5, 2.5))

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return self._answer("mask", (np.abs(place) < 2.5).all(axis=1).astype(np.float32), place)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return self._answer("action", np.full_like(place, 0.5), place)


Answer = Callable[[Any, Any], Any]
REVERSED = Extent(2.5, -2.5, 0.0, 1.0)

ANSWERS: dict[str, Answer] = {
    "fine": lambda right, _: right,
    "raises": lambda *_: _raise(ZeroDivisionError("division by zero\nsecond line")),
    "raises silently": lambda *_: _raise(RecursionError()),
    "raises unspeakably": lambda *_: _raise(UnspeakableError()),
    "leaves": lambda *_: _raise(SystemExit(3)),
    "shape": lambda right, _: right[:, None],
    "short": lambda right, _: right[:-1],
    "list": lambda right, _: right.tolist(),
    "nan": lambda right, _: right * np.float32(np.nan),
    "one infinity": lambda right, _: np.where(np.arange(right.size).reshape(right.shape) == 3, np.inf, right),
    "huge": lambda right, _: right.astype(np.float64) * 1e300,
    "strings": lambda right, _: right.astype(str),
    "complex": lambda right, _: right * 1j,
    "none": lambda *_: None,
    "numbers": lambda *_: [1, 2],
    "many": lambda right, _: [*right] * 1001,
    "unset part": lambda right, _: [right[0].model_copy(update={"start": None})],
    "worded priority": lambda right, _: [right[0].model_copy(update={"priority": "high"})],
    "no swing": lambda right, _: [right[0].model_copy(update={"swing": float("nan")})],
    "lost": lambda *_: Pose(float("nan"), 0.0, 0.0),
    "vague": lambda *_: Pose(None, 0.0, 0.0),  # type: ignore[arg-type]
    "everywhere": lambda *_: Extent(-np.inf, np.inf, -np.inf, np.inf),
    "reversed": lambda *_: REVERSED,
    "worded": lambda *_: Extent("left", 1.0, 1.0, 1.0),  # type: ignore[arg-type]
    "writes": lambda right, place: [right, place.fill(0.0)][0],
}

FAILURES = [
    ("mask", "raises", "mask raised ZeroDivisionError: division by zero second line"),
    ("action", "raises", "action raised ZeroDivisionError: division by zero second line"),
    ("parts", "raises", "parts raised ZeroDivisionError: division by zero second line"),
    ("pose", "raises", "pose raised ZeroDivisionError: division by zero second line"),
    ("extent", "raises", "extent raised ZeroDivisionError: division by zero second line"),
    ("action", "raises silently", "action raised RecursionError"),
    ("mask", "raises unspeakably", "mask raised UnspeakableError"),
    ("mask", "leaves", "mask raised SystemExit: 3"),
    ("mask", "shape", "mask returned an array of shape (25, 1) where shape (25,) is due"),
    ("action", "short", "action returned an array of shape (24, 2) where shape (25, 2) is due"),
    ("mask", "list", "mask returned list where shape (25,) is due"),
    ("mask", "none", "mask returned NoneType where shape (25,) is due"),
    ("mask", "nan", "mask returned numbers that are not finite"),
    ("action", "one infinity", "action returned numbers that are not finite"),
    ("mask", "huge", "mask returned numbers far beyond 1"),
    ("action", "huge", "action returned numbers far beyond 1"),
    ("mask", "strings", "mask returned <U32, which is no number"),
    ("action", "complex", "action returned complex64, which is no number"),
    ("parts", "none", "parts returned NoneType, not Sequence"),
    ("parts", "numbers", "parts returned int, not WindPrimitive"),
    ("parts", "many", "parts returned 1001 winds, 1000 at most are due"),
    ("parts", "unset part", "parts, of what one declares, returned NoneType, not float"),
    ("parts", "worded priority", "parts, of what one declares, returned str, not float"),
    ("parts", "no swing", "parts, of what one declares, returned numbers that are not finite"),
    ("pose", "none", "pose returned NoneType, not Pose"),
    ("pose", "lost", "pose returned numbers that are not finite"),
    ("pose", "vague", "pose returned NoneType, not float"),
    ("extent", "numbers", "extent returned list, not Extent"),
    ("extent", "worded", "extent returned str, not float"),
    ("extent", "reversed", f"extent returned {REVERSED}, which ends before it begins"),
    ("mask", "writes", "mask raised ValueError: assignment destination is read-only"),
]


@pytest.fixture(autouse=True)
def _only_warnings(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING, "tallgrass")


def told(
    sources: list[WindSource], quarantine: Quarantine, *, time: float = 1.0, mixing: Mixing = "priority"
) -> Floats:
    winds = blowing(sources, quarantine, time=time, seed=0)
    return hear(winds, lone_receivers(PLACES.copy(), GRASS), quarantine, time=time, seed=0, mixing=mixing)


BREEZE = WindSource(Breeze(), "wind[0] breeze")


@pytest.mark.parametrize("mixing", ["priority", "weight"])
@pytest.mark.parametrize(("where", "part", "why"), FAILURES)
def test_a_failing_wind_is_one_named_warning_and_leaves_no_trace(
    caplog: pytest.LogCaptureFixture, mixing: Mixing, where: str, part: str, why: str
) -> None:
    alone = told([BREEZE], Quarantine(), mixing=mixing)
    failing = WindSource(Failing(where=where, part=part), "wind[1] failing")
    quarantine = Quarantine()
    for _ in range(3):
        np.testing.assert_array_equal(told([BREEZE, failing], quarantine, mixing=mixing), alone)
    said = f"wind[1] failing of {__name__}.Failing: {why}; this wind is left out from now on"
    assert caplog.messages == [said]
    assert quarantine.reasons == {failing: f"wind[1] failing: {why}"}


def test_a_wind_that_leaves_a_change_behind_is_left_out(caplog: pytest.LogCaptureFixture) -> None:
    changes = ["left esper world 'there' current in place of 'here'"]
    quarantine = Quarantine(come_back=lambda: changes.pop() if changes else "")
    failing = WindSource(Failing(), "wind[1] failing")
    for _ in range(2):
        told([BREEZE, failing], quarantine)
    (said,) = caplog.messages
    assert "left esper world 'there' current in place of 'here'; this wind is left out from now on" in said
    assert list(quarantine.reasons) == [failing]


def test_a_wind_that_does_not_fail_is_kept_and_heard(caplog: pytest.LogCaptureFixture) -> None:
    for where, part in [("action", "fine"), ("extent", "everywhere")]:
        message = told([BREEZE, WindSource(Failing(where=where, part=part, swing=0.0), "fine")], Quarantine())
        held = (np.abs(PLACES) < 2.5).all(axis=1)
        assert np.allclose(message[held], 0.5)
    assert not caplog.messages


class Wide(Failing):
    """A wind whose mask is 1 everywhere."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return np.ones(len(place), np.float32)

    def extent(self, *, time: float) -> Any:
        return None


class Uneven(Failing):
    """A wind whose weaker part covers more places, and fails there."""

    def parts(self, *, time: float, seed: int) -> Any:
        return [Failing(priority=60), Wide(priority=40, part="nan")]


@pytest.mark.parametrize("mixing", ["priority", "weight"])
def test_what_a_wind_is_given_is_no_ones_to_change(mixing: Mixing) -> None:
    quiet, writing = (WindSource(Wide(priority=-1, part=part), "wind[1] wide") for part in ("fine", "writes"))
    alone = told([BREEZE, quiet], Quarantine(), mixing=mixing)
    np.testing.assert_array_equal(told([BREEZE, writing], Quarantine(), mixing=mixing), alone)


@pytest.mark.parametrize("mixing", ["priority", "weight"])
def test_what_a_wind_sent_before_it_failed_is_taken_back(mixing: Mixing) -> None:
    alone = told([BREEZE], Quarantine(), mixing=mixing)
    uneven, quarantine = WindSource(Uneven(), "wind[1] uneven"), Quarantine()
    message = told([BREEZE, uneven], quarantine, mixing=mixing)
    assert list(quarantine.reasons.values()) == ["wind[1] uneven: action returned numbers that are not finite"]
    np.testing.assert_array_equal(message, alone)


def test_a_kind_of_which_many_fail_is_told_of_once_and_left_out_for_good(caplog: pytest.LogCaptureFixture) -> None:
    quarantine = Quarantine(live=False)  # as for a film
    failing = [WindSource(Failing(part="nan"), f"wind[{number}] failing") for number in range(5)]
    told(failing, quarantine)
    quarantine.let_back(1e9)
    assert len(quarantine.reasons) == 5
    assert len(caplog.messages) == 1


class Untellable(Failing):
    """A wind that cannot be serialised, so that equal claims cannot be ordered."""

    kind: str = "untellable"
    cause: Any = None


def test_a_tie_that_cannot_be_settled_costs_only_the_winds_that_are_tied(caplog: pytest.LogCaptureFixture) -> None:
    tied = [WindSource(Untellable(cause=object()), f"wind[{number}] untellable") for number in (1, 2)]
    quarantine = Quarantine()
    np.testing.assert_array_equal(told([BREEZE, *tied], quarantine), told([BREEZE], Quarantine()))
    assert set(quarantine.reasons) == set(tied)
    (said,) = caplog.messages
    assert "model_dump_json raised PydanticSerializationError" in said


def test_the_traceback_is_there_for_those_who_ask(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG, "tallgrass")
    told([WindSource(Failing(part="raises"), "wind[0] failing")], Quarantine())
    (traceback,) = [record for record in caplog.records if record.levelno == logging.DEBUG]
    assert traceback.exc_info is not None
    assert isinstance(traceback.exc_info[1], ZeroDivisionError)


class Busy(Failing):
    """A wind that keeps the processor busy."""

    kind: str = "busy"

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        end = thread_time() + 0.11
        while thread_time() < end:
            pass
        return np.full_like(place, 0.5)


def test_a_slow_wind_is_left_out_after_three_times(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(quarantine_module, "perf_counter", thread_time)  # nothing waits, however busy the machine is
    busy, quarantine = WindSource(Busy(), "wind[1] busy"), Quarantine()
    for _ in range(PATIENCE - 1):
        told([BREEZE, busy], quarantine)
        assert not quarantine.reasons
    np.testing.assert_array_equal(told([BREEZE, busy], quarantine), told([BREEZE], Quarantine()))
    (said,) = caplog.messages
    assert said.startswith(f"wind[1] busy of {__name__}.Busy: action takes too long: 1")
    assert said.endswith(" ms of processor time; this wind is left out for a while")


def test_time_that_others_take_does_not_count(caplog: pytest.LogCaptureFixture) -> None:
    quarantine = Quarantine()
    for _ in range(PATIENCE):
        quarantine.ask(SLOW_WIND, "action", lambda: sleep(0.11))
    assert not quarantine.reasons
    assert not caplog.messages


SLOW_WIND = WindSource(Failing(), "slow")


class Clock:
    """Processor time, which advances by a test's step at every second reading."""

    def __init__(self, took: list[float]) -> None:
        self._readings = iter([reading for each in took for reading in (0.0, each)])

    def __call__(self) -> float:
        return next(self._readings)


Ask = Callable[..., bool]


@pytest.fixture
def ask(monkeypatch: pytest.MonkeyPatch) -> Ask:
    """Call a wind once for each of some times that it takes [s]; return whether it is not left out."""

    def answers(
        quarantine: Quarantine, *took: float, source: WindSource = SLOW_WIND, what: str = "action", receivers: int = 0
    ) -> bool:
        monkeypatch.setattr(quarantine_module, "thread_time", Clock(list(took)))
        try:
            for _ in took:
                quarantine.ask(source, what, lambda: None, receivers=receivers)
        except QuarantinedError:
            return False
        return True

    return answers


@pytest.mark.parametrize(
    ("took", "is_left_out"),
    [
        ([3.1], True),
        ([2.9], False),
        ([0.2, 0.2], False),
        ([0.2, 0.2, 0.2], True),
        ([0.2, 0.0, 0.2, 0.0, 0.0, 0.2], True),
        ([0.2, *[0.0] * WINDOW, 0.2, *[0.0] * WINDOW, 0.2], False),
    ],
)
def test_a_slow_call_is_forgiven_but_a_slow_wind_is_not(ask: Ask, took: list[float], *, is_left_out: bool) -> None:
    quarantine = Quarantine()
    assert ask(quarantine, *took) != is_left_out
    assert (SLOW_WIND in quarantine.reasons) == is_left_out


@pytest.mark.parametrize("live", [True, False])
@pytest.mark.parametrize(
    "wind", [Breeze(), Gust(), Whirlwind(), Blast(), Turbulence()], ids=lambda wind: str(wind.kind)
)
def test_winds_that_come_along_are_never_too_slow(
    ask: Ask, caplog: pytest.LogCaptureFixture, wind: WindPrimitive, *, live: bool
) -> None:
    assert ask(Quarantine(live=live), *[9.0] * 20, source=WindSource(wind, wind.kind))
    assert not caplog.messages


@pytest.mark.parametrize("took", [0.368, 5.0])
def test_for_a_film_a_slow_wind_stays_and_is_told_of_once(
    ask: Ask, caplog: pytest.LogCaptureFixture, took: float
) -> None:
    quarantine = Quarantine(live=False)
    assert ask(quarantine, *[took] * 20, 0.05, 0.0, took)
    assert not quarantine.reasons
    figure = f"{1000.0 * took:.0f} ms of processor time"
    assert caplog.messages == [f"slow of {__name__}.Failing: action takes too long: {figure}"]


def test_a_slow_wind_comes_back_and_is_left_out_for_longer_every_time(
    ask: Ask, caplog: pytest.LogCaptureFixture
) -> None:
    quarantine, now = Quarantine(), 100.0
    quarantine.let_back(now)
    for wait in (WAIT, 2 * WAIT, 4 * WAIT, 8 * WAIT, LONGEST_WAIT, LONGEST_WAIT):
        assert not ask(quarantine, 0.2, 0.2, 0.2)
        assert quarantine.reasons == {SLOW_WIND: "slow: action takes too long: 200 ms of processor time"}
        quarantine.let_back(now + wait - 0.01)
        assert not ask(quarantine, 0.0)
        now += wait
        quarantine.let_back(now)
        assert not quarantine.reasons
        assert ask(quarantine, 0.0, 0.2, 0.2)
        quarantine.let_back(now)
    assert len(caplog.messages) == 1


def test_a_wind_that_fails_does_not_come_back_with_a_slow_one(ask: Ask, caplog: pytest.LogCaptureFixture) -> None:
    failing, quarantine = WindSource(Failing(part="nan"), "failing"), Quarantine()
    assert not ask(quarantine, 4.0)
    quarantine.leave_out(failing, "action returned rubbish")
    quarantine.let_back(WAIT)
    assert list(quarantine.reasons) == [failing]
    assert len(caplog.messages) == 2


@pytest.mark.parametrize("live", [True, False])
@pytest.mark.parametrize(
    ("took", "receivers", "is_told"),
    [
        ([0.034, 0.034], 0, False),
        ([0.5, *[0.0] * 20], 0, False),
        ([0.034] * 20, 0, True),
        ([0.019] * 20, 10_000, False),
        ([0.034] * 20, 10_000, True),
        ([0.034] * 20, 20_000, False),
        ([0.034, 0.0] * 20, 0, True),
    ],
)
def test_a_wind_that_often_takes_long_is_told_of_once_and_stays(
    ask: Ask, caplog: pytest.LogCaptureFixture, took: list[float], receivers: int, *, is_told: bool, live: bool
) -> None:
    quarantine = Quarantine(live=live)
    assert ask(quarantine, *took, receivers=receivers)
    assert ask(quarantine, *took, what="mask", receivers=receivers)
    assert not quarantine.reasons
    assert caplog.messages == [f"slow of {__name__}.Failing: action takes 34 ms of processor time"] * is_told
