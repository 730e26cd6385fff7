"""Smooth curves through points in time, for paths of cameras and winds."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..components.arrays import Doubles


@dataclass(frozen=True, slots=True)
class Curve:
    """A curve with a continuous first derivative; between two stops it is a cubic Hermite polynomial.

    It holds plain lists: for a single time, arrays cost more than the arithmetic.
    """

    times: list[float]
    """Time of each stop, rising [s]."""

    values: list[list[float]]
    """Value at each stop."""

    tangents: list[list[float]]
    """Derivative at each stop: of the parabola through the stop and its neighbours [1/s]."""

    @classmethod
    def through(cls, times: Doubles, values: Doubles, /) -> "Curve":
        """Return the curve through `values` (n, k) at rising `times` (n,)."""
        tangents = _tangents(times, values) if len(times) > 1 else np.zeros_like(values)
        return cls(times.tolist(), values.tolist(), tangents.tolist())

    def at(self, time: float, /) -> Sequence[float]:
        """Return the value at one time; outside of the curve, the value of its nearer end."""
        times = self.times
        if len(times) == 1 or time <= times[0]:
            return self.values[0]
        if time >= times[-1]:
            return self.values[-1]
        i = bisect_right(times, time) - 1
        span = times[i + 1] - times[i]
        t = (time - times[i]) / span
        hold, leave = t * t * (3.0 - 2.0 * t), t * (1.0 - t) ** 2
        arrive = t * t * (t - 1.0)
        ends = zip(self.values[i], self.values[i + 1], self.tangents[i], self.tangents[i + 1], strict=True)
        return [(1.0 - hold) * a + hold * b + span * (leave * out + arrive * into) for a, b, out, into in ends]


def _tangents(times: Doubles, values: Doubles) -> Doubles:
    steps = np.diff(times)[:, None]
    slopes = np.diff(values, axis=0) / steps
    inner = (slopes[:-1] * steps[1:] + slopes[1:] * steps[:-1]) / (steps[:-1] + steps[1:])
    return np.concatenate([slopes[:1], inner, slopes[-1:]])
