"""Textures of the winds: tables that twins read, and the messages of winds without a twin."""

from collections.abc import Sequence

import moderngl
import numpy as np

from ...components.arrays import Floats, Indices
from ...engine.gl.texture import by_texel

WIDE = 1024
"""Number of receivers in a row of a `MessageTexture`."""


class Sheets:
    """A texture array with a layer for each table; a table is uploaded again only if it is another array."""

    def __init__(self, ctx: moderngl.Context, *, side: int = 128, layers: int = 4) -> None:
        self.ctx = ctx
        self._held: list[Floats | None] = [None] * layers
        """Table in each layer."""
        self._layer: dict[int, int] = {}
        """Layer of each table, by the array's `id`."""
        self._used: set[int] = set()
        """Layers that this frame reads."""
        self.texture = self._allocated(side, side)
        self.sent = 0
        """Number of tables uploaded so far."""

    def reserve(self, rows: int, columns: int, layers: int) -> None:
        """Make room for this number of tables, with this number of rows and columns."""
        rows, columns = max(rows, self.texture.height), max(columns, self.texture.width)
        self._held += [None] * (layers - len(self._held))
        if self.texture.size != (columns, rows, len(self._held)):
            self._grow(rows, columns)

    def begin(self) -> None:
        """Begin a frame: layers that it does not read may be overwritten."""
        self._used.clear()

    def layers(self, tables: Sequence[Floats], /) -> list[int]:
        """Return the layers of tables of shape (rows, columns, 1 to 4), and upload those that are new."""
        return [self._layer_of(table) for table in tables]

    def _layer_of(self, table: Floats) -> int:
        layer = self._layer.get(id(table))  # the table is held, so no other array can have its id
        if layer is None:
            layer = self._place(table)
        self._used.add(layer)
        return layer

    def _place(self, table: Floats) -> int:
        """Upload a new table to a free layer, preferably an empty one; return the layer."""
        rows, columns = table.shape[:2]
        free = [layer for layer in range(len(self._held)) if layer not in self._used]
        if not free or rows > self.texture.height or columns > self.texture.width:
            self._held += [None] * (0 if free else len(self._held))
            self._grow(max(rows, self.texture.height), max(columns, self.texture.width))
            return self._place(table)
        layer = min(free, key=lambda layer: self._held[layer] is not None)
        if (before := self._held[layer]) is not None:
            del self._layer[id(before)]
        self._held[layer], self._layer[id(table)] = table, layer
        self._send(layer, table)
        return layer

    def _grow(self, rows: int, columns: int) -> None:
        self.texture.release()
        self.texture = self._allocated(rows, columns)
        for layer, table in enumerate(self._held):
            if table is not None:
                self._send(layer, table)

    def _send(self, layer: int, table: Floats) -> None:
        rows, columns, channels = table.shape
        texels = np.zeros((rows, columns, 4), np.float32)
        texels[..., :channels] = table
        self.texture.write(texels, viewport=(0, 0, layer, columns, rows, 1))
        self.sent += 1

    def _allocated(self, rows: int, columns: int) -> moderngl.TextureArray:
        return by_texel(self.ctx.texture_array((columns, rows, len(self._held)), 4, dtype="f4"))

    def release(self) -> None:
        """Release the texture."""
        self.texture.release()


class MessageTexture:
    """A texture of messages and weights, a block of rows for each wind; only rows that differ are uploaded."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self._texels = np.zeros((1, WIDE, 4), np.float32)
        self.texture = self._allocated()
        self.block = 1
        """Number of rows for one wind."""

    def reserve(self, winds: int, receivers: int) -> None:
        """Make room for messages of this number of winds to this number of receivers."""
        block = max(self.block, -(-receivers // WIDE))
        if block > self.block or winds * block > len(self._texels):
            self.block = block
            self._texels = np.zeros((max(1, winds) * block * 3 // 2 + 1, WIDE, 4), np.float32)
            self.texture.release()
            self.texture = self._allocated()

    def write(self, wind: int, number: Indices, message: Floats, weight: Floats) -> int:
        """Write a wind's messages (n, 2) and weights (n,) to receivers of these numbers (n,), and 0 to all others.

        `wind` counts the winds without a twin. Returns the number of rows uploaded.
        """
        first = wind * self.block
        texels = np.zeros((self.block, WIDE, 4), np.float32)
        flat = texels.reshape(-1, 4)
        flat[number, :2], flat[number, 2] = message, weight
        held = self._texels[first : first + self.block]
        rows = np.flatnonzero((texels != held).any(axis=(1, 2)))
        if not len(rows):
            return 0
        low, high = int(rows[0]), int(rows[-1]) + 1
        held[low:high] = texels[low:high]
        self.texture.write(held[low:high], viewport=(0, first + low, WIDE, high - low))
        return high - low

    def _allocated(self) -> moderngl.Texture:
        rows = len(self._texels)
        return by_texel(self.ctx.texture((WIDE, rows), 4, np.zeros_like(self._texels), dtype="f4"))

    def release(self) -> None:
        """Release the texture."""
        self.texture.release()
