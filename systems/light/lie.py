"""How the terrain lies to the sun: a map of its slopes, and one of what stands before the sun, drawn bit by bit."""

from collections.abc import Mapping

import moderngl

from ...engine.gl.stream import release_all
from ...engine.terrain.record import Terrain
from ..frame.block import FrameBlock, joined
from .slow import laid_over, map_shape, slow_map

AT_ONCE = 1 << 15
"""Samples drawn in a frame while the sun moves: a graphics card hardly feels them."""

FILLED, SHADER = "engine/gl/fill.vert", "systems/light/lie.frag"


class LieMap:
    """A texture of two maps over the terrain, side by side: what never changes, and what the sun's azimuth changes.

    Whatever the sun's elevation, the second says where it is seen. As its azimuth goes on, rows are drawn again, some
    in each frame.
    """

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx = ctx
        self._unit = units["lie"]
        self._still = joined(ctx, block, {**units, "slow": self._unit}, FILLED, SHADER, {"STILL": 1})
        self._before = joined(ctx, block, units, FILLED, SHADER, {})
        self._arrays = [ctx.vertex_array(each, []) for each in (self._still, self._before)]
        self._textures: list[moderngl.Texture] = []
        self._target: moderngl.Framebuffer
        self._toward: tuple[float, float] | None = None
        self._row = self._left = 0

    def lay(self, terrain: Terrain, /, *, seed: int) -> None:
        """Take over another terrain, or another seed."""
        if self._textures:
            release_all(self._target, *self._textures)
        rows, columns = map_shape(terrain.size)
        lie = self.ctx.texture((2 * columns, rows), 4, dtype="f2")
        lie.filter = (moderngl.LINEAR, moderngl.LINEAR)
        lie.repeat_x = lie.repeat_y = False
        self._textures = [lie, laid_over(self.ctx, slow_map(terrain, seed=seed))]
        self._target = self.ctx.framebuffer([lie])
        self._before["highest"] = terrain.span[1]
        self._rows, self._columns, self._is_new = rows, columns, True
        self.leap()

    def leap(self) -> None:
        """Draw all of it with the next frame, however long that takes."""
        self._toward = None

    def use(self) -> None:
        """Bind it."""
        self._textures[0].use(self._unit)

    def prepare(self, toward: tuple[float, float], /) -> int:
        """Draw what is due for a sun in this direction over the ground (x, z); return the number of draw calls."""
        rows = max(AT_ONCE // self._columns, 1)
        if toward != self._toward:
            rows = self._rows if self._toward is None else rows
            self._toward, self._left = toward, self._rows
        if not self._left:
            return 0
        calls = 0
        self._target.use()
        if self._is_new:
            self._textures[1].use(self._unit)
            self._target.viewport = 0, 0, self._columns, self._rows
            self._arrays[0].render(moderngl.TRIANGLES, vertices=3)
            self._is_new, calls = False, 1
        self.use()
        return calls + self._draw(min(rows, self._left))

    def _draw(self, rows: int) -> int:
        """Draw the rows that have waited longest; return the number of draw calls."""
        calls = 0
        self._left -= rows
        while rows:
            some = min(rows, self._rows - self._row)
            self._before["rows"] = self._row / self._rows, some / self._rows
            self._target.viewport = self._columns, self._row, self._columns, some
            self._arrays[1].render(moderngl.TRIANGLES, vertices=3)
            self._row, rows, calls = (self._row + some) % self._rows, rows - some, calls + 1
        return calls

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._arrays, self._still, self._before)
        if self._textures:
            release_all(self._target, *self._textures)
