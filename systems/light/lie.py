"""How the terrain lies to the sun: a map of its slopes, and one of what stands before the sun, drawn bit by bit."""

from collections.abc import Mapping

import moderngl
import numpy as np

from ...components.arrays import Doubles
from ...engine.gl.stream import release_all
from ...engine.terrain.part import Part
from ...engine.terrain.record import Terrain
from ..frame.block import FrameBlock, joined
from .slow import laid_over, map_shape, slow_map

AT_ONCE = 1 << 15
"""Samples drawn in a frame while the sun moves: a graphics card hardly feels them."""

GLSL = {"STEPS": 40, "FIRST": 1.2, "LONGER": 1.15}
"""How often what stands before the sun is looked for on the way there; how far the first step goes [cells of the
terrain], and how many times farther each comes than the last."""

_FARTHEST = GLSL["FIRST"] * GLSL["LONGER"] ** (GLSL["STEPS"] - 1)
"""How far off that is looked for [cells of the terrain]."""

Box = tuple[int, int, int, int]
"""Of the map: the first column and row, and how many there are."""

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
        self._rows, self._columns, self._terrain, self._seen = rows, columns, terrain, -1
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
        changed = self._seen != self._terrain.changes.count
        if not (self._left or changed):
            return 0
        self._target.use()
        calls = self._follow(toward) if changed else 0
        self.use()
        return calls + self._draw_rows(min(rows, self._left))

    def _follow(self, toward: tuple[float, float]) -> int:
        """Draw what is other since heights have changed; return the number of draw calls.

        What they stand before is drawn at once where it is little, and else all of that map in its turn.
        """
        terrain, whole = self._terrain, (0, 0, self._columns, self._rows)
        changed = None if self._seen < 0 else terrain.changes.since(self._seen)
        self._seen = terrain.changes.count
        self._before["highest"] = terrain.span[1]
        self._textures[1].use(self._unit)
        still = [whole] if changed is None else [self._box(part, 2.0) for part in changed]
        calls = sum(self._draw(0, box) for box in still)
        if changed is None or self._left == self._rows:
            self._left = self._rows
            return calls
        before = [self._box(part, 1.0, np.multiply(toward, _FARTHEST)) for part in changed]
        if sum(width * height for _, _, width, height in before) > AT_ONCE:
            self._left = self._rows
            return calls
        self.use()
        return calls + sum(self._draw(1, box) for box in before)

    def _box(self, part: Part, around: float, away: Doubles | None = None) -> Box:
        """Return what of the map lies within some cells of a part of the terrain, or looks that way from `away`."""
        first, last = (part.column, part.row), (part.column + part.columns - 1, part.row + part.rows - 1)
        ends = np.array([np.subtract(first, around), np.add(last, around)])
        far = ends if away is None else ends - away
        count = np.array([self._columns, self._rows])
        scale = count * self._terrain.cell / self._terrain.size
        low = np.clip(np.floor(np.minimum(ends[0], far[0]) * scale - 0.5), 0, count - 1).astype(int)
        high = np.clip(np.ceil(np.maximum(ends[1], far[1]) * scale - 0.5) + 1, low + 1, count).astype(int)
        return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])

    def _draw_rows(self, rows: int) -> int:
        """Draw the rows that have waited longest; return the number of draw calls."""
        calls = 0
        self._left -= rows
        while rows:
            some = min(rows, self._rows - self._row)
            calls += self._draw(1, (0, self._row, self._columns, some))
            self._row, rows = (self._row + some) % self._rows, rows - some
        return calls

    def _draw(self, half: int, box: Box) -> int:
        """Draw a box of the first half of the map, or of the second; return the number of draw calls."""
        column, row, width, height = box
        left = half * self._columns
        self._target.viewport = left, 0, self._columns, self._rows
        self._target.scissor = left + column, row, width, height
        self._arrays[half].render(moderngl.TRIANGLES, vertices=3)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._arrays, self._still, self._before)
        if self._textures:
            release_all(self._target, *self._textures)
