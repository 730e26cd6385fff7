"""Timing what is drawn."""

from collections.abc import Callable
from time import perf_counter

import moderngl


def timed(ctx: moderngl.Context, work: Callable[[], object]) -> float:
    """Return how long some work takes, up to its end on the graphics card [ms]."""
    ctx.finish()
    start = perf_counter()
    work()
    ctx.finish()
    return 1000.0 * (perf_counter() - start)
