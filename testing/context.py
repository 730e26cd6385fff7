"""A GL context for tests, without a window and without a display."""

from collections.abc import Iterator
from contextlib import contextmanager

import moderngl

from ..engine.gl.headless import standalone_context


@contextmanager
def headless_context() -> Iterator[moderngl.Context]:
    """Make a GL context of OpenGL 3.3 or newer without a window, and give it back in the end.

    A small framebuffer is bound in it, because without one there is nothing to draw into. A software rasteriser will
    do. Raises NoContextError, a RuntimeError of one sentence that says what to install, where there is none. A second
    context takes the place of the first: make one for a whole run of tests.
    """
    ctx = standalone_context()
    try:
        ctx.simple_framebuffer((1, 1)).use()
        yield ctx
    finally:
        ctx.release()
