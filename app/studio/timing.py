"""Timing of drawing."""

from collections.abc import Callable, Sequence
from time import perf_counter

import moderngl
import numpy as np

from ...engine.gl.rasteriser import draws_in_software


def timed(ctx: moderngl.Context, work: Callable[[], object]) -> float:
    """Return the time of some work up to its end on the graphics card [ms]."""
    ctx.finish()
    start = perf_counter()
    work()
    ctx.finish()
    return 1000.0 * (perf_counter() - start)


def card_timer(ctx: moderngl.Context) -> moderngl.Query | None:
    """Return a timer query of the graphics card, or None in software, where it would time the CPU."""
    return None if draws_in_software(ctx) else ctx.query(time=True)


def spread(times: Sequence[float], /, *parts: int) -> dict[str, float]:
    """Return percentiles of times [ms] by name, such as `p50`."""
    return {f"p{part}": round(float(np.percentile(times, part)), 3) for part in parts}
