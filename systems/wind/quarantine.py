"""Quarantine: a wind that raises, returns rubbish or takes too long is left out, and the frame goes on."""

import logging
from collections.abc import Callable, Iterable
from dataclasses import astuple, dataclass, field
from functools import partial
from math import inf, isnan
from time import perf_counter
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...components.pose import Pose
from ...components.wind import Extent, WindPrimitive, WindSource
from ...engine.complaint import said
from ...engine.plugins import wind_kinds

Floats = NDArray[np.float32]
Answer = TypeVar("Answer")

SLOW, SLOW_EACH = 0.1, 2e-6
"""How long a call may take [s], and how much longer for each receiver."""

STALLED = 3.0
"""How long no single call may take [s]."""

PATIENCE, WINDOW = 3, 16
"""How many slow calls, of how many calls of one method, a wind is left out for: a machine may be busy once or twice."""

LARGEST = 1e6
"""No number that a mask or an action returns may be this large; both are due to be 1 at most."""

FARTHEST = 1e12
"""No body may fly as far away as this [m]: well before numbers overflow."""

log = logging.getLogger("tallgrass")


class QuarantinedError(Exception):
    """The wind has just been left out, or was before."""


@dataclass(slots=True)
class Quarantine:
    """The winds that are left out, and why."""

    reasons: dict[WindSource, str] = field(default_factory=dict)
    """One sentence for each wind that is left out."""

    _slow: dict[tuple[WindSource, str], int] = field(default_factory=dict)
    """Which of a method's latest calls were slow, one bit for each."""

    def ask(self, source: WindSource, what: str, ask: Callable[[], Answer], /, *, receivers: int = 0) -> Answer:
        """Return what a wind answers; raises QuarantinedError where it fails to, or has failed before."""
        if source in self.reasons:
            raise QuarantinedError
        start = perf_counter()
        try:
            answer = ask()
        except Exception as error:  # a plugin may raise anything
            log.debug("%s", source.name, exc_info=error)
            raise self.leave_out(source, f"{what} raised {said(error)}") from error
        self._time(source, what, perf_counter() - start, SLOW + SLOW_EACH * receivers)
        return answer

    def ask_for(self, source: WindSource, what: str, ask: Callable[[], Floats], /, *, shape: tuple[int, ...]) -> Floats:
        """Return the array that a wind answers: of this shape, finite, float32.

        Raises QuarantinedError where it is anything else.
        """
        answer = self.ask(source, what, ask, receivers=shape[0])
        if not isinstance(answer, np.ndarray) or answer.shape != shape:
            found = f"an array of shape {answer.shape}" if isinstance(answer, np.ndarray) else type(answer).__name__
            raise self.leave_out(source, f"{what} returned {found} where shape {shape} is due")
        if answer.dtype.kind not in "fiub":
            raise self.leave_out(source, f"{what} returned {answer.dtype}, which is no number")
        if not (np.abs(answer) < LARGEST).all():  # what is not finite is no less than anything
            which = "far beyond 1" if np.isfinite(answer).all() else "that are not finite"
            raise self.leave_out(source, f"{what} returned numbers {which}")
        return np.asarray(answer, np.float32)

    def ask_pose(self, source: WindSource, *, time: float) -> Pose:
        """Return where a wind says that it is at `time` [s]; raises QuarantinedError where no body can fly."""
        pose = self.ask(source, "pose", partial(source.primitive.pose, time=time))
        self.must_be(source, "pose", pose, Pose)
        self._must_count(source, "pose", (pose.x, pose.z, pose.yaw))
        if max(abs(pose.x), abs(pose.z)) >= FARTHEST:
            raise self.leave_out(source, "pose returned numbers far beyond any prairie")
        return pose

    def must_be(self, source: WindSource, what: str, answer: object, /, *kinds: type) -> None:
        """Raise QuarantinedError unless a wind's answer is of one of these types."""
        if not isinstance(answer, kinds):
            raise self.leave_out(source, f"{what} returned {type(answer).__name__}, not {kinds[0].__name__}")

    def must_stand(self, source: WindSource, part: WindPrimitive, pose: Pose, extent: Extent | None, /) -> None:
        """Raise QuarantinedError unless what a part says of itself can be reckoned with."""
        self.must_be(source, "parts, of the kind of one,", part.kind, str)
        told = {
            "parts, of what one declares,": (part.priority, part.weight, part.swing, part.start, part.ease),
            "pose": astuple(pose),
            "extent": () if extent is None else astuple(extent),
        }
        for what, numbers in told.items():
            self._must_count(source, what, numbers)

    def leave_out(self, source: WindSource, why: str, /) -> QuarantinedError:
        """Leave a wind out from now on, say so once for its kind, and return what to raise."""
        told = {known.primitive.kind for known in self.reasons}
        self.reasons[source] = f"{source.name}: {why}"
        if source.primitive.kind not in told:
            origin = wind_kinds().origin(source.primitive)
            log.warning("%s of %s: %s; this wind is left out from now on", source.name, origin, why)
        return QuarantinedError(why)

    def _must_count(self, source: WindSource, what: str, numbers: Iterable[float]) -> None:
        for number in numbers:
            self.must_be(source, what, number, float, int, np.floating, np.integer)
            if isnan(number) or (abs(number) == inf and what != "extent"):
                raise self.leave_out(source, f"{what} returned numbers that are not finite")

    def _time(self, source: WindSource, what: str, took: float, allowed: float) -> None:
        before = self._slow.get((source, what), 0)
        latest = (before << 1 | (took > allowed)) & ((1 << WINDOW) - 1)
        self._slow[source, what] = latest
        if took > STALLED or latest.bit_count() >= PATIENCE:
            raise self.leave_out(source, f"{what} takes too long: {1000.0 * took:.0f} ms")
