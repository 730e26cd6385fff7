"""Drawing into memory, without a window and without a display."""

from typing import Self

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl import headless
from ...engine.gl.stream import release_all
from .errors import MachineError


class Offscreen:
    """A framebuffer of 8-bit RGBA colour and depth, to draw pictures into; a context manager.

    Without `ctx` it makes a context of its own, by EGL or else by GLX, and gives it back at the end. `size` is
    (width, height) [pixels]. With `ctx`, what was bound in it is bound again at the end. Raises MachineError where
    there is no OpenGL 3.3.
    """

    def __init__(self, size: tuple[int, int], ctx: moderngl.Context | None = None) -> None:
        self.size = size
        self._host = None if ctx is None else ctx.detect_framebuffer()
        self.ctx = standalone_context() if ctx is None else ctx
        self._color = self.ctx.texture(size, 4)
        self._depth = self.ctx.depth_renderbuffer(size)
        self._target = self.ctx.framebuffer([self._color], self._depth)

    def __enter__(self) -> Self:
        self.begin()
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def begin(self) -> None:
        """Bind the framebuffer and clear it: what is drawn next goes into it."""
        self._target.use()
        self._target.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)

    def read(self) -> NDArray[np.uint8]:
        """Return the picture in the framebuffer, top row first, shape (height, width, 3)."""
        width, height = self.size
        data = self._target.read(components=3, alignment=1)
        return np.ascontiguousarray(np.frombuffer(data, np.uint8).reshape(height, width, 3)[::-1])

    def make_current(self) -> None:
        """Make an own context current: in another, deleting would hit that one's objects of the same ids."""
        if self._host is None:
            self.ctx.__enter__()  # type: ignore[no-untyped-call]

    def release(self) -> None:
        """Give the framebuffer back, and the context if it is an own one."""
        self.make_current()
        if self._host is not None:
            self._host.use()
        release_all(self._target, self._color, self._depth)
        if self._host is None:
            self.ctx.release()


def standalone_context() -> moderngl.Context:
    """Return a new context without a window; raises MachineError with the message of each way that failed."""
    try:
        return headless.standalone_context()
    except headless.NoContextError as error:
        raise MachineError(str(error)) from error
