"""The course of a wind: how far its phases have come, whatever a game has changed on the way."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

MOST_CHANGES = 1024
"""How many changes are remembered, the latest ones: 17 s of a ramp at 60 frames a second."""

Phases = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Course:
    """Phases that run at rates which have changed: integrals over time, in pieces between the changes.

    In each piece a phase is an offset plus a rate times the time, so that nothing is summed up step by step: between
    two changes it is the same to the bit, however time is cut into frames.
    """

    times: tuple[float, ...]
    """When the rates changed [s], rising."""

    rates: tuple[Phases, ...]
    """The rates before the first change, and from each one on."""

    offsets: tuple[Phases, ...]
    """What is added to rate times time in each piece, so that it begins where the one before ends."""

    @classmethod
    def of(cls, rates: Sequence[float], /) -> "Course":
        """Return the course of phases whose rates have not changed yet: 0 at time 0."""
        return cls((), (tuple(rates),), ((0.0,) * len(rates),))

    def changed(self, rates: Sequence[float], /, *, time: float) -> "Course":
        """Return the course on which the rates are others from `time` [s] on; what was to come after that is gone."""
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
        """Return how far the phases have come from `since` to `time` [s]."""
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
        """The least rate of each phase."""
        return tuple(map(min, zip(*self.rates, strict=True)))
