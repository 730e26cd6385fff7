"""One part of a wind at one instant: what it answers receivers, and whether that is the same however it is asked."""

from collections.abc import Callable, Iterable
from dataclasses import astuple, dataclass, field
from functools import partial
from math import inf, isfinite, isnan
from time import thread_time
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Floats
from ..components.pose import Pose
from ..components.wind import Extent, Grass, WindPrimitive
from ..engine.complaint import said
from ..systems.bodies.fly import PATH_STEP

Ask = Callable[[Floats, Grass], Any]
Answer = TypeVar("Answer")

CLOSE = 1e-6
"""By how much answers may differ when receivers are asked in another order, or only some of them."""

BESIDE = 0.01
"""How far outside an extent a mask must be 0 [m]."""

FAR = 10000.0
"""How far away the farthest receivers are [m]."""

WIDE = 50.0
"""How far from a wind's middle receivers are tried where its extent says nothing [m]."""

_RESPONSES = ((2.0, 5.0), (5.0, 11.0))
"""Damping and angular frequency of two kinds, a tall soft one and a short stiff one [1/s]."""


def bounds(extent: Extent | None, /) -> tuple[float, float, float, float]:
    """Return the rectangle to look for a wind in: left, right, ahead, behind [m]."""
    if extent is None:
        return -WIDE, WIDE, -WIDE, WIDE
    left, right = np.clip((extent.left, extent.right), -FAR, FAR).tolist()
    ahead, behind = np.clip((extent.ahead, extent.behind), -FAR, FAR).tolist()
    return left, right, ahead, behind


def places_to_try(extent: Extent | None, /) -> Floats:
    """Return positions (x, z) in a wind's own frame [m], shape (n, 2), float32."""
    left, right, ahead, behind = bounds(extent)
    x, z = np.meshgrid(np.linspace(left, right, 33), np.linspace(ahead, behind, 33))
    inside = np.stack([x, z], -1).reshape(-1, 2)
    middle = np.array([[left + right, ahead + behind]]) / 2
    around = middle + (inside - middle) * 1.3 + 0.02
    near = np.random.default_rng(0).normal(0.0, 1.0, (200, 2))
    special = np.concatenate([middle, [[0.0, 0.0], [-0.0, 1e-6], [1e-20, 0.0], [0.0, -3.0], [3.0, 0.0]]])
    turn = np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
    far = FAR * np.stack([np.cos(turn), np.sin(turn)], -1)
    return np.concatenate([inside, around, near, special, far]).astype(np.float32)


def crowd(extent: Extent | None, count: int, /) -> Floats:
    """Return `count` positions inside an extent [m], shape (count, 2)."""
    left, right, ahead, behind = bounds(extent)
    spread = np.random.default_rng(1).random((count, 2))
    place = np.array([left, ahead]) + spread * np.array([right - left, behind - ahead])
    return np.asarray(place, np.float32)


def grass_at(place: Floats, /) -> Grass:
    """Return grass of two kinds, mixed, at positions (n, 2)."""
    step, samples = np.array([0.02, 0.01], np.float32), 256
    time = step[:, None].astype(np.float64) * np.arange(samples)
    fading, swinging = np.array(_RESPONSES).T[..., None]
    fall = (np.exp(-fading * time) * np.cos(swinging * time)).astype(np.float32)
    kind = np.arange(len(place)) % len(step)
    return Grass(kind.astype(np.intp), step, np.float32(1.0) - fall, fall)


class FailedError(Exception):
    """A wind's answer is such that nothing more can be asked of it."""


@dataclass(slots=True)
class Report:
    """What is wrong with a wind: one sentence for each thing, however often it shows."""

    sentences: dict[str, str] = field(default_factory=dict)
    """By what they are about."""

    most: float = inf
    """How long an answer may take, in processor time of this thread [s]."""

    def add(self, about: str, sentence: str) -> None:
        """Take a sentence down, unless there is one about this."""
        self.sentences.setdefault(about, sentence)

    def fail(self, about: str, sentence: str) -> FailedError:
        """Take a sentence down, and return what to raise."""
        self.add(about, sentence)
        return FailedError(sentence)

    def ask(self, what: str, when: str, ask: Callable[[], Answer]) -> Answer:
        """Return a wind's answer; raises FailedError where it raises anything, and where it takes too long."""
        try:
            answer, took = timed(ask)
            if took > self.most:  # the first time it may have imported or compiled something
                answer, took = timed(ask)
        except Exception as error:
            raise self.fail(f"{what} raises", f"{what} raised {said(error)} ({when})") from error
        if took > self.most:
            told = f"{what} takes {1000.0 * took:.0f} ms of processor time ({when}), over {1000.0 * self.most:.0f} ms"
            raise self.fail("cost", told)
        return answer

    def twice(self, what: str, when: str, ask: Callable[[], Answer], *kinds: type) -> Answer:
        """Return what a wind answers both times; raises FailedError where that is of none of these types."""
        answer = self.ask(what, when, ask)
        if not isinstance(answer, kinds):
            due = f"not {kinds[0].__name__}{' or None' if len(kinds) > 1 else ''}"
            raise self.fail(what, f"{what} returned {type(answer).__name__}, {due} ({when})")
        if ask() != answer:
            self.add(f"{what} again", f"{what} answers differently when it is asked again ({when})")
        return answer


def timed(ask: Callable[[], Answer], /) -> tuple[Answer, float]:
    """Return an answer, and how long it took in processor time of this thread [s]: no other program counts."""
    start = thread_time()
    answer = ask()
    return answer, thread_time() - start


def try_part(part: WindPrimitive, report: Report, /, *, time: float, seed: int) -> list[Floats]:
    """Ask a part of a wind everything at `time` [s], and return its mask and its messages.

    Raises FailedError where it fails so that there are none.
    """
    when = f"at {time:g} s"
    frame(part, report, time=time)
    extent = part.extent(time=time)
    place = places_to_try(extent)
    mask = _Method("mask", lambda own, _: part.mask(own, time=time), (), report, when)
    weight = mask.try_at(place, grass_at(place))
    if weight.min() < 0.0 or weight.max() > 1.0:
        low, high = weight.min(), weight.max()
        report.add("mask range", f"mask returned weights from {low:g} to {high:g}, not within 0 and 1 ({when})")
    if extent is not None and weight[_outside(extent, place)].any():
        x, z = place[_outside(extent, place) & (weight != 0.0)][0].tolist()
        report.add("mask outside", f"mask is not 0 at ({x:g}, {z:g}), outside the extent ({when})")
    held = place[weight > 0.0]
    act = partial(part.action, time=time, seed=seed)
    action = _Method("action", lambda own, grass: act(own, grass=grass), (2,), report, when)
    message = action.try_at(held, grass_at(held))
    index = np.hypot(*message.astype(np.float64).T)
    if index.max(initial=0.0) > 1.0 + 1e-4:
        report.add("action index", f"action returned a posture index of {index.max():g}, which is over 1 ({when})")
    return [weight, message]


def frame(part: WindPrimitive, report: Report, /, *, time: float) -> None:
    """Ask a part of a wind where it is, twice. Raises FailedError where that is nowhere."""
    when = f"at {time:g} s"
    _stands("pose", report.twice("pose", when, partial(part.pose, time=time), Pose), report, when)
    extent = report.twice("extent", when, partial(part.extent, time=time), Extent, type(None))
    if extent is None:
        return
    _stands("extent", extent, report, when)
    if extent.left > extent.right or extent.ahead > extent.behind:
        raise report.fail("extent", f"extent returned {extent}, which ends before it begins ({when})")


def flight(wind: WindPrimitive, report: Report, times: Iterable[float], /) -> None:
    """Ask a wind for the path of what hovers over it, around times [s]. Raises FailedError where that is nowhere."""
    for moment in (time + shift for time in times for shift in (-PATH_STEP, 0.0, PATH_STEP)):
        when = f"at {moment:g} s, for what hovers over it"
        _stands("pose", report.twice("pose", when, partial(wind.pose, time=moment), Pose), report, when)


def times_of(wind: WindPrimitive, report: Report, /) -> None:
    """Ask a wind how fast its phases run, and when it is over. Raises FailedError where these are no numbers."""
    rates = report.ask("rates", "at any time", lambda: tuple(wind.rates()))
    if not all(_is_sound(rate, bounded=True) for rate in rates):
        raise report.fail("rates", f"rates returned {rates}, which is not all finite numbers")
    end = report.ask("ends", "at any time", wind.ends)
    if not _is_sound(end, bounded=False):
        raise report.fail("ends", f"ends returned {end!r}, not a time")


def _stands(what: str, answer: Pose | Extent, report: Report, when: str) -> None:
    numbers = astuple(answer)
    if isinstance(answer, Pose) and answer.y is None:  # it has no height, which is last
        numbers = numbers[:-1]
    if not all(_is_sound(number, bounded=what == "pose") for number in numbers):
        raise report.fail(what, f"{what} returned {answer}, which is not all numbers ({when})")


def _is_sound(number: object, *, bounded: bool) -> bool:
    if not isinstance(number, float | int | np.floating | np.integer):
        return False
    return isfinite(number) if bounded else not isnan(number)


def _outside(extent: Extent, place: Floats) -> NDArray[np.bool_]:
    x, z = place.T
    beside = (x < extent.left - BESIDE) | (x > extent.right + BESIDE)
    return np.asarray(beside | (z < extent.ahead - BESIDE) | (z > extent.behind + BESIDE))


@dataclass(frozen=True, slots=True)
class _Method:
    """A method of a wind that answers receivers with arrays."""

    name: str
    ask: Ask
    tail: tuple[int, ...]
    report: Report
    when: str

    def try_at(self, place: Floats, grass: Grass) -> Floats:
        """Return what it answers, having asked in every way."""
        answer = self._at(place, grass)
        if self._at(place, grass).tobytes() != answer.tobytes():
            self._differs("when it is asked again")
        order = np.random.default_rng(2).permutation(len(place))
        some = order[: max(1, len(place) // 3)]
        for rows, how in ((order, "in another order"), (some, "without some of the others"), (order[:1], "alone")):
            if len(rows) and not np.allclose(self._at(place[rows], grass.at(rows)), answer[rows], rtol=0.0, atol=CLOSE):
                self._differs(f"for the same receivers when they are asked {how}")
        self._at(place[:0], grass.at(order[:0]))
        return answer

    def _differs(self, how: str) -> None:
        self.report.add(f"{self.name} pure", f"{self.name} answers differently {how} ({self.when})")

    def _at(self, place: Floats, grass: Grass) -> Floats:
        given, shape = place.copy(), (len(place), *self.tail)
        answer = self.report.ask(self.name, f"{self.when}, {len(place)} receivers", lambda: self.ask(given, grass))
        if given.tobytes() != place.tobytes():
            self.report.add(f"{self.name} writes", f"{self.name} changes the places it is given ({self.when})")
        is_plain = isinstance(answer, np.ndarray) and not isinstance(answer, np.ma.MaskedArray)
        if not is_plain or answer.shape != shape:
            found = f"an array of shape {answer.shape}" if is_plain else type(answer).__name__
            raise self._fails("shape", f"returned {found} where an array of shape {shape} is due ({self.when})")
        if answer.dtype.kind not in "fiub":
            raise self._fails("type", f"returned {answer.dtype}, which is no number ({self.when})")
        if not np.isfinite(answer).all():
            x, z = place[~np.isfinite(answer).reshape(len(place), -1).all(axis=1)][0].tolist()
            raise self._fails("finite", f"returned what is not finite for ({x:g}, {z:g}) ({self.when})")
        return np.array(answer)

    def _fails(self, about: str, what: str) -> FailedError:
        return self.report.fail(f"{self.name} {about}", f"{self.name} {what}")
