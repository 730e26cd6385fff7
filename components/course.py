"""The course of a wind: its phases over time, continuous across a game's changes of their rates."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

MOST_CHANGES = 1024
"""Number of latest changes that are kept: 17 s of a ramp at 60 frames a second."""

Phases = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Course:
    """Phases of changing rates: integrals of the rates over time, piecewise linear between changes.

    In each piece a phase is an offset plus the rate times the time. Nothing is summed step by step, so between two
    changes phases are the same bit by bit, however time is cut into frames.
    """

    times: tuple[float, ...]
    """Times of the changes [s], rising."""

    rates: tuple[Phases, ...]
    """Rates before the first change, and after each change [1/s]."""

    offsets: tuple[Phases, ...]
    """Offsets in each piece, which make phases continuous."""

    @classmethod
    def of(cls, rates: Sequence[float], /) -> "Course":
        """Return the course of phases whose rates have not changed yet: 0 at time 0."""
        return cls((), (tuple(rates),), ((0.0,) * len(rates),))

    def changed(self, rates: Sequence[float], /, *, time: float) -> "Course":
        """Return the course with new rates from `time` [s] on; later changes are dropped."""
        if len(rates) != len(self.rates[-1]):
            return Course.of(rates)
        kept = bisect_right(self.times, time)
        kept -= kept > 0 and self.times[kept - 1] == time  # changed again at the same moment
        ran = zip(self.offsets[kept], self.rates[kept], rates, strict=True)
        offsets = tuple(offset + (before - after) * time for offset, before, after in ran)
        first = max(0, kept + 1 - MOST_CHANGES)
        return Course(
            (*self.times[first:kept], time),
            (*self.rates[first : kept + 1], tuple(rates)),
            (*self.offsets[first : kept + 1], offsets),
        )

    def phases(self, time: float, /, *, since: float = 0.0) -> Phases:
        """Return the advance of each phase from `since` to `time` [s]."""
        late, early = bisect_right(self.times, time), bisect_right(self.times, since) if since else 0
        came = (rate * (time - since) for rate in self.rates[late])
        if late == early:
            return tuple(came)
        shifts = zip(self.offsets[late], self.offsets[early], self.rates[late], self.rates[early], strict=True)
        return tuple(
            way + (offset - before + (rate - slower) * since)
            for way, (offset, before, rate, slower) in zip(came, shifts, strict=True)
        )

    @property
    def slowest(self) -> Phases:
        """Least rate of each phase [1/s]."""
        return tuple(map(min, zip(*self.rates, strict=True)))
