"""Occlusion queries with conditional rendering: the graphics card decides what is drawn, and no program waits."""

from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_int, c_uint

import moderngl

from .functions import ENUMS, functions_of
from .rasteriser import draws_in_software


class OcclusionQuery:
    """Query whether any pixel drawn inside `asking` has passed the depth test, for drawing inside `if_so`.

    A card makes conditional drawing wait for the result. A software rasteriser does not wait, and draws all. So does a
    card while a query of the host is active, as only one query of a kind can be active.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx, self._gl = ctx, functions_of(ctx)
        self._query = (c_uint * 1)()
        self._is_asked = False

    @contextmanager
    def asking(self) -> Iterator[None]:
        """Ask whether any pixel drawn inside passes the depth test."""
        self._is_asked = not self._counts_for_host()
        if not self._is_asked:
            yield
            return
        if not self._query[0]:
            self._gl.glGenQueries(1, self._query)
        self._gl.glBeginQuery(ENUMS["ANY_SAMPLES_PASSED"], self._query[0])
        try:
            yield
        finally:
            self._gl.glEndQuery(ENUMS["ANY_SAMPLES_PASSED"])

    @contextmanager
    def if_so(self) -> Iterator[None]:
        """Draw what is inside only if any pixel passed."""
        if not self._is_asked:
            yield
            return
        waits = "QUERY_NO_WAIT" if draws_in_software(self._ctx) else "QUERY_WAIT"
        self._gl.glBeginConditionalRender(self._query[0], ENUMS[waits])
        try:
            yield
        finally:
            self._gl.glEndConditionalRender()

    def _counts_for_host(self) -> bool:
        own = (c_int * 1)()
        for counted in ("ANY_SAMPLES_PASSED", "SAMPLES_PASSED"):
            self._gl.glGetQueryiv(ENUMS[counted], ENUMS["CURRENT_QUERY"], own)
            if own[0]:
                return True
        return False

    def release(self) -> None:
        """Delete the query."""
        if self._query[0]:
            self._gl.glDeleteQueries(1, self._query)
            self._query[0] = 0
