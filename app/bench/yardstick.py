"""A fixed piece of arithmetic, timed in the same run, so that figures of two machines can be compared."""

from time import perf_counter

import numpy as np

TIMINGS = 5
"""Times it is done; the least counts."""

ROUNDS = 10
"""Rounds of arithmetic each time."""


def yardstick_ms() -> float:
    """Return how long the arithmetic takes on this machine now [ms]: sines and roots of 200,000 places, ten times."""
    places = np.random.default_rng(0).random((200_000, 2), np.float32)
    times = []
    for _ in range(TIMINGS):
        start = perf_counter()
        for _ in range(ROUNDS):
            np.sin(places) * places + np.sqrt(places)
        times.append(perf_counter() - start)
    return round(1000.0 * min(times), 3)
