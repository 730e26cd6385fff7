"""Timing of drawing: by the graphics card's timer queries, or by the clock where there is no card."""

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import Array, c_int, c_uint, c_uint64
from functools import cached_property
from time import perf_counter

import moderngl

from .functions import ENUMS, functions_of
from .limits import limits_of
from .rasteriser import draws_in_software

Name = tuple[str, int]
"""Name of a drawing: its viewer, and the picture's number."""

MOST_UNDERWAY = 6
"""Greatest number of timer queries without a result yet; while there are more, nothing is timed."""


class Stopwatch:
    """Times named drawings in one GL context.

    It never waits for a card: a time is known some frames later. Without a card, or with one that has no timer, it
    waits until everything is drawn.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx, self._gl = ctx, functions_of(ctx)
        self._underway: deque[tuple[Name, Array[c_uint]]] = deque()
        self._known: list[tuple[Name, float]] = []

    @cached_property
    def waits(self) -> bool:
        """Whether there is no timer of a card, so that `timing` waits until everything is drawn."""
        return draws_in_software(self._ctx) or not limits_of(self._gl).timed

    @contextmanager
    def timing(self, name: Name, /) -> Iterator[None]:
        """Time what is drawn inside."""
        if self.waits:
            start = perf_counter()
            yield
            self._ctx.finish()
            self._known.append((name, perf_counter() - start))
        elif len(self._underway) >= MOST_UNDERWAY:
            yield
        else:
            stamps = (c_uint * 2)()
            self._gl.glGenQueries(2, stamps)
            self._gl.glQueryCounter(stamps[0], ENUMS["TIMESTAMP"])
            try:
                yield
            finally:
                self._gl.glQueryCounter(stamps[1], ENUMS["TIMESTAMP"])
                self._underway.append((name, stamps))

    def read(self) -> list[tuple[Name, float]]:
        """Return the names and times [s] that became known since the last call, the earliest first."""
        while self._underway and self._is_over(self._underway[0][1]):
            name, stamps = self._underway.popleft()
            self._known.append((name, self._took(stamps)))
        known, self._known = self._known, []
        return known

    def release(self) -> None:
        """Delete the queries that are underway."""
        for _, stamps in self._underway:
            self._gl.glDeleteQueries(2, stamps)
        self._underway.clear()

    def _is_over(self, stamps: Array[c_uint]) -> bool:
        found = (c_int * 1)()
        self._gl.glGetQueryObjectiv(stamps[1], ENUMS["QUERY_RESULT_AVAILABLE"], found)
        return bool(found[0])

    def _took(self, stamps: Array[c_uint]) -> float:
        """Return the time between two stamps that are known [s], and delete them."""
        times = []
        for stamp in stamps:
            found = (c_uint64 * 1)()
            self._gl.glGetQueryObjectui64v(stamp, ENUMS["QUERY_RESULT"], found)
            times.append(found[0])
        self._gl.glDeleteQueries(2, stamps)
        return 1e-9 * (times[1] - times[0])
