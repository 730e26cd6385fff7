"""A clock that moves only when a test says so, for whatever goes by pyglet's."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import isfinite


class FixedClock:
    """Time in equal steps, from 0: calling it gives the time [s], as pyglet's own time function does.

    `step` is the length of a step [s]; ValueError where that is not above 0.
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
        """The time [s], to the nearest microsecond."""
        return round(self.steps * self.step, 6)

    def tick(self, steps: int = 1) -> float:
        """Go some steps further, and let pyglet call what is scheduled after each; return the time [s].

        Inside `fixed_clock`, what is scheduled is told a dt of `step`, but for rounding. ValueError for negative
        numbers of steps.
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
    """Put a `FixedClock` in the place of pyglet's default clock, and in the end the host's back, with its schedules.

    What the body schedules by `pyglet.clock` runs when the yielded clock ticks, and never otherwise. `step` is the
    length of a step [s].
    """
    from pyglet import clock  # noqa: PLC0415 - so that a wind's own tests load no window library

    fixed, host = FixedClock(step), clock.get_default()
    mine = clock.Clock(fixed)
    mine.update_time()  # the first tick of a clock that has never been asked tells a dt of 0
    clock.set_default(mine)
    try:
        yield fixed
    finally:
        clock.set_default(host)
