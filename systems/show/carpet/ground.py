"""Drawing the ground, and on it the 2D carpet, tile by tile."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Floats
from ....engine.gl.functions import NUMBERS, functions_of
from ....engine.gl.mipmaps import stack_for
from ....engine.gl.rasteriser import anisotropy
from ....engine.gl.shaders import tell
from ....engine.gl.stream import Stream, release_all
from ...frame.block import FrameBlock, joined
from .stock import CarpetStock
from .textures import image_count
from .tiles import TILE, tile_grid

Defines = dict[str, str | int]
"""What a program is told."""

RAISED = 0.66
"""Height of the carpet, as a part of the grass's: where what is seen of it stays in its place."""

OUTLINE = 0.88
"""Height of the carpet along outlines, as a part of the grass's: where leaves begin, with a few thin tips above."""

APART = 1e-6
"""How much farther what lies under the carpet is taken to be, of the depths that there are: kilometres away these are
too coarse to part the two."""

PUSHED = 2.0 * APART
"""The same of ground that is drawn before any grass."""

WHOLE, DENSE, THIN = 0, 1, 2
"""What is drawn of the carpet: all, where it covers at least half a pixel, or the rest."""

GLSL = {"RAISED": RAISED, "APART": APART}


class _Layer:
    """A program that draws tiles of the ground, with the tiles it draws; it is made once it is asked for."""

    def __init__(
        self, make: Callable[[], moderngl.Program], stream: Stream, corners: moderngl.Buffer, indices: moderngl.Buffer
    ) -> None:
        self._make, self.stream, self._grid = make, stream, (corners, indices)
        self._told: dict[str, object] = {}
        self._untold: dict[str, object] = {}
        """Of that, what the program is told before it draws next: of many, a frame draws with a few."""
        self.made: moderngl.VertexArray | None = None

    @property
    def array(self) -> moderngl.VertexArray:
        """What draws a tile."""
        if self.made is None:
            program, (corners, indices) = self._make(), self._grid
            contents = [(corners, "2f", "corner"), self.stream.binding(program)]
            self.made = program.ctx.vertex_array(program, contents, index_buffer=indices)
        if self._untold:
            for name, value in self._untold.items():
                asked = self.made.program.get(name, None)
                if isinstance(asked, moderngl.Uniform):
                    asked.value = value
            self._untold = {}
        return self.made

    def know(self, told: Mapping[str, object]) -> None:
        """Tell the program what it asks for of this once it draws."""
        fresh = {name: value for name, value in told.items() if self._told.get(name) != value}
        self._told |= fresh
        self._untold |= fresh

    def draw(self, **told: float) -> int:
        """Draw the tiles, if there are any, by a program that is told this; return the number of draw calls."""
        if not self.stream.count:
            return 0
        for name, value in told.items():
            tell(self.array.program, name, value)
        self.array.render(moderngl.TRIANGLES, instances=self.stream.count)
        return 1


def _program_of(layer: _Layer) -> moderngl.Program:
    return layer.array.program


class GroundPainter:
    """Draws ground and carpet."""

    def __init__(
        self,
        ctx: moderngl.Context,
        block: FrameBlock,
        stock: CarpetStock,
        units: Mapping[str, int],
        *,
        side: int,
        seed: int,
    ) -> None:
        self.stock, self._block = stock, block
        self._came: tuple[float, ...] = ()
        self._raised = RAISED, OUTLINE
        self.shares = ctx.texture((side, side), 1, alignment=1)
        self.shares.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.units = units
        self._ctx, self.rims = ctx, ctx.texture((1, 1), 1, dtype="f4")
        corners, indices = tile_grid()
        self.grid = ctx.buffer(corners), ctx.buffer(indices)
        self.streams = tuple(Stream(ctx, TILE) for _ in range(5))
        self.bare: list[_Layer] = []
        self.covered: list[_Layer] = []
        """The same, where carpet may lie."""
        self.under: list[_Layer] = []
        self.carpet: list[_Layer] = []
        """For what is usual, uncut and cut; for lamps beside that; and for all that there may be."""
        self.edged: list[_Layer] = []
        """What is drawn where grass ends or is cut: ground, what lies under the carpet, and the carpet."""
        self.casting: list[_Layer] = []
        """The carpet in shadow maps: where it is even, and where grass ends or is cut."""
        self.is_trodden = False
        """Whether anybody treads the grass, or has: then pixels of the carpet ask for that, which costs."""
        self._lay_out(seed)

    def _lay_out(self, seed: int) -> None:
        """Say which programs there are."""
        ctx, stock = self._ctx, self.stock
        self._seed = seed
        heads: Defines = {"HEADS": 1} if stock.heads else {}
        litter: Defines = {"ANISOTROPIC": 1} if anisotropy(ctx) > 1.0 else {}
        stack = stack_for(ctx, image_count(stock.growths))
        stacked: Defines = {"STACK": stack, "REPEATED": 1} if stack > 1 else {}
        whole: Defines = {"CUT": 0}
        cut: Defines = {"CUT": 1}
        usual: Defines = {"PLAIN": 1}
        trodden: Defines = {"TRODDEN": 1}
        known = heads | stacked | litter
        plain = known | usual | {"LAMPLESS": 1}
        wanted: list[tuple[list[_Layer], int, str, Defines]] = [
            *((self.bare, 0, "ground", litter | each) for each in (usual | whole, usual | cut, trodden)),
            *((self.under, 1, "under", heads | each) for each in (whole, cut)),
            *((self.carpet, 2, "carpet", each) for each in (plain | whole, plain | cut)),
            (self.carpet, 2, "carpet", known | usual),
            (self.carpet, 2, "carpet", known | trodden),
            (self.edged, 3, "ground", litter | trodden | {"EDGED": 1}),
            (self.edged, 4, "under", heads | {"EDGED": 1}),
            (self.edged, 4, "carpet", known | trodden | {"EDGED": 1}),
            *((self.casting, stream, "cast", {}) for stream in (2, 4)),
        ]
        for among, stream, name, defines in wanted:
            vertex, fragment = f"systems/show/carpet/{name}.vert", f"systems/show/carpet/{name}.frag"
            make = partial(joined, ctx, self._block, self.units, vertex, fragment, defines)
            among.append(_Layer(make, self.streams[stream], *self.grid))
        self.covered += [_Layer(partial(_program_of, each), self.streams[1], *self.grid) for each in self.bare]
        self.restock(stock)

    def making(self) -> Iterator[None]:
        """Make the programs that are not there yet, one at a time."""
        for each in self._layers:
            if each.made is None:
                _ = each.array
                yield

    @property
    def _layers(self) -> tuple[_Layer, ...]:
        return *self.bare, *self.under, *self.carpet, *self.edged, *self.casting

    def _tell(self, name: str, value: object) -> None:
        for layer in (*self._layers, *self.covered):
            layer.know({name: value})

    @property
    def _is_cut(self) -> bool:
        """Whether any grass has been cut: programs that need not ask for that are cheaper."""
        return bool(self._block.record["anything_cut"][0])

    @property
    def _is_rare(self) -> bool:
        """Whether there are shadow maps, shades or a ground of a game's own: then pixels ask for these."""
        record = self._block.record[0]
        return bool(record["maps_shown"] or record["shades_grid"][3] or self._block.earth)

    @property
    def _is_lamplit(self) -> bool:
        """Whether lamps shine: then pixels of the carpet ask for their light."""
        return bool(self._block.record["lamps_grid"][0, 3])

    def write(self, tiles: Sequence[NDArray[np.void]]) -> None:
        """Send the tiles, as `by_layer` parts them."""
        for stream, some in zip(self.streams, tiles, strict=True):
            stream.write(some)

    def write_rims(self, far: Floats) -> None:
        """Send how far the ground is from the next rim of a cliff (rows, columns) [m]."""
        if self.rims.size != far.shape[::-1]:
            self.rims.release()
            self.rims = self._ctx.texture(far.shape[::-1], 1, dtype="f4")
            self.rims.repeat_x = self.rims.repeat_y = False
        self.rims.write(np.ascontiguousarray(far))

    def rehearse(self) -> None:
        """Have something to draw for each program."""
        self.is_trodden = True
        for stream in self.streams[3:]:
            if not stream.count:
                stream.write(np.zeros(1, TILE))

    def raise_carpet(self, part: float, *, outline: float = 0.0) -> None:
        """Lay the carpet at this part of the height of the grass, and along outlines at that of `outline`, if any."""
        self._raised = part, outline
        self._tell("outline", outline / part)
        self.come(self._came)

    def fits(self, stock: CarpetStock, /) -> bool:
        """Return whether its programs draw another stock too."""
        layers = (image_count(each.growths) for each in (stock, self.stock))
        stacks = {stack_for(self._ctx, count) for count in layers}
        return stock.heads == self.stock.heads and len(stacks) == 1

    def restock(self, stock: CarpetStock, /) -> None:
        """Draw the images of a stock."""
        self.stock = stock
        for name, value in stock.layers(self._seed).items():
            self._tell(name, value)
        part, outline = self._raised
        self.raise_carpet(part, outline=outline)

    def come(self, came: tuple[float, ...], /) -> None:
        """Take over how much of each kind has become what it is to be."""
        self._came = came
        for name, value in self.stock.told(came, self._raised[0]).items():
            self._tell(name, value)

    def write_shares(self, shares: Bytes, centre: NDArray[np.int32], *, beyond: float) -> None:
        """Send how much the carpet shows, of 255, on each row of the patch table (rows,) around the viewer's cell.

        `beyond` is how much on the rest of the terrain.
        """
        self.shares.write(shares)
        self._block.record["carpet_window"] = *centre, self.shares.width // 2, beyond

    def use(self) -> None:
        """Bind what all of it reads."""
        self.shares.use(self.units["shares"])
        self.rims.use(self.units["rims"])
        if self._block.earth:
            gl = functions_of(self.shares.ctx)
            gl.glActiveTexture(NUMBERS["TEXTURE0"] + self.units["earth"])
            gl.glBindTexture(NUMBERS["TEXTURE_2D"], self._block.earth)

    def draw_bare(self, *, alone: bool) -> int:
        """Draw the bare ground, where it comes `alone` that of the carpet too; return the number of draw calls."""
        self.use()
        rare = 2 if self._is_rare or self.is_trodden else self._is_cut
        calls = self.bare[rare].draw(pushed=0.0) + self.edged[0].draw()
        if alone:
            calls += self.covered[rare].draw(pushed=PUSHED)
        return calls

    def draw_under(self) -> int:
        """Draw what lies under the carpet; return the number of draw calls."""
        self.use()
        return self.under[self._is_cut].draw() + self.edged[1].draw()

    def draw_carpet(self, part: int = WHOLE) -> int:
        """Draw the carpet, or a part of it: its outlines let through what is behind; return the draw calls."""
        self.use()
        rare = self._is_rare or self.is_trodden or any(self._came)
        even = self.carpet[3 if rare else 2 if self._is_lamplit else self._is_cut]
        return even.draw(part=part) + self.edged[2].draw(part=part)

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth at which grass of the carpet stops light from a place [m]; return the draw calls."""
        self.shares.use(self.units["shares"])
        for layer in self.casting:
            layer.know({"light": light})
        return sum(layer.draw() for layer in self.casting)

    def release(self) -> None:
        """Give everything back."""
        made = [layer.made for layer in self._layers if layer.made is not None]
        covered = [layer.made for layer in self.covered if layer.made is not None]
        release_all(*covered, *made, *(array.program for array in made))
        release_all(*self.streams, *self.grid, self.shares, self.rims)
