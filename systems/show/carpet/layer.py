"""What draws tiles of the ground, and the tiles that each viewer sees."""

from collections.abc import Callable, Mapping

import moderngl

from ....engine.gl.remembered import Shelves
from ....engine.gl.shaders import Texts, set_uniform
from ....engine.gl.stream import Stream, release_all
from .pieces import ByLayer
from .tiles import ORDERS, TILE

BARE, BARE_PIECES, EVEN, EVEN_PIECES, EDGED, EDGED_CARPET, UNDER, UNDER_PIECES, OUTLINED = STREAMS = range(9)
"""What tiles and pieces of tiles are parted into, as `by_layer` has them, and once more those of the even carpet: near
to far. And those of its whole tiles whose outlines are drawn where they are thin, far to near.

So are those of the ground. They are opaque: what the nearer ones hide costs nothing.
"""

WHOLE = BARE, EVEN, UNDER, OUTLINED
"""Of these, the streams of whole tiles."""


Grids = tuple[tuple[moderngl.Buffer, ...], tuple[moderngl.Buffer, ...]]
"""The grid points of a tile and of a piece of one, each with the corners of triangles by how far apart these are."""


class GroundShelf:
    """What is sent of the ground that one viewer sees: tiles by layer, and how much the carpet shows on each patch."""

    def __init__(self, ctx: moderngl.Context, side: int) -> None:
        self.streams = tuple(Stream(ctx, TILE) for _ in STREAMS)
        self.shares = ctx.texture((side, side), 1, alignment=1)
        self.shares.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.arrays: dict[tuple[Layer, int, int], moderngl.VertexArray] = {}
        """What draws the tiles of a stream as a layer does, with corners so far apart, once it is asked for."""
        self.wider = 1
        """How many times as far apart points of the mesh are as tiles say."""
        self.order = 0
        """The order in which each tile's triangles are drawn, as `order_toward` has it."""
        self.tiles: ByLayer | None = None
        self.shown: object = None
        """What was sent last."""
        self.outlined: ByLayer | None = None
        """Of which tiles those were whose outlines are drawn where they are thin."""

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.arrays.values(), *self.streams, self.shares)


class Layer:
    """A program that draws tiles of the ground, made once it is asked for."""

    def __init__(
        self,
        make: Callable[[], moderngl.Program],
        texts: Callable[[], Texts],
        shelves: Shelves[GroundShelf],
        grids: Grids,
    ) -> None:
        self._make, self.texts, self._shelves, self._grids = make, texts, shelves, grids
        self._told: dict[str, object] = {}
        self._untold: dict[str, object] = {}
        """Of that, what the program is told before it draws next: of many, a frame draws with a few."""
        self.made: moderngl.Program | None = None

    @property
    def program(self) -> moderngl.Program:
        """What draws a tile, told all that it asks for."""
        if self.made is None:
            self.made = self._make()
        if self._untold:
            for name, value in self._untold.items():
                asked = self.made.get(name, None)
                if isinstance(asked, moderngl.Uniform):
                    asked.value = value
            self._untold = {}
        return self.made

    def _array(self, stream: int, wider: int) -> moderngl.VertexArray:
        """Return what draws those tiles of the viewer that looks."""
        shelf = self._shelves.now
        if (self, stream, wider) not in shelf.arrays:
            grid = self._grids[stream not in WHOLE]
            program, corners, indices = self.program, grid[0], grid[wider]
            contents = [(corners, "2f", "corner"), shelf.streams[stream].binding(program)]
            shelf.arrays[self, stream, wider] = program.ctx.vertex_array(program, contents, index_buffer=indices)
        return shelf.arrays[self, stream, wider]

    def know(self, told: Mapping[str, object]) -> None:
        """Tell the program what it asks for of this once it draws."""
        fresh = {name: value for name, value in told.items() if self._told.get(name) != value}
        self._told |= fresh
        self._untold |= fresh

    def draw(self, *streams: int, **told: float) -> int:
        """Draw the tiles of streams in which there are any, by a program that is told this; return the draw calls."""
        shelf, calls, wider = self._shelves.now, 0, self._shelves.now.wider
        for stream in streams:
            count = shelf.streams[stream].count
            if not count:
                continue
            if not calls:
                program, told["wider"] = self.program, wider
                for name, value in told.items():
                    set_uniform(program, name, value)
            array, calls = self._array(stream, wider), calls + 1
            corners = array.vertices // ORDERS
            array.render(moderngl.TRIANGLES, corners, first=shelf.order * corners, instances=count)
        return calls
