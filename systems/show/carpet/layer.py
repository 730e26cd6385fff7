"""Programs that draw tiles of the ground, and the streams of tiles that each viewer sees."""

from collections.abc import Callable, Mapping
from functools import lru_cache

import moderngl

from ....engine.gl.remembered import Shelves
from ....engine.gl.shaders import Texts, set_uniform
from ....engine.gl.stream import Stream, release_all
from ....engine.gl.texture import by_texel
from .pieces import ByLayer
from .tiles import ORDERS, TILE

BARE, BARE_PIECES, EVEN, EVEN_PIECES, EDGED, EDGED_CARPET, UNDER, UNDER_PIECES, OUTLINED = STREAMS = range(9)
"""Streams of tiles and of pieces of tiles. The first six are those of `ByLayer`; `UNDER` has the even carpet's once
more. `OUTLINED` has its whole tiles whose thin outlines are drawn by themselves.

The carpet's are drawn far to near. The ground's and those of `UNDER` are opaque, and drawn near to far: what nearer
ones hide costs nothing.
"""

WHOLE = BARE, EVEN, UNDER, OUTLINED
"""The streams of whole tiles."""


Needs = frozenset[str]
"""What the pixels of some frames have to read in addition: a program that reads less of it costs less.

`cut`: some grass has been cut. `lamps`: lights other than sun and sky shine. `changes`: a kind of grass turns into
another. `rare`: there are shadow maps, shades, or a ground of a game's own. `trodden`: grass has been trodden.
"""


@lru_cache(maxsize=64)
def needs_of(**present: object) -> Needs:
    """Return the needs that are `present`."""
    return frozenset(need for need, is_present in present.items() if is_present)


def unmet(defines: Mapping[str, str | int], /) -> Needs:
    """Return the needs that a program with these preprocessor definitions does not meet."""
    plain = "PLAIN" in defines
    return needs_of(
        cut=defines.get("CUT") == 0, lamps="LAMPLESS" in defines, changes=plain, rare=plain,
        trodden="TRODDEN" not in defines,
    )  # fmt: skip


Grids = tuple[tuple[moderngl.Buffer, ...], tuple[moderngl.Buffer, ...]]
"""Vertex buffer of a tile's and of a piece's grid, each followed by its index buffers, by stride."""


class GroundShelf:
    """GL objects of the ground that one viewer sees: its tiles by stream, and the carpet's share of each patch."""

    def __init__(self, ctx: moderngl.Context, side: int) -> None:
        self.streams = tuple(Stream(ctx, TILE) for _ in STREAMS)
        self.shares = by_texel(ctx.texture((side, side), 1, alignment=1))
        self.arrays: dict[tuple[Layer, int, int], moderngl.VertexArray] = {}
        """Vertex arrays by layer, stream and stride, each made when it is first drawn."""
        self.stride = 1
        """Grid points from one vertex of the mesh to the next."""
        self.order = 0
        """The order in which each tile's triangles are drawn, from `order_toward`."""
        self.tiles: ByLayer | None = None
        """The tiles sent last."""
        self.sent_shares: object = None
        """The carpet's shares sent last."""
        self.outlined: ByLayer | None = None
        """The tiles from which `OUTLINED` was sent last."""

    def release(self) -> None:
        """Release all GL objects."""
        release_all(*self.arrays.values(), *self.streams, self.shares)


class Layer:
    """A program that draws tiles of the ground, made when it is first needed."""

    def __init__(
        self,
        make: Callable[[], moderngl.Program],
        texts: Callable[[], Texts],
        shelves: Shelves[GroundShelf],
        grids: Grids,
        lacks: Needs,
    ) -> None:
        self._make, self.texts, self._shelves, self._grids = make, texts, shelves, grids
        self.lacks = lacks
        """What it cannot draw."""
        self._uniforms: dict[str, object] = {}
        self._pending: dict[str, object] = {}
        """Uniforms to be set before the program draws next: a frame draws with few of many programs."""
        self.made: moderngl.Program | None = None

    @property
    def program(self) -> moderngl.Program:
        """The program, with all its uniforms set."""
        if self.made is None:
            self.made = self._make()
        if self._pending:
            for name, value in self._pending.items():
                uniform = self.made.get(name, None)
                if isinstance(uniform, moderngl.Uniform):
                    uniform.value = value
            self._pending = {}
        return self.made

    def _array(self, stream: int, stride: int) -> moderngl.VertexArray:
        """Return the vertex array of a stream of the present viewer."""
        shelf = self._shelves.now
        if (self, stream, stride) not in shelf.arrays:
            grid = self._grids[stream not in WHOLE]
            program, corners, indices = self.program, grid[0], grid[stride]
            contents = [(corners, "2f", "corner"), shelf.streams[stream].binding(program)]
            shelf.arrays[self, stream, stride] = program.ctx.vertex_array(program, contents, index_buffer=indices)
        return shelf.arrays[self, stream, stride]

    def set_uniforms(self, uniforms: Mapping[str, object]) -> None:
        """Set uniforms before the next draw; the program may lack some of them."""
        fresh = {name: value for name, value in uniforms.items() if self._uniforms.get(name) != value}
        self._uniforms |= fresh
        self._pending |= fresh

    def draw(self, *streams: int, **uniforms: float) -> int:
        """Draw the streams that have tiles, with these uniforms set first; return the number of draw calls."""
        shelf, calls, stride = self._shelves.now, 0, self._shelves.now.stride
        for stream in streams:
            count = shelf.streams[stream].count
            if not count:
                continue
            if not calls:
                program, uniforms["stride"] = self.program, stride
                for name, value in uniforms.items():
                    set_uniform(program, name, value)
            array, calls = self._array(stream, stride), calls + 1
            corners = array.vertices // ORDERS
            array.render(moderngl.TRIANGLES, corners, first=shelf.order * corners, instances=count)
        return calls


def cheapest(layers: Mapping[str, Layer], needs: Needs, /) -> Layer:
    """Return the first of these programs, which begin with the cheapest, that meets all needs."""
    for layer in layers.values():  # `next` would make many calls a frame
        if not layer.lacks & needs:
            return layer
    raise LookupError(needs)
