"""Slope map and horizon map of the terrain, drawn a few rows a frame."""

from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles, Floats, Place
from ...engine.executor import DaemonExecutor
from ...engine.gl.shaders import program, set_uniform
from ...engine.gl.stream import release_all
from ...engine.gl.texture import interpolated
from ...engine.gl.viewports import Box
from ...engine.noise import noise_grid, noise_table
from ...engine.terrain.record import Terrain
from ...engine.terrain.rectangle import Rectangle
from ..frame.block import FrameBlock, wired

SAMPLES_A_FRAME = 1 << 15
"""Samples drawn in a frame while the sun moves: a negligible load for a graphics card."""

GLSL = {"STEPS": 40, "FIRST": 1.2, "LONGER": 1.15}
"""Horizon search towards the sun: number of steps, length of the first [cells of the terrain], and the ratio of
successive distances."""

_FARTHEST = GLSL["FIRST"] * GLSL["LONGER"] ** (GLSL["STEPS"] - 1)
"""Distance of the last step [cells of the terrain]."""

IMAGES = 4
"""Mirror images of a terrain at its edges, itself included: the sun has another azimuth in each."""

FILLED, SHADER = "engine/gl/fill.vert", "systems/light/lie.frag"

FINEST_MAP = 1024
"""Largest number of samples along a side of the maps."""

_ROWS = 32
"""Rows of noise computed at a time: few enough for the processor's cache."""


@dataclass(eq=False)
class _Map:
    """Slope and horizon map over one window of the terrain."""

    lie: moderngl.Texture
    slow: moderngl.Texture
    target: moderngl.Framebuffer
    origin: Place
    """Corner (x, z) of the window [m]."""

    next_row: int = 0
    """Row of the horizon map that is drawn next."""

    rows_due: int = 0
    """Number of rows of the horizon map that are out of date."""

    def release(self) -> None:
        release_all(self.target, self.lie, self.slow)


@dataclass(eq=False)
class _NextMap:
    """Map of another window of the terrain, drawn while the present one is still in use."""

    origin: Place
    slow: "Future[Bytes]"
    map_: _Map | None = None
    slope_rows: int = 0
    """Number of rows of the slope map that are drawn."""

    changes: int = 0
    """The terrain's count of changes when the slope map was begun."""

    def release(self) -> None:
        release_all(self.map_)


class LieMap:
    """A texture of two maps of the terrain, side by side: the slope map, with slow noises, and the horizon map.

    The horizon map holds for one azimuth of the sun and all its elevations; on a mirrored terrain it has a channel for
    each mirror image. When the azimuth changes, its rows are drawn again, some in each frame. When the terrain moves to
    another window of its ground, a map of that window is drawn row by row, and then replaces the present one.
    """

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx, self._block, self._units = ctx, block, units
        self._unit = units["lie"]
        self._make_programs(mirrored=False)
        self._map: _Map | None = None
        self._next: _NextMap | None = None
        self._toward_sun: tuple[float, float] | None = None
        self._executor = DaemonExecutor()

    def _make_programs(self, *, mirrored: bool) -> None:
        """Make the programs that draw both maps."""
        self._is_mirrored, self._samples_a_frame = mirrored, SAMPLES_A_FRAME // (IMAGES if mirrored else 1)
        self._slope_program, self._horizon_program = self._program("SLOPES"), self._program()
        self._vertex_arrays = [self.ctx.vertex_array(each, []) for each in (self._slope_program, self._horizon_program)]

    def _program(self, *switches: str) -> moderngl.Program:
        """Return a program with these defines and MIRRORED, if it is: the frame block's defines may be outdated."""
        switches = (*switches, "MIRRORED") if self._is_mirrored else switches
        compiled = program(self.ctx, FILLED, SHADER, defines=dict.fromkeys(switches, 1))
        return wired(compiled, self._block, {**self._units, "slow": self._unit})

    def lay(self, terrain: Terrain, /, *, seed: int) -> None:
        """Begin a map of a terrain and a seed; it is drawn with the next frame."""
        self._rows, self._columns = map_shape(terrain.size)
        self._terrain, self._seed, self._seen_changes, self._leaps = terrain, seed, -1, terrain.changes.leaps
        if terrain.mirrored != self._is_mirrored:
            release_all(*self._vertex_arrays, self._slope_program, self._horizon_program)
            self._make_programs(mirrored=terrain.mirrored)
        self._release_maps()
        self._map = self._new_map(terrain.origin, slow_map(terrain.size, terrain.origin, seed=seed))
        self.leap()

    def _new_map(self, origin: Place, slow: Bytes) -> _Map:
        """Return a map that is still to be drawn, over the window with this corner [m], with its noises."""
        lie = interpolated(self.ctx.texture((2 * self._columns, self._rows), 4, dtype="f2"))
        return _Map(lie, map_texture(self.ctx, slow), self.ctx.framebuffer([lie]), origin)

    def follow(self, origin: Place, /) -> Place:
        """Follow the terrain's window to a corner [m]; return the corner of the map in use [m]."""
        assert self._map is not None
        if self._terrain.first is None:
            return self._map.origin
        leaps, self._leaps = self._leaps != self._terrain.changes.leaps, self._terrain.changes.leaps
        next_ = self._next
        if next_ is not None and next_.map_ is not None and next_.slope_rows == self._rows and not next_.map_.rows_due:
            self._map.release()
            self._map, self._seen_changes, self._next = next_.map_, next_.changes, None
        newest_origin = self._map.origin if self._next is None else self._next.origin
        if not self._is_same_corner(origin, newest_origin):
            self._begin_next(origin, leaps=leaps)
        return self._map.origin

    def _is_same_corner(self, origin: Place, other: Place) -> bool:
        """Return whether two corners are the same, within half a cell."""
        return max(abs(one - two) for one, two in zip(origin, other, strict=True)) < 0.5 * self._terrain.cell

    def _begin_next(self, origin: Place, *, leaps: bool) -> None:
        """Begin a map of another window; with `leaps` it is complete in the next frame."""
        release_all(self._next)
        self._next = None
        assert self._map is not None
        if leaps:
            new = self._new_map(origin, slow_map(self._terrain.size, origin, seed=self._seed))
            self._map.release()
            self._map, self._seen_changes = new, -1
            self.leap()
        elif not self._is_same_corner(origin, self._map.origin):
            slow = self._executor.submit(slow_map, self._terrain.size, origin, seed=self._seed)
            self._next = _NextMap(origin, slow)

    def leap(self) -> None:
        """Draw the whole horizon map in the next frame, whatever it takes."""
        self._toward_sun = None

    def use(self) -> None:
        """Bind the texture."""
        assert self._map is not None
        self._map.lie.use(self._unit)

    def prepare(self, toward_sun: tuple[float, float], /) -> int:
        """Draw this frame's rows, for the horizontal direction (x, z) to the sun; return the number of draw calls."""
        map_, rows = self._map, max(self._samples_a_frame // self._columns, 1)
        assert map_ is not None
        horizon_rows = rows
        if toward_sun != self._toward_sun:
            horizon_rows = self._rows if self._toward_sun is None else rows
            self._toward_sun, map_.rows_due = toward_sun, self._rows
            if self._next is not None and self._next.map_ is not None:
                self._next.map_.rows_due = self._rows
        calls = self._draw_next(rows)
        changed = self._seen_changes != self._terrain.changes.count
        if not (map_.rows_due or changed):
            return calls
        map_.target.use()
        calls += self._draw_changed(map_, toward_sun) if changed else 0
        self.use()
        return calls + self._draw_horizon_rows(map_, min(horizon_rows, map_.rows_due))

    def _draw_next(self, rows: int) -> int:
        """Draw some rows of the next window's map; return the number of draw calls."""
        next_ = self._next
        if next_ is None or not next_.slow.done():
            return 0
        if next_.map_ is None:
            next_.map_ = self._new_map(next_.origin, next_.slow.result())
            next_.map_.rows_due, next_.changes = self._rows, self._terrain.changes.count
        map_ = next_.map_
        if next_.changes != self._terrain.changes.count:
            next_.changes, next_.slope_rows, map_.rows_due = self._terrain.changes.count, 0, self._rows
        self._horizon_program["highest"] = self._terrain.span[1]
        map_.target.use()
        if next_.slope_rows < self._rows:
            map_.slow.use(self._unit)
            count = min(rows, self._rows - next_.slope_rows)
            calls = self._draw(map_, 0, (0, next_.slope_rows, self._columns, count))
            next_.slope_rows += count
        else:
            calls = self._draw_horizon_rows(map_, min(rows, map_.rows_due))
        self.use()
        return calls

    def _draw_changed(self, map_: _Map, toward_sun: tuple[float, float]) -> int:
        """Draw what changed heights affect; return the number of draw calls.

        The slope map is drawn at once. So is the part of the horizon map that the changed heights may shadow, if it is
        small. Otherwise, and on mirrored terrain, all rows of the horizon map become due.
        """
        terrain, whole = self._terrain, (0, 0, self._columns, self._rows)
        changed = None if self._seen_changes < 0 else terrain.changes.since(self._seen_changes)
        self._seen_changes = terrain.changes.count
        self._horizon_program["highest"] = terrain.span[1]
        map_.slow.use(self._unit)
        slopes = [whole] if changed is None else [self._box(map_, part, 2.0) for part in changed]
        calls = sum(self._draw(map_, 0, box) for box in slopes)
        if changed is None or map_.rows_due == self._rows or self._is_mirrored:
            map_.rows_due = self._rows
            return calls
        horizons = [self._box(map_, part, 1.0, np.multiply(toward_sun, _FARTHEST)) for part in changed]
        if sum(width * height for _, _, width, height in horizons) > SAMPLES_A_FRAME:
            map_.rows_due = self._rows
            return calls
        self.use()
        return calls + sum(self._draw(map_, 1, box) for box in horizons)

    def _box(self, map_: _Map, part: Rectangle, around: float, away: Doubles | None = None) -> Box:
        """Return the box of the map within `around` cells of a part of the terrain.

        With `away`, a vector in cells, the box extends to the part moved by minus `away`.
        """
        terrain = self._terrain
        if terrain.first is not None:
            right, down = np.rint(np.subtract(terrain.origin, map_.origin) / terrain.cell).astype(int).tolist()
            part = part.moved(down, right)
        first, last = (part.column, part.row), (part.column + part.columns - 1, part.row + part.rows - 1)
        ends = np.array([np.subtract(first, around), np.add(last, around)])
        far = ends if away is None else ends - away
        count = np.array([self._columns, self._rows])
        scale = count * terrain.cell / terrain.size
        low = np.clip(np.floor(np.minimum(ends[0], far[0]) * scale - 0.5), 0, count - 1).astype(int)
        high = np.clip(np.ceil(np.maximum(ends[1], far[1]) * scale - 0.5) + 1, low + 1, count).astype(int)
        return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])

    def _draw_horizon_rows(self, map_: _Map, rows: int) -> int:
        """Draw the rows of the horizon map that have waited longest; return the number of draw calls."""
        calls = 0
        map_.rows_due -= rows
        while rows:
            count = min(rows, self._rows - map_.next_row)
            calls += self._draw(map_, 1, (0, map_.next_row, self._columns, count))
            map_.next_row, rows = (map_.next_row + count) % self._rows, rows - count
        return calls

    def _draw(self, map_: _Map, half: int, box: Box) -> int:
        """Draw a box of the slope map (half 0) or the horizon map (half 1); return the number of draw calls."""
        column, row, width, height = box
        left = half * self._columns
        map_.target.viewport = left, 0, self._columns, self._rows
        map_.target.scissor = left + column, row, width, height
        set_uniform(self._vertex_arrays[half].program, "corner", *map_.origin)
        self._vertex_arrays[half].render(moderngl.TRIANGLES, vertices=3)
        return 1

    def _release_maps(self) -> None:
        release_all(self._map, self._next)
        self._map = self._next = None

    def release(self) -> None:
        """Release all GL objects, and the thread."""
        release_all(*self._vertex_arrays, self._slope_program, self._horizon_program)
        self._release_maps()
        self._executor.release()


def map_shape(size: tuple[float, float], /) -> tuple[int, int]:
    """Return rows and columns of the maps of a terrain of `size` (x, z) [m]: about one sample per metre."""
    columns, rows = (int(np.clip(np.ceil(side), 16, FINEST_MAP)) for side in size)
    return rows, columns


def slow_map(size: tuple[float, float], origin: tuple[float, float], /, *, seed: int) -> NDArray[np.uint8]:
    """Return two low-frequency noises n, encoded as 0.5 + 0.5 n, shape (rows, columns, 2).

    They cover the rectangle with corner `origin` and `size` (x, z) [m]. Any thread may call this.
    """
    rows, columns = map_shape(size)
    (width, depth), (left, far) = size, origin
    x = (left + (np.arange(columns) + 0.5) / columns * width).astype(np.float32)
    z = (far + (np.arange(rows) + 0.5) / rows * depth).astype(np.float32)
    packed = np.empty((rows, columns, 2), np.uint8)
    for start in range(0, rows, _ROWS):
        block = slice(start, start + _ROWS)
        packed[block] = np.clip(np.round((0.5 + 0.5 * _slow_noise(x, z[block], seed)) * 255.0), 0, 255)
    return packed


def _slow_noise(x: Floats, z: Floats, seed: int) -> Floats:
    """Return two noises of wavelengths 23 m and 6 m on the grid of `x` and `z` [m], shape (z, x, 2)."""
    wide, close = (
        noise_grid(noise_table(seed, stream)[..., :2], x / np.float32(wave), z / np.float32(wave))
        for stream, wave in ((16, 23.0), (17, 6.0))
    )
    return 0.6 * wide + 0.4 * close


def map_texture(ctx: moderngl.Context, texels: NDArray[np.uint8]) -> moderngl.Texture:
    """Return an image (rows, columns, channels) as a texture that is interpolated and clamped."""
    rows, columns, channels = texels.shape
    return interpolated(ctx.texture((columns, rows), channels, np.ascontiguousarray(texels).tobytes(), alignment=1))
