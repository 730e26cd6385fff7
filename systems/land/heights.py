"""The terrain's heights as a texture; heights of a new window of streamed ground are uploaded a piece a frame."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.stream import release_all
from ...engine.terrain.record import Terrain
from ...engine.terrain.rectangle import Rectangle

HOLE = 1
"""Lowest bit of a float32 height: set where there is a hole. It changes a height by about a ten-millionth of it."""

GLSL = {"HOLE": HOLE}

UPLOAD_BYTES = 1 << 20
"""Upload budget per frame for the next window [bytes]."""


class Heights:
    """A texture of one terrain's heights, with linear filtering; most shaders fetch its texels."""

    def __init__(self, ctx: moderngl.Context, terrain: Terrain) -> None:
        self.ctx, self.terrain = ctx, terrain
        self._seen_changes, self._leaps, self._first = terrain.changes.count, terrain.changes.leaps, terrain.first
        self.texture = self._new_texture(_heights_of(terrain, self._whole))
        self._next_texture: moderngl.Texture | None = None
        self._next_first = terrain.first
        self._rows_sent = 0
        """Number of uploaded rows of the next window."""

    def _new_texture(self, heights: NDArray[np.uint32] | None) -> moderngl.Texture:
        """Return a texture of the terrain's size with these bits of heights, or empty."""
        rows, columns = self.terrain.heights.shape
        texture = self.ctx.texture((columns, rows), 1, heights, dtype="f4")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        return texture

    @property
    def _whole(self) -> Rectangle:
        return Rectangle(0, 0, *self.terrain.heights.shape)

    @property
    def origin(self) -> tuple[float, float]:
        """Position (x, z) of the texture's first sample [m]; it may still be that of the terrain's previous window."""
        first, cell = self._first, self.terrain.cell
        return self.terrain.origin if first is None else (first[1] * cell, first[0] * cell)

    def follow(self) -> bool:
        """Upload changed heights and a piece of the next window; return whether the origin has changed."""
        terrain, before = self.terrain, self._first
        if self._seen_changes != terrain.changes.count:
            self._upload_changes()
        if self._first != terrain.first:
            self._upload_rows(whole=self._leaps != terrain.changes.leaps)
        self._leaps = terrain.changes.leaps
        return self._first != before

    def _upload_changes(self) -> None:
        """Upload changed heights to the texture, and to the part of the next window that is already uploaded."""
        terrain, shape = self.terrain, self.terrain.heights.shape
        parts = terrain.changes.since(self._seen_changes)
        self._seen_changes = terrain.changes.count
        after, before = terrain.first or (0, 0), self._first or (0, 0)
        down, right = after[0] - before[0], after[1] - before[1]
        for part in [self._whole] if parts is None else parts:
            changed = part.within(*shape)
            in_texture = changed and changed.moved(down, right).within(*shape)
            if in_texture:
                self.texture.write(_heights_of(terrain, in_texture.moved(-down, -right)), viewport=_box(in_texture))
            if changed and self._rows_sent and self._next_texture is not None and self._next_first == terrain.first:
                self._next_texture.write(_heights_of(terrain, changed), viewport=_box(changed))

    def _upload_rows(self, *, whole: bool) -> None:
        """Upload some rows of the terrain's window, or all of it; swap textures after the last."""
        terrain = self.terrain
        if self._next_first != terrain.first:
            self._next_first, self._rows_sent = terrain.first, 0
        if self._next_texture is None:
            self._next_texture = self._new_texture(None)
        rows, columns = terrain.heights.shape
        count = rows if whole else max(UPLOAD_BYTES // (4 * columns), 1)
        part = Rectangle(self._rows_sent, 0, min(count, rows - self._rows_sent), columns)
        self._next_texture.write(_heights_of(terrain, part), viewport=_box(part))
        self._rows_sent += part.rows
        if self._rows_sent == rows:
            self.texture, self._next_texture = self._next_texture, self.texture
            self._first, self._rows_sent = terrain.first, 0

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self.texture, self._next_texture)


def _box(part: Rectangle) -> tuple[int, int, int, int]:
    return part.column, part.row, part.columns, part.rows


def _heights_of(terrain: Terrain, part: Rectangle) -> NDArray[np.uint32]:
    """Return the bits of a part's heights, shape (rows, columns), with `HOLE` set where there are holes."""
    bits = np.ascontiguousarray(terrain.heights[part.slices]).view(np.uint32) & ~np.uint32(HOLE)
    if terrain.holes is not None:
        bits |= terrain.holes[part.slices]
    return bits
