"""How high grass is left to stand, as a texture over the terrain."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ..frame.feature import Part
from ..space.grown import Grown
from .mown import Mown


class MownPart(Part):
    """The map as one GL context holds it: a texel for a cell, and mip-maps for what lies far off."""

    def __init__(self, ctx: moderngl.Context, unit: int, mown: Mown) -> None:
        self.ctx, self._unit, self._mown = ctx, unit, mown
        self.texture = self._room(1, 1)
        """A single texel for as long as nothing has been cut."""
        self._strokes, self._tallest = 0, 0.0

    def make_ready(self, grown: Grown, /) -> None:
        """Have the whole map, with nothing cut, before anything is."""
        rows, columns = self._mown.shape
        is_there = self.texture.size == (columns, rows) and grown.tallest == self._tallest
        if is_there or self._mown.heights is not None:
            return
        self.release()
        self.texture, self._strokes, self._tallest = self._room(columns, rows), 0, grown.tallest
        self.texture.write(np.full((rows, columns), grown.tallest, np.float16), alignment=2)
        self.texture.build_mipmaps()

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that something is cut."""
        record["anything_cut"] = 1.0

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Send the rows that have changed.

        What is not cut stands above all tips: a mean of that and what is cut means something.
        """
        mown, tallest = self._mown, grown.tallest
        if mown.heights is None and self.texture.size != (1, 1):
            self.make_ready(grown)
        if mown.heights is None or (mown.strokes, tallest) == (self._strokes, self._tallest):
            return
        rows, columns = mown.shape
        if self.texture.size != (columns, rows) or tallest != self._tallest:
            self.release()
            self.texture, self._strokes = self._room(columns, rows), -1
        stale = np.flatnonzero(mown.changed > self._strokes)
        low, high = int(stale[0]), int(stale[-1]) + 1
        self.texture.write(
            _texels(mown.heights[low:high], tallest), viewport=(0, low, columns, high - low), alignment=2
        )
        self.texture.build_mipmaps()
        self._strokes, self._tallest = mown.strokes, tallest
        record["anything_cut"] = 1.0

    def _room(self, columns: int, rows: int) -> moderngl.Texture:
        texture = self.ctx.texture((columns, rows), 1, dtype="f2", alignment=2)
        texture.repeat_x = texture.repeat_y = False
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        return texture

    def use(self) -> None:
        """Bind it."""
        self.texture.use(self._unit)

    def release(self) -> None:
        """Give the texture back."""
        self.texture.release()


def _texels(heights: NDArray[np.float32], tallest: float) -> NDArray[np.float16]:
    return np.minimum(heights, np.float32(tallest)).astype(np.float16)
