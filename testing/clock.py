"""A clock that a test advances, in place of pyglet's."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import isfinite


class FixedClock:
    """Time in equal steps from 0; calling it returns the time [s], as pyglet's own time function does.

    `step` is the length of a step [s]; ValueError where it is not above 0.
    """

    def __init__(self, step: float = 1 / 60) -> None:
        if not (isfinite(step) and step > 0.0):
            raise ValueError(f"a clock's step is above 0 s, not {step}")
        self.step = step
        self.steps = 0

    def __call__(self) -> float:
        """Return the time [s]."""
        return self.time

    @property
    def time(self) -> float:
        """Time, rounded to microseconds [s]."""
        return round(self.steps * self.step, 6)

    def tick(self, steps: int = 1) -> float:
        """Advance by `steps`, and let pyglet call scheduled functions after each; return the time [s].

        Inside `fixed_clock`, they get a dt of `step`, up to rounding. ValueError for a negative number.
        """
        from pyglet import clock  # noqa: PLC0415 - so that a wind's own tests load no window library

        if steps < 0:
            raise ValueError(f"time does not run back by {-steps} steps")
        for _ in range(steps):
            self.steps += 1
            clock.tick(poll=True)
        return self.time


@contextmanager
def fixed_clock(step: float = 1 / 60) -> Iterator[FixedClock]:
    """Replace pyglet's default clock by a `FixedClock`, and in the end restore the host's clock with its schedules.

    Functions that the body schedules by `pyglet.clock` run only when the yielded clock ticks. `step` is the length of a
    step [s].
    """
    from pyglet import clock  # noqa: PLC0415 - so that a wind's own tests load no window library

    fixed, host = FixedClock(step), clock.get_default()
    mine = clock.Clock(fixed)
    mine.update_time()  # otherwise the first tick of a new clock would have a dt of 0
    clock.set_default(mine)
    try:
        yield fixed
    finally:
        clock.set_default(host)
