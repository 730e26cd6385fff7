"""Quarantine: winds that fail, return invalid values or are too slow are left out, and the frame goes on.

A wind is timed in processor time of this thread, never by the clock: results must not depend on the machine's load. The
one exception is a game, which leaves out a wind that waits, because the game stands still meanwhile.
"""

import logging
from collections.abc import Callable, Iterable, MutableMapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import inf, isnan
from time import perf_counter, thread_time
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from ...components.arrays import Floats
from ...components.pose import Pose
from ...components.wind import Extent, WindPrimitive, WindSource
from ...engine.complaint import said
from ...engine.plugins import wind_kinds
from ...engine.schedule import has_waited, is_often

Answer = TypeVar("Answer")
Called = tuple[str, type[WindPrimitive]]
"""Name and class of a wind: the key of slow winds, as a game may change a wind's values in every frame."""

SLOW, SLOW_EACH = 0.1, 2e-6
"""Processor time from which on a call is slow [s], and the additional time allowed for each receiver [s]."""

NOTICED = 0.02
"""Processor time from which on a call is warned of [s], as in `plugins check` for 10,000 receivers.

With more receivers it is `SLOW_EACH` for each.
"""

STALLED = 3.0
"""Processor time from which on a single call is slow [s]."""

WAIT, LONGEST_WAIT = 5.0, 60.0
"""First and longest time that a slow wind is left out, on the prairie's clock [s]; it doubles every time."""

LARGEST = 1e6
"""Bound of the numbers that a mask or an action returns; valid ones are 1 at most."""

PLAIN = float, int
"""Types of nearly all numbers; others take a slower check."""

FARTHEST = 1e12
"""Bound of a flying body's coordinates [m], well before numbers overflow."""

log = logging.getLogger("tallgrass")


class QuarantinedError(Exception):
    """The wind is left out, from now on or since before."""


@dataclass(slots=True)
class Quarantine:
    """The winds that are left out, with reasons. The built-in winds are not timed."""

    reasons: MutableMapping[WindSource, str] = field(default_factory=WeakKeyDictionary)
    """Reason for each wind that is left out, one sentence, kept as long as the wind exists."""

    count: int = 0
    """Number of times that a wind has been left out."""

    live: bool = True
    """Whether a wind that takes too long is left out for a while; otherwise it is kept, with a warning."""

    come_back: Callable[[], str] = lambda: ""
    """Undoes a change that no wind may leave behind; returns what was done, as "left ...", or ""."""

    _asked: int = 0
    """Number of answers of strangers' winds that are being waited for, one within the other."""

    _timed: dict[type[WindPrimitive], bool] = field(default_factory=dict)
    """Whether each class of winds is timed; the built-in ones are not."""

    _now: float = 0.0
    """The prairie's clock [s]."""

    _back: dict[Called, tuple[float, str]] = field(default_factory=dict)
    """Time when a slow wind is tried again, on the prairie's clock [s], and the reason why it is left out."""

    _wait: dict[Called, float] = field(default_factory=dict)
    """Time that a wind will be left out when it is slow the next time [s]."""

    _slow: dict[tuple[Called, str, str], int] = field(default_factory=dict)
    """Latest calls that took long, as `is_often` notes them, by wind, method and verdict."""

    _warned: set[tuple[str, str]] = field(default_factory=set)
    """Warnings logged so far: a name, and the sort of warning."""

    def ask(self, source: WindSource, what: str, ask: Callable[[], Answer], /, *, receivers: int = 0) -> Answer:
        """Return a wind's answer; raises QuarantinedError where the wind fails, or is left out already."""
        if self.count and source in self.reasons:
            raise QuarantinedError
        if self._back and (called := _called(source)) in self._back:
            self.reasons[source] = self._back[called][1]  # the same wind with other values
            raise QuarantinedError
        kind = type(source.primitive)
        is_timed = self._timed[kind] if kind in self._timed else self._is_timed(kind)
        begun, start = (perf_counter(), thread_time()) if is_timed else (0.0, 0.0)
        self._asked += is_timed
        try:
            answer = ask()
        except (Exception, SystemExit) as error:  # a plugin may raise anything
            log.debug("%s", source.name, exc_info=error)
            self.come_back()
            raise self.leave_out(source, f"{what} raised {said(error)}") from error
        finally:
            self._asked -= is_timed
        if is_timed:
            if left := self.come_back():
                raise self.leave_out(source, f"{what} {left}")
            took = thread_time() - start
            self._judge(source, what, took, receivers)
            self._judge_waiting(source, what, perf_counter() - begun, took)
        return answer

    def must_be_idle(self, purpose: str, /) -> None:
        """Raise RuntimeError while a wind is asked, which cannot do what `purpose` says, as "release it"."""
        if self._asked:
            raise RuntimeError(f"a wind of this prairie is being asked: it cannot {purpose}; do so before or after")

    def _is_timed(self, kind: type[WindPrimitive]) -> bool:
        self._timed[kind] = found = not wind_kinds().is_ours(kind)
        return found

    def ask_for(self, source: WindSource, what: str, ask: Callable[[], Floats], /, *, shape: tuple[int, ...]) -> Floats:
        """Return the array that a wind answers, as float32.

        Raises QuarantinedError unless it has this shape and its numbers are finite.
        """
        answer = self.ask(source, what, ask, receivers=shape[0])
        if not isinstance(answer, np.ndarray) or answer.shape != shape:
            found = f"an array of shape {answer.shape}" if isinstance(answer, np.ndarray) else type(answer).__name__
            raise self.leave_out(source, f"{what} returned {found} where shape {shape} is due")
        if answer.dtype.kind not in "fiub":
            raise self.leave_out(source, f"{what} returned {answer.dtype}, which is no number")
        if not (np.abs(answer) < LARGEST).all():  # also true of NaN
            which = "far beyond 1" if np.isfinite(answer).all() else "that are not finite"
            raise self.leave_out(source, f"{what} returned numbers {which}")
        return np.asarray(answer, np.float32)

    def ask_pose(self, source: WindSource, *, time: float) -> Pose:
        """Return a wind's pose at `time` [s]; raises QuarantinedError where it is invalid, or too far for a body."""
        pose = self.ask(source, "pose", partial(source.primitive.pose, time=time))
        self.must_be(source, "pose", pose, Pose)
        self._must_be_numbers(source, "pose", (pose.x, pose.z, pose.yaw))
        if max(abs(pose.x), abs(pose.z)) >= FARTHEST:
            raise self.leave_out(source, "pose returned numbers far beyond any prairie")
        return pose

    def ask_rates(self, source: WindSource, go_on: Callable[[], WindPrimitive], /) -> WindPrimitive:
        """Ask for a wind's rates, before other answers need them, and return what `go_on` makes by them.

        Raises QuarantinedError where they are no numbers.
        """
        rates, wind = self.ask(source, "rates", lambda: (source.primitive.rates(), go_on()))
        self.must_be(source, "rates", rates, Sequence, np.ndarray)
        self._must_be_numbers(source, "rates", rates)
        return wind

    def ask_end(self, source: WindSource, ends: Callable[[], float]) -> float:
        """Return the time when a wind is over for good [s], `inf` for never; raises QuarantinedError for no number."""
        end = self.ask(source, "ends", ends)
        self._must_be_numbers(source, "ends", (end,))
        return float(end)

    def must_be(self, source: WindSource, what: str, answer: object, /, *kinds: type) -> None:
        """Raise QuarantinedError unless a wind's answer is of one of these types."""
        if not isinstance(answer, kinds):
            raise self.leave_out(source, f"{what} returned {type(answer).__name__}, not {kinds[0].__name__}")

    def must_stand(self, source: WindSource, part: WindPrimitive, pose: Pose, extent: Extent | None, /) -> None:
        """Raise QuarantinedError unless a part's fields, pose and extent are valid numbers."""
        self.must_be(source, "parts, of the kind of one,", part.kind, str)
        declared = part.priority, part.weight, part.swing, part.start, part.ease
        self._must_be_numbers(source, "parts, of what one declares,", declared)
        self._must_be_numbers(source, "pose", (pose.x, pose.z, pose.yaw))
        if extent is not None:
            self._must_be_numbers(source, "extent", (extent.left, extent.right, extent.ahead, extent.behind))
        if extent is not None and (extent.left > extent.right or extent.ahead > extent.behind):
            raise self.leave_out(source, f"extent returned {extent}, which ends before it begins")

    def leave_out(self, source: WindSource, why: str, /) -> QuarantinedError:
        """Leave a wind out from now on, warn once for its kind, and return the error to raise."""
        self.reasons[source] = f"{source.name}: {why}"
        self.count += 1
        self._say_once((source.primitive.kind, "fails"), source, f"{why}; this wind is left out from now on")
        return QuarantinedError(why)

    def _must_be_numbers(self, source: WindSource, what: str, numbers: Iterable[float]) -> None:
        """Raise QuarantinedError unless all numbers are finite; an end and an extent may be infinite."""
        for number in numbers:
            if type(number) in PLAIN and -inf < number < inf:
                continue
            self.must_be(source, what, number, float, int, np.floating, np.integer)
            if isnan(number) or (abs(number) == inf and what not in ("ends", "extent")):
                raise self.leave_out(source, f"{what} returned numbers that are not finite")

    def let_back(self, now: float, /) -> None:
        """Let slow winds back in whose wait is over `now` [s], on the prairie's clock; all if it has gone back."""
        since, self._now = self._now, now
        for called in [called for called, (back, _) in self._back.items() if back <= now or now < since]:
            _, why = self._back.pop(called)
            for source in [source for source, reason in self.reasons.items() if reason == why]:
                if _called(source) == called:
                    del self.reasons[source]
            self._slow = {key: latest for key, latest in self._slow.items() if key[0] != called}

    def _judge(self, source: WindSource, what: str, took: float, receivers: int) -> None:
        """Warn of a wind that often takes long; raises QuarantinedError where that is too long for a game."""
        extra = SLOW_EACH * receivers
        call = _called(source), what
        is_noticed = is_often(self._slow, (*call, "noticed"), is_long=took > max(NOTICED, extra))
        is_slow = is_often(self._slow, (*call, "slow"), is_long=took > SLOW + extra) or took > STALLED
        duration = f"{1000.0 * took:.0f} ms of processor time"
        if is_slow and self.live:
            raise self._leave_out_for_now(source, f"{what} takes too long: {duration}")
        if is_slow:
            self._say_once((source.name, "takes long"), source, f"{what} takes too long: {duration}")
        elif is_noticed:
            self._say_once((source.name, "takes long"), source, f"{what} takes {duration}")

    def _judge_waiting(self, source: WindSource, what: str, took: float, busy: float) -> None:
        """Warn of a wind that waits; raises QuarantinedError where it often waits in a game.

        `took` is the call's elapsed time and `busy` its processor time [s].
        """
        waits, waited = has_waited(took, busy), took - busy
        is_too_often = is_often(self._slow, (_called(source), what, "waits"), is_long=waits)
        if waits:
            self._say_once((source.name, "waits"), source, f"{what} waits: for {waited:.1f} s, and the game with it")
        if is_too_often and self.live:
            raise self._leave_out_for_now(source, f"{what} waits for {waited:.1f} s at a time")

    def _leave_out_for_now(self, source: WindSource, why: str) -> QuarantinedError:
        """Leave a slow wind out for a while, warn once of it, and return the error to raise."""
        called, reason = _called(source), f"{source.name}: {why}"
        wait = self._wait.get(called, WAIT)
        self._wait[called] = min(2.0 * wait, LONGEST_WAIT)
        self._back[called] = self._now + wait, reason
        self.reasons[source] = reason
        self.count += 1
        self._say_once((source.name, "too slow"), source, f"{why}; this wind is left out for a while")
        return QuarantinedError(why)

    def _say_once(self, about: tuple[str, str], source: WindSource, sentence: str) -> None:
        if about not in self._warned:
            self._warned.add(about)
            log.warning("%s of %s: %s", source.name, wind_kinds().origin(source.primitive), sentence)


def _called(source: WindSource) -> Called:
    return source.name, type(source.primitive)
