"""How the terrain lies to the sun: a map of its slopes, and one of what stands before the sun, drawn bit by bit."""

from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles, Floats
from ...engine.gl.shaders import program, set_uniform
from ...engine.gl.stream import release_all
from ...engine.noise import noise_grid, noise_table
from ...engine.terrain.part import Part
from ...engine.terrain.record import Terrain
from ..frame.block import FrameBlock, wired

AT_ONCE = 1 << 15
"""Samples drawn in a frame while the sun moves: a graphics card hardly feels them."""

GLSL = {"STEPS": 40, "FIRST": 1.2, "LONGER": 1.15}
"""How often what stands before the sun is looked for on the way there; how far the first step goes [cells of the
terrain], and how many times farther each comes than the last."""

_FARTHEST = GLSL["FIRST"] * GLSL["LONGER"] ** (GLSL["STEPS"] - 1)
"""How far off that is looked for [cells of the terrain]."""

IMAGES = 4
"""Images of a terrain in the mirrors of its edges, itself among them, each with the sun on another side."""

Box = tuple[int, int, int, int]
"""Of the map: the first column and row, and how many there are."""

Place = tuple[float, float]

FILLED, SHADER = "engine/gl/fill.vert", "systems/light/lie.frag"

FINEST_MAP = 1024
"""Samples along a side of the maps laid over the terrain."""

_ROWS = 32
"""Rows of a map worked on at a time: few enough to stay in the processor's own memory."""


@dataclass(eq=False)
class _Laid:
    """A map that lies over a terrain from some place on."""

    lie: moderngl.Texture
    slow: moderngl.Texture
    target: moderngl.Framebuffer
    origin: Place
    """[m]."""

    row: int = 0
    """The row that is drawn next."""

    left: int = 0
    """How many rows are to be drawn of what stands before the sun."""

    def release(self) -> None:
        release_all(self.target, self.lie, self.slow)


@dataclass(eq=False)
class _Coming:
    """A map of another window of the terrain, which is drawn beside the one that is read."""

    origin: Place
    slow: "Future[Bytes]"
    laid: _Laid | None = None
    still: int = 0
    """How many rows are drawn of what never changes."""

    changes: int = 0
    """Changes of the terrain that are in it."""

    def release(self) -> None:
        release_all(self.laid)


class LieMap:
    """A texture of two maps over the terrain, side by side: what never changes, and what the sun's azimuth changes.

    Whatever the sun's elevation, the second says where it is seen; on a terrain that is mirrored beyond its edge, from
    each of its mirror images too. As its azimuth goes on, rows are drawn again, some in each frame. Where the terrain
    becomes another window of its ground, the map of that is drawn beside, likewise.
    """

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx, self._block, self._units = ctx, block, units
        self._unit = units["lie"]
        self._make(mirrored=False)
        self._laid: _Laid | None = None
        self._coming: _Coming | None = None
        self._toward: Place | None = None
        self._hands = ThreadPoolExecutor(1, thread_name_prefix="tallgrass")  # without a thread, until it is asked

    def _make(self, *, mirrored: bool) -> None:
        self._is_mirrored, self._at_once = mirrored, AT_ONCE // (IMAGES if mirrored else 1)
        self._still, self._before = self._program("STILL"), self._program()
        self._arrays = [self.ctx.vertex_array(each, []) for each in (self._still, self._before)]

    def _program(self, *switches: str) -> moderngl.Program:
        """Return a program with some switches; the block's may still be those of another terrain."""
        switches = (*switches, "MIRRORED") if self._is_mirrored else switches
        made = program(self.ctx, FILLED, SHADER, defines=dict.fromkeys(switches, 1))
        return wired(made, self._block, {**self._units, "slow": self._unit})

    def lay(self, terrain: Terrain, /, *, seed: int) -> None:
        """Take over another terrain, or another seed."""
        self._rows, self._columns = map_shape(terrain.size)
        self._terrain, self._seed, self._seen, self._leaps = terrain, seed, -1, terrain.changes.leaps
        if terrain.mirrored != self._is_mirrored:
            release_all(*self._arrays, self._still, self._before)
            self._make(mirrored=terrain.mirrored)
        self._let_go()
        self._laid = self._made(terrain.origin, slow_map(terrain.size, terrain.origin, seed=seed))
        self.leap()

    def _made(self, origin: Place, slow: Bytes) -> _Laid:
        lie = self.ctx.texture((2 * self._columns, self._rows), 4, dtype="f2")
        lie.filter = (moderngl.LINEAR, moderngl.LINEAR)
        lie.repeat_x = lie.repeat_y = False
        return _Laid(lie, laid_over(self.ctx, slow), self.ctx.framebuffer([lie]), origin)

    def follow(self, origin: Place, /) -> Place:
        """Come to lie over the window of the terrain that begins there; return where what is read begins [m]."""
        assert self._laid is not None
        if self._terrain.first is None:
            return self._laid.origin
        leaps, self._leaps = self._leaps != self._terrain.changes.leaps, self._terrain.changes.leaps
        coming = self._coming
        if coming is not None and coming.laid is not None and coming.still == self._rows and not coming.laid.left:
            self._laid.release()
            self._laid, self._seen, self._coming = coming.laid, coming.changes, None
        due = self._laid.origin if self._coming is None else self._coming.origin
        if not self._is_at(origin, due):
            self._begin(origin, leaps=leaps)
        return self._laid.origin

    def _is_at(self, origin: Place, other: Place) -> bool:
        return max(abs(one - two) for one, two in zip(origin, other, strict=True)) < 0.5 * self._terrain.cell

    def _begin(self, origin: Place, *, leaps: bool) -> None:
        """Begin a map of another window; where somebody waits for it, it is there with the next frame."""
        release_all(self._coming)
        self._coming = None
        assert self._laid is not None
        if leaps:
            made = self._made(origin, slow_map(self._terrain.size, origin, seed=self._seed))
            self._laid.release()
            self._laid, self._seen = made, -1
            self.leap()
        elif not self._is_at(origin, self._laid.origin):
            slow = self._hands.submit(slow_map, self._terrain.size, origin, seed=self._seed)
            self._coming = _Coming(origin, slow)

    def leap(self) -> None:
        """Draw all of it with the next frame, however long that takes."""
        self._toward = None

    def use(self) -> None:
        """Bind it."""
        assert self._laid is not None
        self._laid.lie.use(self._unit)

    def prepare(self, toward: Place, /) -> int:
        """Draw what is due for a sun in this direction over the ground (x, z); return the number of draw calls."""
        laid, each = self._laid, max(self._at_once // self._columns, 1)
        assert laid is not None
        rows = each
        if toward != self._toward:
            rows = self._rows if self._toward is None else rows
            self._toward, laid.left = toward, self._rows
            if self._coming is not None and self._coming.laid is not None:
                self._coming.laid.left = self._rows
        calls = self._bring(each)
        changed = self._seen != self._terrain.changes.count
        if not (laid.left or changed):
            return calls
        laid.target.use()
        calls += self._follow(laid, toward) if changed else 0
        self.use()
        return calls + self._draw_rows(laid, min(rows, laid.left))

    def _bring(self, rows: int) -> int:
        """Draw some rows of what comes; return the number of draw calls."""
        coming = self._coming
        if coming is None or not coming.slow.done():
            return 0
        if coming.laid is None:
            coming.laid = self._made(coming.origin, coming.slow.result())
            coming.laid.left, coming.changes = self._rows, self._terrain.changes.count
        laid = coming.laid
        if coming.changes != self._terrain.changes.count:
            coming.changes, coming.still, laid.left = self._terrain.changes.count, 0, self._rows
        self._before["highest"] = self._terrain.span[1]
        laid.target.use()
        if coming.still < self._rows:
            laid.slow.use(self._unit)
            some = min(rows, self._rows - coming.still)
            coming.still += some
            calls = self._draw(laid, 0, (0, coming.still - some, self._columns, some))
        else:
            calls = self._draw_rows(laid, min(rows, laid.left))
        self.use()
        return calls

    def _follow(self, laid: _Laid, toward: Place) -> int:
        """Draw what is other since heights have changed; return the number of draw calls.

        What they stand before is drawn at once where it is little, and else all of that map in its turn; so it is where
        mirror images of them stand before more.
        """
        terrain, whole = self._terrain, (0, 0, self._columns, self._rows)
        changed = None if self._seen < 0 else terrain.changes.since(self._seen)
        self._seen = terrain.changes.count
        self._before["highest"] = terrain.span[1]
        laid.slow.use(self._unit)
        still = [whole] if changed is None else [self._box(laid, part, 2.0) for part in changed]
        calls = sum(self._draw(laid, 0, box) for box in still)
        if changed is None or laid.left == self._rows or self._is_mirrored:
            laid.left = self._rows
            return calls
        before = [self._box(laid, part, 1.0, np.multiply(toward, _FARTHEST)) for part in changed]
        if sum(width * height for _, _, width, height in before) > AT_ONCE:
            laid.left = self._rows
            return calls
        self.use()
        return calls + sum(self._draw(laid, 1, box) for box in before)

    def _box(self, laid: _Laid, part: Part, around: float, away: Doubles | None = None) -> Box:
        """Return what of the map lies within some cells of a part of the terrain, or looks that way from `away`."""
        terrain = self._terrain
        if terrain.first is not None:
            right, down = np.rint(np.subtract(terrain.origin, laid.origin) / terrain.cell).astype(int).tolist()
            part = part.moved(down, right)
        first, last = (part.column, part.row), (part.column + part.columns - 1, part.row + part.rows - 1)
        ends = np.array([np.subtract(first, around), np.add(last, around)])
        far = ends if away is None else ends - away
        count = np.array([self._columns, self._rows])
        scale = count * terrain.cell / terrain.size
        low = np.clip(np.floor(np.minimum(ends[0], far[0]) * scale - 0.5), 0, count - 1).astype(int)
        high = np.clip(np.ceil(np.maximum(ends[1], far[1]) * scale - 0.5) + 1, low + 1, count).astype(int)
        return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])

    def _draw_rows(self, laid: _Laid, rows: int) -> int:
        """Draw the rows that have waited longest; return the number of draw calls."""
        calls = 0
        laid.left -= rows
        while rows:
            some = min(rows, self._rows - laid.row)
            calls += self._draw(laid, 1, (0, laid.row, self._columns, some))
            laid.row, rows = (laid.row + some) % self._rows, rows - some
        return calls

    def _draw(self, laid: _Laid, half: int, box: Box) -> int:
        """Draw a box of the first half of a map, or of the second; return the number of draw calls."""
        column, row, width, height = box
        left = half * self._columns
        laid.target.viewport = left, 0, self._columns, self._rows
        laid.target.scissor = left + column, row, width, height
        set_uniform(self._arrays[half].program, "corner", *laid.origin)
        self._arrays[half].render(moderngl.TRIANGLES, vertices=3)
        return 1

    def _let_go(self) -> None:
        release_all(self._laid, self._coming)
        self._laid = self._coming = None

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._arrays, self._still, self._before)
        self._let_go()
        self._hands.shutdown(wait=False, cancel_futures=True)


def map_shape(size: tuple[float, float], /) -> tuple[int, int]:
    """Return rows and columns of a map over a terrain of `size` [m]: about one sample per metre."""
    columns, rows = (int(np.clip(np.ceil(side), 16, FINEST_MAP)) for side in size)
    return rows, columns


def slow_map(size: tuple[float, float], origin: tuple[float, float], /, *, seed: int) -> NDArray[np.uint8]:
    """Return two slow noises n over a terrain of a size that begins there [m], each as 0.5 + 0.5 n.

    It has shape (rows, columns, 2), and may be called on another thread.
    """
    rows, columns = map_shape(size)
    (width, depth), (left, far) = size, origin
    x = (left + (np.arange(columns) + 0.5) / columns * width).astype(np.float32)
    z = (far + (np.arange(rows) + 0.5) / rows * depth).astype(np.float32)
    packed = np.empty((rows, columns, 2), np.uint8)
    for start in range(0, rows, _ROWS):
        some = slice(start, start + _ROWS)
        packed[some] = np.clip(np.round((0.5 + 0.5 * _slow_noise(x, z[some], seed)) * 255.0), 0, 255)
    return packed


def _slow_noise(x: Floats, z: Floats, seed: int) -> Floats:
    wide, close = (
        noise_grid(noise_table(seed, stream)[..., :2], x / np.float32(wave), z / np.float32(wave))
        for stream, wave in ((16, 23.0), (17, 6.0))
    )
    return 0.6 * wide + 0.4 * close


def laid_over(ctx: moderngl.Context, texels: NDArray[np.uint8]) -> moderngl.Texture:
    """Return a map (rows, columns, channels) as a texture over the terrain."""
    rows, columns, channels = texels.shape
    texture = ctx.texture((columns, rows), channels, np.ascontiguousarray(texels).tobytes(), alignment=1)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
