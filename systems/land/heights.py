"""The terrain's heights on the graphics card: of ground that streams, another window's come a piece at a time."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.stream import release_all
from ...engine.terrain.part import Part
from ...engine.terrain.record import Terrain

HOLE = 1
"""The bit of a height's that says whether there is a hole: it is worth a few millionths of the height."""

GLSL = {"HOLE": HOLE}

PIECE = 1 << 20
"""Bytes that are sent in a frame of what comes [bytes]."""


class Heights:
    """A texture of one terrain's heights: most fetch its texels, and it is smooth for who asks about."""

    def __init__(self, ctx: moderngl.Context, terrain: Terrain) -> None:
        self.ctx, self.terrain = ctx, terrain
        self._count, self._leaps, self._first = terrain.changes.count, terrain.changes.leaps, terrain.first
        self.texture = self._made(_heights_of(terrain, self._all))
        self._spare: moderngl.Texture | None = None
        self._coming = terrain.first
        self._sent = 0
        """Rows that have been sent of what comes."""

    def _made(self, heights: NDArray[np.uint32] | None) -> moderngl.Texture:
        rows, columns = self.terrain.heights.shape
        texture = self.ctx.texture((columns, rows), 1, heights, dtype="f4")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        return texture

    @property
    def _all(self) -> Part:
        return Part(0, 0, *self.terrain.heights.shape)

    @property
    def origin(self) -> tuple[float, float]:
        """Where its first sample stands (x, z) [m]: it may be that of a window that the terrain was before."""
        first, cell = self._first, self.terrain.cell
        return self.terrain.origin if first is None else (first[1] * cell, first[0] * cell)

    def follow(self) -> bool:
        """Send what has changed, and a piece of what comes; return whether the origin is another one now."""
        terrain, before = self.terrain, self._first
        if self._count != terrain.changes.count:
            self._send_changes()
        if self._first != terrain.first:
            self._send_on(whole=self._leaps != terrain.changes.leaps)
        self._leaps = terrain.changes.leaps
        return self._first != before

    def _send_changes(self) -> None:
        terrain, shape = self.terrain, self.terrain.heights.shape
        changed = terrain.changes.since(self._count)
        self._count = terrain.changes.count
        down, right = _way(terrain.first, self._first)
        for part in [self._all] if changed is None else changed:
            here = part.within(*shape)
            there = here and here.moved(down, right).within(*shape)
            if there:
                self.texture.write(_heights_of(terrain, there.moved(-down, -right)), viewport=_box(there))
            if here and self._sent and self._spare is not None and self._coming == terrain.first:
                self._spare.write(_heights_of(terrain, here), viewport=_box(here))

    def _send_on(self, *, whole: bool) -> None:
        """Send some rows of the terrain's window, or all; with the last of them the texture is that."""
        terrain = self.terrain
        if self._coming != terrain.first:
            self._coming, self._sent = terrain.first, 0
        if self._spare is None:
            self._spare = self._made(None)
        rows, columns = terrain.heights.shape
        each = rows if whole else max(PIECE // (4 * columns), 1)
        part = Part(self._sent, 0, min(each, rows - self._sent), columns)
        self._spare.write(_heights_of(terrain, part), viewport=_box(part))
        self._sent += part.rows
        if self._sent == rows:
            self.texture, self._spare = self._spare, self.texture
            self._first, self._sent = terrain.first, 0

    def release(self) -> None:
        """Give everything back."""
        release_all(self.texture, self._spare)


def _way(to: tuple[int, int] | None, since: tuple[int, int] | None) -> tuple[int, int]:
    return (0, 0) if to is None or since is None else (to[0] - since[0], to[1] - since[1])


def _box(part: Part) -> tuple[int, int, int, int]:
    return part.column, part.row, part.columns, part.rows


def _heights_of(terrain: Terrain, part: Part) -> NDArray[np.uint32]:
    """Return the bits of a part's heights (rows, columns): the last of each is 1 where there is a hole."""
    bits = np.ascontiguousarray(terrain.heights[part.slices]).view(np.uint32) & ~np.uint32(HOLE)
    if terrain.holes is not None:
        bits |= terrain.holes[part.slices]
    return bits
