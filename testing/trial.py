"""Checks of one part of a wind at one time: its answers for receivers, and whether they depend on the way of asking."""

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
"""Greatest difference of answers for the same receivers in another order, or without some of the others."""

BESIDE = 0.01
"""Distance outside an extent from which its mask must be 0 [m]."""

FAR = 10000.0
"""Distance of the farthest receivers [m]."""

WIDE = 50.0
"""Half the side of the square of receivers for a wind without an extent [m]."""

_RESPONSES = ((2.0, 5.0), (5.0, 11.0))
"""Damping and angular frequency of two kinds, a tall soft one and a short stiff one [1/s]."""


def bounds(extent: Extent | None, /) -> tuple[float, float, float, float]:
    """Return the rectangle in which a wind is tried: left, right, ahead, behind [m]."""
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
    """Return grass of two kinds in turn, at positions (n, 2)."""
    step, samples = np.array([0.02, 0.01], np.float32), 256
    time = step[:, None].astype(np.float64) * np.arange(samples)
    fading, swinging = np.array(_RESPONSES).T[..., None]
    fall = (np.exp(-fading * time) * np.cos(swinging * time)).astype(np.float32)
    kind = np.arange(len(place)) % len(step)
    return Grass(kind.astype(np.intp), step, np.float32(1.0) - fall, fall)


class FailedError(Exception):
    """A wind's answer is so wrong that the trial ends."""


@dataclass(slots=True)
class Report:
    """Problems of a wind: one sentence for each, however often it occurs."""

    sentences: dict[str, str] = field(default_factory=dict)
    """Sentences by topic."""

    most: float = inf
    """Longest duration of an answer, in processor time of this thread [s]."""

    def add(self, about: str, sentence: str) -> None:
        """Add a sentence, unless there is one on this topic."""
        self.sentences.setdefault(about, sentence)

    def fail(self, about: str, sentence: str) -> FailedError:
        """Add a sentence, and return the error to raise."""
        self.add(about, sentence)
        return FailedError(sentence)

    def ask(self, what: str, when: str, ask: Callable[[], Answer]) -> Answer:
        """Return a wind's answer; raises FailedError where the wind raises anything or takes too long."""
        try:
            answer, took = timed(ask)
            if took > self.most:  # the first time it may have imported or compiled something
                answer, took = timed(ask)
        except (Exception, SystemExit) as error:
            raise self.fail(f"{what} raises", f"{what} raised {said(error)} ({when})") from error
        if took > self.most:
            cost = f"{what} takes {1000.0 * took:.0f} ms of processor time ({when}), over {1000.0 * self.most:.0f} ms"
            raise self.fail("cost", cost)
        return answer

    def twice(self, what: str, when: str, ask: Callable[[], Answer], *kinds: type) -> Answer:
        """Ask a wind twice, and return its answer; raises FailedError where that is of none of these types."""
        answer = self.ask(what, when, ask)
        if not isinstance(answer, kinds):
            due = f"not {kinds[0].__name__}{' or None' if len(kinds) > 1 else ''}"
            raise self.fail(what, f"{what} returned {type(answer).__name__}, {due} ({when})")
        if ask() != answer:
            self.add(f"{what} again", f"{what} answers differently when it is asked again ({when})")
        return answer


def timed(ask: Callable[[], Answer], /) -> tuple[Answer, float]:
    """Return an answer, and its duration in processor time of this thread [s], which other programs do not affect."""
    start = thread_time()
    answer = ask()
    return answer, thread_time() - start


def try_part(part: WindPrimitive, report: Report, /, *, time: float, seed: int) -> list[Floats]:
    """Check all methods of a part of a wind at `time` [s], and return its mask and its messages.

    Raises FailedError where it has none.
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
    """Check pose and extent of a part of a wind, asked twice. Raises FailedError where they are invalid."""
    when = f"at {time:g} s"
    _stands("pose", report.twice("pose", when, partial(part.pose, time=time), Pose), report, when)
    extent = report.twice("extent", when, partial(part.extent, time=time), Extent, type(None))
    if extent is None:
        return
    _stands("extent", extent, report, when)
    if extent.left > extent.right or extent.ahead > extent.behind:
        raise report.fail("extent", f"extent returned {extent}, which ends before it begins ({when})")


def flight(wind: WindPrimitive, report: Report, times: Iterable[float], /) -> None:
    """Check a wind's pose around times [s], for a body that hovers over it. Raises FailedError for an invalid pose."""
    for moment in (time + shift for time in times for shift in (-PATH_STEP, 0.0, PATH_STEP)):
        when = f"at {moment:g} s, for what hovers over it"
        _stands("pose", report.twice("pose", when, partial(wind.pose, time=moment), Pose), report, when)


def times_of(wind: WindPrimitive, report: Report, /) -> None:
    """Check the rates of a wind's phases and its end. Raises FailedError where these are no numbers."""
    rates = report.ask("rates", "at any time", lambda: tuple(wind.rates()))
    if not all(_is_sound(rate, bounded=True) for rate in rates):
        raise report.fail("rates", f"rates returned {rates}, which is not all finite numbers")
    end = report.ask("ends", "at any time", wind.ends)
    if not _is_sound(end, bounded=False):
        raise report.fail("ends", f"ends returned {end!r}, not a time")


def _stands(what: str, answer: Pose | Extent, report: Report, when: str) -> None:
    numbers = astuple(answer)
    if isinstance(answer, Pose) and answer.y is None:  # the height is the last field
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
    """A method of a wind that returns an array for receivers."""

    name: str
    ask: Ask
    tail: tuple[int, ...]
    report: Report
    when: str

    def try_at(self, place: Floats, grass: Grass) -> Floats:
        """Return its answer for all receivers, after asking for them again, in another order, in part and for none."""
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
