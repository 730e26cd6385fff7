"""Textures that hold records, for shaders that look them up by their number."""

import moderngl
import numpy as np
from numpy.typing import NDArray


class Records:
    """A texture of records that is filled anew and grows as it must, `per_row` of them in a row.

    `record` is a dtype of float32 fields whose size is that of some RGBA texels, or of one integer.
    """

    def __init__(self, ctx: moderngl.Context, record: np.dtype[np.void], per_row: int, *, rows: int = 64) -> None:
        self.ctx = ctx
        self.record = record
        self.per_row = per_row
        self.texels, self.channels = max(record.itemsize // 16, 1), min(record.itemsize // 4, 4)
        self.kind = "u4" if self.channels == 1 else "f4"
        self.texture = self._room(rows)
        self._padded = np.zeros(0, record)
        """Whole rows of what is written, kept from one time to the next."""

    def write(self, records: NDArray[np.void]) -> None:
        """Replace the contents by `records`, shape (n,)."""
        rows = -(-len(records) // self.per_row)
        if rows > self.texture.height:
            self.reserve(rows * 3 // 2)
        if rows:
            if rows * self.per_row > len(self._padded):
                self._padded = np.zeros(rows * self.per_row, self.record)
            self._padded[: len(records)] = records
            whole = self._padded[: rows * self.per_row]  # what comes after them is read by nobody
            self.texture.write(whole, viewport=(0, 0, self.texels * self.per_row, rows))

    def reserve(self, rows: int) -> None:
        """Make room for so many rows; where there is too little, what was written is lost."""
        if rows > self.texture.height:
            self.texture.release()
            self.texture = self._room(rows)

    def _room(self, rows: int) -> moderngl.Texture:
        texture = self.ctx.texture((self.texels * self.per_row, rows), self.channels, dtype=self.kind)
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def release(self) -> None:
        """Give the texture back."""
        self.texture.release()
