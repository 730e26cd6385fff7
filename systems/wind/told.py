"""What winds without a twin tell receivers, by their numbers, for shaders to look up."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats

Rows = NDArray[np.intp]

WIDE = 1024
"""Receivers in a row of the texture."""


class Told:
    """A texture of messages and weights, a block of rows for each wind; only rows that differ are sent."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self._texels = np.zeros((1, WIDE, 4), np.float32)
        self.texture = self._room()
        self.block = 1
        """Rows of one wind."""

    def reserve(self, winds: int, receivers: int) -> None:
        """Make room for so many winds to tell so many receivers something."""
        block = max(self.block, -(-receivers // WIDE))
        if block > self.block or winds * block > len(self._texels):
            self.block = block
            self._texels = np.zeros((max(1, winds) * block * 3 // 2 + 1, WIDE, 4), np.float32)
            self.texture.release()
            self.texture = self._room()

    def write(self, wind: int, number: Rows, message: Floats, weight: Floats) -> int:
        """Tell receivers of these numbers (n,) messages (n, 2) with weights (n,), and all others nothing.

        `wind` counts the winds without a twin. Returns how many rows were sent.
        """
        first = wind * self.block
        told = np.zeros((self.block, WIDE, 4), np.float32)
        flat = told.reshape(-1, 4)
        flat[number, :2], flat[number, 2] = message, weight
        held = self._texels[first : first + self.block]
        rows = np.flatnonzero((told != held).any(axis=(1, 2)))
        if not len(rows):
            return 0
        low, high = int(rows[0]), int(rows[-1]) + 1
        held[low:high] = told[low:high]
        self.texture.write(held[low:high], viewport=(0, first + low, WIDE, high - low))
        return high - low

    def _room(self) -> moderngl.Texture:
        rows = len(self._texels)
        texture = self.ctx.texture((WIDE, rows), 4, np.zeros_like(self._texels), dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def release(self) -> None:
        """Give the texture back."""
        self.texture.release()
