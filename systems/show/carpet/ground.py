"""Drawing the ground, and on it the 2D carpet, tile by tile."""

from collections.abc import Iterator, Mapping
from functools import partial

import moderngl
import numpy as np

from ....components.arrays import Bytes, Floats
from ....components.viewer import Viewer
from ....engine.gl.functions import NUMBERS, functions_of
from ....engine.gl.mipmaps import stack_for
from ....engine.gl.rasteriser import anisotropy
from ....engine.gl.remembered import Shelves
from ....engine.gl.shaders import Texts
from ....engine.gl.stream import release_all
from ...frame.block import EVERYWHERE, FrameBlock, joined
from .layer import (
    BARE,
    BARE_PIECES,
    EDGED,
    EDGED_CARPET,
    EVEN,
    EVEN_PIECES,
    OUTLINED,
    UNDER,
    UNDER_PIECES,
    Grids,
    GroundShelf,
    Layer,
)
from .pieces import ByLayer
from .stock import CarpetStock
from .textures import image_count
from .tiles import PIECE, TILE, hanging_grid, in_orders, order_toward, tile_grid

Defines = dict[str, str | int]
"""What a program is told."""

RAISED = 0.66
"""Height of the carpet, as a part of the grass's: where what is seen of it stays in its place."""

OUTLINE = 0.88
"""Height of the carpet along outlines, as a part of the grass's: where leaves begin, with a few thin tips above."""

APART = 1e-6
"""How much farther what lies under the carpet is taken to be, of the depths that there are: kilometres away these are
too coarse to part the two."""

MOST_COARSE = 4
"""Kinds of grass that there are at most for a coarse carpet: of more, corners cannot bring all along that it needs."""

COARSER = 2
"""How many times as far apart the points of the mesh are where it is coarse."""

PUSHED = 2.0 * APART
"""The same of ground that is drawn before any grass."""

THIN_UP_TO = 10.0
"""Distance between grid points of tiles up to which thin carpet is drawn by itself: half a kilometre off [m]."""

WHOLE, DENSE, THIN = 0, 1, 2
"""What is drawn of the carpet: all, where it covers at least half a pixel, or the rest."""

GLSL = {"RAISED": RAISED, "APART": APART}


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
        coarse: bool = False,
    ) -> None:
        self.stock, self._block = stock, block
        self._came: tuple[float, ...] = ()
        self._raised = RAISED, OUTLINE
        self.units, self._side = units, side
        self._ctx, self.rims = ctx, ctx.texture((1, 1), 1, dtype="f4")
        self._coarser = COARSER if coarse else 1
        makes = tile_grid, partial(tile_grid, quads=PIECE), partial(hanging_grid, quads=PIECE)
        tile, piece, hanging = (
            (ctx.buffer(make()[0]), *(ctx.buffer(in_orders(*make(wider))) for wider in (1, COARSER))) for make in makes
        )
        self.grids: Grids = tile, piece
        self.hanging: Grids = tile, hanging
        self.shelves = Shelves(partial(GroundShelf, ctx, side))
        self.bare: list[Layer] = []
        self.under: list[Layer] = []
        self.carpet: list[Layer] = []
        """For what is usual, uncut and cut, or where it is coarse for what is usual and for all that this can show; for
        lamps beside what is usual; and for all that there may be."""
        self.edged_bare: list[Layer] = []
        self.edged_under: list[Layer] = []
        self.edged: list[Layer] = []
        """The same where grass ends or is cut: for what is usual, which the carpet has uncut and cut without lamps, and
        for all that there may be; of the carpet besides for all but people who tread it."""
        self.casting: list[Layer] = []
        """The carpet in shadow maps."""
        self.is_trodden = False
        """Whether anybody treads the grass, or has: then pixels of the carpet ask for that, which costs."""
        self._rehearses = False
        """Whether every program is drawn with that may come."""
        self._is_coarse = coarse and len(stock.before.crown) <= MOST_COARSE
        self._lay_out(seed)

    def _lay_out(self, seed: int) -> None:
        """Say which programs there are."""
        ctx, stock = self._ctx, self.stock
        self._seed = seed
        heads: Defines = {"HEADS": 1} if stock.heads else {}
        litter: Defines = {"ANISOTROPIC": 1} if anisotropy(ctx) > 1.0 else {}
        stack = stack_for(ctx, image_count(stock.growths))
        stacked: Defines = {"STACK": stack, "REPEATED": 1} if stack > 1 else {}
        usual: Defines = {"PLAIN": 1}
        plain: Defines = usual | {"LAMPLESS": 1}
        cuts: list[Defines] = [{"CUT": 0}, {"CUT": 1}]
        trodden: Defines = {"TRODDEN": 1}
        ends: Defines = {"EDGED": 1}
        known = heads | stacked | litter
        firsts = (plain | cuts[0], trodden) if self._is_coarse else tuple(plain | cut for cut in cuts)
        wanted: list[tuple[list[Layer], str, Defines]] = [
            *((self.bare, "ground", litter | each) for each in (*(usual | cut for cut in cuts), trodden)),
            *((self.under, "under", heads | each) for each in (plain | cuts[0], {}, trodden)),
            *((self.carpet, "carpet", known | each) for each in (*firsts, usual, trodden)),
            *((self.edged_bare, "ground", litter | each | ends) for each in (usual, trodden)),
            *((self.edged_under, "under", heads | each | ends) for each in ({}, trodden)),
            *((self.edged, "carpet", known | each | ends) for each in (*(plain | cut for cut in cuts), {}, trodden)),
            (self.casting, "cast", {}),
        ]
        for among, name, defines in wanted:
            simple = self._is_coarse and among is self.carpet and len(among) < len(firsts)
            files = f"systems/show/carpet/{name}.vert", f"systems/show/carpet/{'coarse' if simple else name}.frag"
            told = defines | {"COARSE": 1} if simple else defines
            make = partial(joined, ctx, self._block, self.units, *files, told)
            texts = partial(self._block.texts, *files, told)
            hangs = among is self.edged
            among.append(Layer(make, texts, self.shelves, self.hanging if hangs else self.grids))
        self.restock(stock)

    def texts(self) -> Iterator[Texts]:
        """Return what the programs that are not there yet are made of."""
        for each in self._layers:
            if each.made is None:
                yield each.texts()

    def making(self) -> Iterator[None]:
        """Make the programs that are not there yet, one at a time."""
        for each in self._layers:
            if each.made is None:
                _ = each.program
                yield

    @property
    def _layers(self) -> tuple[Layer, ...]:
        even = *self.bare, *self.under, *self.carpet
        return *even, *self.edged_bare, *self.edged_under, *self.edged, *self.casting

    def _tell(self, name: str, value: object) -> None:
        for layer in self._layers:
            layer.know({name: value})

    @property
    def wider(self) -> int:
        """How many times as far apart points of its mesh are as tiles say."""
        return self._coarser

    @property
    def _is_cut(self) -> bool:
        """Whether any grass has been cut: pixels that need not ask for that are cheaper."""
        return bool(self._block.record["anything_cut"][0])

    @property
    def _is_rare(self) -> bool:
        """Whether there are shadow maps, shades or a ground of a game's own: then pixels ask for these."""
        return bool(self._block.casts or self._block.earth)

    @property
    def _is_odd(self) -> bool:
        """Whether the carpet ends with the terrain, or lies on a game's own ground: the coarse one cannot."""
        record = self._block.record[0]
        return self._is_coarse and bool(
            record["over_hosts"] or self._block.earth or record["mesh_high"][0] < EVERYWHERE
        )

    @property
    def _is_lamplit(self) -> bool:
        """Whether anything shines beside sun and sky: then pixels of the carpet ask for its light."""
        return bool(self._block.record["beside_sun"][0])

    def write(self, tiles: ByLayer) -> None:
        """Send the tiles, as `by_layer` parts them."""
        shelf = self.shelves.now
        bare, bare_pieces, even, even_pieces, edged, carpet = tiles
        sent = bare[::-1], bare_pieces[::-1], even, even_pieces, edged[::-1], carpet, even[::-1], even_pieces[::-1]
        for stream, some in zip(shelf.streams, sent, strict=False):
            stream.write(some)
        shelf.tiles = tiles

    def write_outlined(self) -> None:
        """Send those of the tiles that were sent whose outlines are drawn where they are thin."""
        shelf = self.shelves.now
        if shelf.outlined is shelf.tiles or shelf.tiles is None:
            return
        shelf.outlined, even = shelf.tiles, shelf.tiles.even
        shelf.streams[OUTLINED].write(even[even["tile"][:, 2] <= THIN_UP_TO])

    def write_rims(self, far: Floats) -> None:
        """Send how far the ground is from the next rim of a cliff (rows, columns) [m]."""
        if self.rims.size != far.shape[::-1]:
            self.rims.release()
            self.rims = self._ctx.texture(far.shape[::-1], 1, dtype="f4")
            self.rims.repeat_x = self.rims.repeat_y = False
        self.rims.write(np.ascontiguousarray(far))

    def tread(self, *, is_trodden: bool) -> None:
        """Take over whether anybody treads the grass, or has, in what is drawn next."""
        self.is_trodden, self._rehearses = is_trodden, False

    def rehearse(self) -> None:
        """Have something to draw for each program."""
        self.is_trodden = self._rehearses = True
        shelf = self.shelves.now
        shelf.tiles = shelf.outlined = None
        for stream in (*shelf.streams[EDGED : EDGED_CARPET + 1], shelf.streams[OUTLINED]):
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
        is_whole = stack_for(self._ctx, image_count(stock.growths)) > 1
        for name, value in stock.layers(self._seed, whole=is_whole).items():
            self._tell(name, value)
        part, outline = self._raised
        self.raise_carpet(part, outline=outline)

    def come(self, came: tuple[float, ...], /) -> None:
        """Take over how much of each kind has become what it is to be."""
        self._came = came
        for name, value in self.stock.told(came, self._raised[0]).items():
            self._tell(name, value)

    def write_shares(self, shares: Bytes) -> None:
        """Send how much the carpet shows, of 255, on each row of the patch table (rows,) around the viewer's cell."""
        shelf = self.shelves.now
        shelf.shares.write(shares)
        shelf.shown = shares

    def look_from(self, viewer: Viewer, *, beyond: float) -> None:
        """Take over the viewer's cell and where it looks, and how much carpet shows `beyond` the patches around it."""
        self.shelves.now.order = order_toward(viewer.cone[0])
        self._block.record["carpet_window"] = *viewer.centre, self._side // 2, beyond
        self._block.record["windows_a_patch"] = 1.0 / self._side

    def use(self) -> None:
        """Bind what all of it reads."""
        shelf, on_hosts = self.shelves.now, bool(self._block.record["over_hosts"][0])
        shelf.wider = 1 if on_hosts else self._coarser  # it has to lie on the game's ground
        shelf.shares.use(self.units["shares"])
        self.rims.use(self.units["rims"])
        if self._block.earth:
            gl = functions_of(self._ctx)
            gl.glActiveTexture(NUMBERS["TEXTURE0"] + self.units["earth"])
            gl.glBindTexture(NUMBERS["TEXTURE_2D"], self._block.earth)

    def draw_bare(self, *, alone: bool) -> int:
        """Draw the bare ground, where it comes `alone` that of the carpet too; return the number of draw calls."""
        self.use()
        rare = self._is_rare or self.is_trodden
        bare = self.bare[2 if rare else self._is_cut]
        calls = bare.draw(BARE, BARE_PIECES, pushed=0.0)
        for layer in self.edged_bare if self._rehearses else [self.edged_bare[rare]]:
            calls += layer.draw(EDGED)
        if alone:
            calls += bare.draw(EVEN, EVEN_PIECES, pushed=PUSHED)
        return calls

    def draw_under(self) -> int:
        """Draw what lies under the carpet; return the number of draw calls."""
        self.use()
        special = self._is_rare or self._is_lamplit or self._is_cut
        calls = self.under[2 if self.is_trodden else special].draw(UNDER, UNDER_PIECES)
        for layer in self.edged_under if self._rehearses else [self.edged_under[self.is_trodden]]:
            calls += layer.draw(EDGED_CARPET)
        return calls

    def draw_carpet(self, part: int = WHOLE) -> int:
        """Draw the carpet, or a part of it: its outlines let through what is behind; return the draw calls."""
        self.use()
        rare, changes = self._is_rare or self.is_trodden, any(self._came)
        special = changes or self._is_lamplit
        if self._is_coarse and not special and not self._is_odd:
            even = self.carpet[rare or self._is_cut]
        else:
            even = self.carpet[3 if rare or changes else 2 if special or self._is_coarse else self._is_cut]
        edged = self.edged[3 if self.is_trodden else 2 if rare or special else self._is_cut]
        calls = even.draw(OUTLINED if part == THIN else EVEN, EVEN_PIECES, part=part)
        for layer in self.edged if self._rehearses else [edged]:
            calls += layer.draw(EDGED_CARPET, part=part)
        return calls

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth at which grass of the carpet stops light from a place [m]; return the draw calls."""
        self.shelves.now.shares.use(self.units["shares"])
        (layer,) = self.casting
        layer.know({"light": light})
        return layer.draw(EVEN, EVEN_PIECES, EDGED_CARPET)

    def release(self) -> None:
        """Give everything back."""
        release_all(*(layer.made for layer in self._layers if layer.made is not None))
        release_all(self.shelves, *self.grids[0], *self.grids[1], *self.hanging[1], self.rims)
