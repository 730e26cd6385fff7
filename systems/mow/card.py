"""How high grass is left to stand, as a texture over the terrain."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from .mown import Mown

SAMPLERS = ("mown",)
"""What `lib/mown.glsl` reads where anything is mown."""


class CardMown:
    """The map as one GL context holds it: a texel for a cell, and mip-maps for what lies far off."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.texture: moderngl.Texture | None = None
        self._strokes, self._tallest = 0, 0.0

    def write(self, mown: Mown, *, tallest: float) -> bool:
        """Send the rows that have changed; return whether there is a texture now that was not there before.

        What is not cut stands at `tallest` [m], above all tips: a mean of that and what is cut means something.
        """
        if mown.heights is None or (mown.strokes, tallest) == (self._strokes, self._tallest):
            return False
        rows, columns = mown.shape
        begun = self.texture is None
        if self.texture is None or self.texture.size != (columns, rows) or tallest != self._tallest:
            self.release()
            self.texture, self._strokes = self._room(columns, rows), -1
        stale = np.flatnonzero(mown.changed > self._strokes)
        low, high = int(stale[0]), int(stale[-1]) + 1
        self.texture.write(
            _texels(mown.heights[low:high], tallest), viewport=(0, low, columns, high - low), alignment=2
        )
        self.texture.build_mipmaps()
        self._strokes, self._tallest = mown.strokes, tallest
        return begun

    def _room(self, columns: int, rows: int) -> moderngl.Texture:
        texture = self.ctx.texture((columns, rows), 1, dtype="f2", alignment=2)
        texture.repeat_x = texture.repeat_y = False
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        return texture

    def use(self, unit: int) -> None:
        """Bind it, where there is one."""
        if self.texture is not None:
            self.texture.use(unit)

    def release(self) -> None:
        """Give the texture back."""
        if self.texture is not None:
            self.texture.release()
            self.texture = None


def _texels(heights: NDArray[np.float32], tallest: float) -> NDArray[np.float16]:
    return np.minimum(heights, np.float32(tallest)).astype(np.float16)
