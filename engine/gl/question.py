"""Questions that a graphics card answers itself: what depends on one is drawn or left out, and no program waits."""

from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_uint

import moderngl

from .functions import NUMBERS, functions_of
from .rasteriser import draws_in_software


class Question:
    """Whether any pixel of what was drawn last while `asking` has passed its tests of depth.

    A card holds up what is drawn `if_so` until it knows. A processor that draws goes on without it, and draws that too.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx, self._gl = ctx, functions_of(ctx)
        self._query = (c_uint * 1)()

    @contextmanager
    def asking(self) -> Iterator[None]:
        """Ask it of what is drawn meanwhile."""
        if not self._query[0]:
            self._gl.glGenQueries(1, self._query)
        self._gl.glBeginQuery(NUMBERS["ANY_SAMPLES_PASSED"], self._query[0])
        try:
            yield
        finally:
            self._gl.glEndQuery(NUMBERS["ANY_SAMPLES_PASSED"])

    @contextmanager
    def if_so(self) -> Iterator[None]:
        """Draw what is drawn meanwhile only if so."""
        waits = "QUERY_NO_WAIT" if draws_in_software(self._ctx) else "QUERY_WAIT"
        self._gl.glBeginConditionalRender(self._query[0], NUMBERS[waits])
        try:
            yield
        finally:
            self._gl.glEndConditionalRender()

    def release(self) -> None:
        """Give it back."""
        if self._query[0]:
            self._gl.glDeleteQueries(1, self._query)
            self._query[0] = 0
