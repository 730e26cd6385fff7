"""A multisampled framebuffer: the graphics card's own antialiasing."""

import moderngl

from ...engine.gl.stream import release_all

FINE = 4
"""Number of samples a pixel that makes edges smooth."""


class Multisampled:
    """A framebuffer of 8-bit RGBA colour and depth with `FINE` samples a pixel; `size` is (width, height) [pixels]."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]) -> None:
        self._ctx = ctx
        self._color = ctx.renderbuffer(size, 4, samples=min(FINE, ctx.max_samples))
        self._depth = ctx.depth_renderbuffer(size, samples=self._color.samples)
        self._fine = ctx.framebuffer([self._color], self._depth)

    @property
    def smooth(self) -> bool:
        """Whether the driver has that many samples."""
        return self._color.samples == FINE

    def begin(self) -> None:
        """Bind the framebuffer and clear it: what is drawn next goes into it."""
        self._fine.use()
        self._fine.clear(0.0, 0.0, 0.0, 1.0, depth=1.0)

    def resolve(self, target: moderngl.Framebuffer) -> None:
        """Put the mean of each pixel's samples into a framebuffer of the same size, and bind that."""
        self._ctx.copy_framebuffer(target, self._fine)
        target.use()

    def release(self) -> None:
        """Give everything back."""
        release_all(self._fine, self._color, self._depth)
