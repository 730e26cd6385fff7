"""Quarantine: a wind that raises, returns rubbish or takes too long is left out, and the frame goes on."""

import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...components.wind import WindSource

Floats = NDArray[np.float32]
Answer = TypeVar("Answer")

SLOW, SLOW_EACH = 0.1, 2e-6
"""How long a call may take [s], and how much longer for each receiver; a third slow call running is one too many."""

STALLED = 3.0
"""How long no single call may take [s]."""

PATIENCE = 3
"""Slow calls running that a wind is left out for: a machine may be busy once or twice."""

log = logging.getLogger("tallgrass")


class QuarantinedError(Exception):
    """The wind has just been left out, or was before."""


@dataclass(slots=True)
class Quarantine:
    """The winds that are left out, and why."""

    reasons: dict[WindSource, str] = field(default_factory=dict)
    """One sentence for each wind that is left out."""

    _slow: dict[WindSource, int] = field(default_factory=dict)

    def ask(self, source: WindSource, what: str, ask: Callable[[], Answer], /, *, receivers: int = 0) -> Answer:
        """Return what a wind answers; raises QuarantinedError where it fails to, or has failed before."""
        if source in self.reasons:
            raise QuarantinedError
        start = perf_counter()
        try:
            answer = ask()
        except Exception as error:  # a plugin may raise anything
            raise self.leave_out(source, f"{what} raised {type(error).__name__}: {error}") from error
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
        if not np.isfinite(answer).all():
            raise self.leave_out(source, f"{what} returned numbers that are not finite")
        return np.asarray(answer, np.float32)

    def must_be(self, source: WindSource, what: str, answer: object, /, *kinds: type) -> None:
        """Raise QuarantinedError unless a wind's answer is of one of these types."""
        if not isinstance(answer, kinds):
            raise self.leave_out(source, f"{what} returned {type(answer).__name__}, not {kinds[0].__name__}")

    def leave_out(self, source: WindSource, why: str, /) -> QuarantinedError:
        """Leave a wind out from now on, say so once, and return what to raise."""
        told = {known.primitive.kind for known in self.reasons}
        self.reasons[source] = f"{source.name}: {why}"
        if source.primitive.kind not in told:
            log.warning("%s: %s; this wind is left out from now on", source.name, why)
        return QuarantinedError(why)

    def _time(self, source: WindSource, what: str, took: float, allowed: float) -> None:
        slow = self._slow.get(source, 0) + 1 if took > allowed else 0
        self._slow[source] = slow
        if took > STALLED or slow >= PATIENCE:
            raise self.leave_out(source, f"{what} takes too long: {1000.0 * took:.0f} ms")
