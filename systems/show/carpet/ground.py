"""Drawing the ground, and on it the 2D carpet, tile by tile."""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial

import moderngl
import numpy as np

from ....components.arrays import Bytes, Floats
from ....components.viewer import Viewer
from ....engine.gl.functions import ENUMS, functions_of
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
    Needs,
    cheapest,
    needs_of,
    unmet,
)
from .pieces import ByLayer
from .stock import RAISED, CarpetStock
from .textures import image_count
from .tiles import PIECE, TILE, in_orders, order_toward, skirted_grid, tile_grid

Defines = dict[str, str | int]
"""Preprocessor definitions of a program."""

Variants = Mapping[str, Defines]
"""Definitions of the programs of one pass, by what they draw."""

OUTLINE = 0.88 / RAISED
"""Height of the carpet along outlines, as a fraction of that elsewhere: only a few thin tips stand out above."""

APART = 1e-6
"""Depth added to the layer under the carpet, in the usual clip range of -1 to 1: kilometres away, depth is too coarse
to tell the two apart."""

MOST_COARSE = 4
"""Largest number of kinds that a coarse carpet draws: for more, there are too few varyings."""

COARSE_STRIDE = 2
"""Grid points from one vertex of a coarse mesh to the next."""

PUSHED = 2.0 * APART
"""Depth added to ground that is drawn before any grass, in the usual clip range of -1 to 1."""

THIN_UP_TO = 10.0
"""Largest grid spacing of tiles whose thin carpet is drawn by itself: half a kilometre away [m]."""

WHOLE, DENSE, THIN = 0, 1, 2
"""Parts of the carpet that a pass draws: all, where it covers at least half a pixel, or the rest."""

GLSL = {"RAISED": RAISED, "HIGHER_OUTLINE": OUTLINE, "APART": APART}


class GroundPainter:
    """Draws ground and carpet in one GL context."""

    def __init__(
        self,
        ctx: moderngl.Context,
        block: FrameBlock,
        stock: CarpetStock,
        units: Mapping[str, int],
        *,
        side: int,
        seed: int,
        coarse: bool,
    ) -> None:
        self.stock, self._block = stock, block
        self._came: tuple[float, ...] = ()
        self.units, self._side = units, side
        self._ctx, self.rims = ctx, ctx.texture((1, 1), 1, dtype="f4")
        self._no_earth = ctx.texture((1, 1), 4, bytes(4))
        self.stride = COARSE_STRIDE if coarse else 1
        """Grid points from one vertex of the mesh to the next."""
        makes = tile_grid, partial(tile_grid, quads=PIECE), partial(skirted_grid, quads=PIECE)
        tile, piece, skirted = (
            (ctx.buffer(make()[0]), *(ctx.buffer(in_orders(*make(stride))) for stride in (1, COARSE_STRIDE)))
            for make in makes
        )
        self.grids: Grids = tile, piece
        self.skirted: Grids = tile, skirted
        self.shelves = Shelves(partial(GroundShelf, ctx, side))
        self.is_trodden = False
        """Whether grass has been trodden: only then do the carpet's pixels read that, which costs."""
        self._rehearses = False
        """Whether every program draws once, to be ready."""
        self._is_coarse = coarse and len(stock.before.crown) <= MOST_COARSE
        self._seed = seed
        self._list_layers()
        self.restock(stock)

    def _list_layers(self) -> None:
        """List all programs of each pass, from the cheapest to the one that meets all needs.

        They are compiled when first needed. Edged ones draw where grass ends or is cut.
        """
        ctx, stock = self._ctx, self.stock
        stack = stack_for(ctx, image_count(stock.growths))
        heads: Defines = {"HEADS": 1} if stock.heads else {}
        litter: Defines = {"ANISOTROPIC": 1} if anisotropy(ctx) > 1.0 else {}
        stacked: Defines = {"STACK": stack, "REPEATED": 1} if stack > 1 else {}
        carpet, ends = heads | stacked | litter, Defines(EDGED=1)
        every: Variants = {"all": {"TRODDEN": 1}}  # meets all needs, see `unmet`
        usual: Variants = {"usual": {"PLAIN": 1}, **every}
        untrodden: Variants = {"untrodden": {}, **every}
        lit: Variants = {"uncut": {"PLAIN": 1, "CUT": 0}, "cut": {"PLAIN": 1, "CUT": 1}}
        lampless = {name: each | {"LAMPLESS": 1} for name, each in lit.items()}
        uncut = {"uncut": lampless["uncut"]}
        self.bare = self._pass("ground", litter, {**lit, **every})
        self.under = self._pass("under", heads, {**uncut, **untrodden})
        self.coarse = self._pass("coarse", carpet, {**uncut, **every} if self._is_coarse else {})
        self.carpet = self._pass("carpet", carpet, usual if self._is_coarse else {**lampless, **usual})
        self.edged_bare = self._pass("ground", litter | ends, usual)
        self.edged_under = self._pass("under", heads | ends, untrodden)
        self.edged = self._pass("carpet", carpet | ends, {**lampless, **untrodden}, self.skirted)
        self.casting = self._pass("cast", {}, {"all": {}})
        """The carpet in shadow maps."""

    def _pass(self, name: str, common: Defines, variants: Variants, grids: Grids | None = None) -> dict[str, Layer]:
        """Return the programs of a pass, whose shaders have this name."""
        stem, layers = f"systems/show/carpet/{name}", dict[str, Layer]()
        for variant, defines in variants.items():
            given = f"{stem}.vert", f"{stem}.frag", common | defines
            make = partial(joined, self._ctx, self._block, self.units, *given)
            texts, lacks = partial(self._block.texts, *given), unmet(defines)
            layers[variant] = Layer(make, texts, self.shelves, grids or self.grids, lacks)
        return layers

    def texts(self) -> Iterator[Texts]:
        """Return the sources of the programs that are not made yet."""
        for each in self._layers:
            if each.made is None:
                yield each.texts()

    def making(self) -> Iterator[None]:
        """Make the programs that are not made yet, one at a time."""
        for each in self._layers:
            if each.made is None:
                _ = each.program
                yield

    @property
    def _layers(self) -> list[Layer]:
        even = self.bare, self.under, self.coarse, self.carpet
        passes = *even, self.edged_bare, self.edged_under, self.edged, self.casting
        return [layer for each in passes for layer in each.values()]

    def _set_uniform(self, name: str, value: object) -> None:
        for layer in self._layers:
            layer.set_uniforms({name: value})

    def _needs(self, *, changes: bool = False) -> Needs:
        """Return what this frame's pixels have to read, if grass also `changes`."""
        block, record = self._block, self._block.record[0]
        return needs_of(
            cut=record["anything_cut"] != 0, lamps=record["beside_sun"] != 0, changes=changes,
            rare=(block.given.casts or block.given.earth) != 0, trodden=self.is_trodden,
        )  # fmt: skip

    def _used(self, layers: Mapping[str, Layer], needs: Needs) -> Iterable[Layer]:
        """Return the program of a pass for these needs, or all where every one is to draw once."""
        return layers.values() if self._rehearses else [cheapest(layers, needs)]

    @property
    def _is_odd(self) -> bool:
        """Whether the carpet ends with the terrain or lies on a game's own ground: a coarse program cannot do that."""
        record = self._block.record[0]
        return self._is_coarse and bool(
            record["over_hosts"] or self._block.given.earth or record["mesh_high"][0] < EVERYWHERE
        )

    def write(self, tiles: ByLayer) -> None:
        """Upload tiles."""
        shelf = self.shelves.now
        bare, bare_pieces, even, even_pieces, edged, edged_carpet = tiles
        ground, under = (bare[::-1], bare_pieces[::-1]), (even[::-1], even_pieces[::-1])
        sent = *ground, even, even_pieces, edged[::-1], edged_carpet, *under
        for stream, records in zip(shelf.streams, sent, strict=False):
            stream.write(records)
        shelf.tiles = tiles

    def write_outlined(self) -> None:
        """Upload the tiles whose thin outlines are drawn by themselves, out of those uploaded last."""
        shelf = self.shelves.now
        if shelf.outlined is shelf.tiles or shelf.tiles is None:
            return
        shelf.outlined, even = shelf.tiles, shelf.tiles.even
        shelf.streams[OUTLINED].write(even[even["tile"][:, 2] <= THIN_UP_TO])

    def write_rims(self, distance: Floats) -> None:
        """Upload the distances of the ground from the nearest rim of a cliff (rows, columns) [m]."""
        if self.rims.size != distance.shape[::-1]:
            self.rims.release()
            self.rims = self._ctx.texture(distance.shape[::-1], 1, dtype="f4")
            self.rims.repeat_x = self.rims.repeat_y = False
        self.rims.write(np.ascontiguousarray(distance))

    def tread(self, *, is_trodden: bool) -> None:
        """Set whether grass has been trodden, for what is drawn next."""
        self.is_trodden, self._rehearses = is_trodden, False

    def rehearse(self) -> None:
        """Give each program something to draw."""
        self.is_trodden = self._rehearses = True
        shelf = self.shelves.now
        shelf.tiles = shelf.outlined = None
        for stream in (*shelf.streams[EDGED : EDGED_CARPET + 1], shelf.streams[OUTLINED]):
            if not stream.count:
                stream.write(np.zeros(1, TILE))

    def fits(self, stock: CarpetStock, /) -> bool:
        """Return whether the programs can draw another stock too."""
        counts = (image_count(each.growths) for each in (stock, self.stock))
        stacks = {stack_for(self._ctx, count) for count in counts}
        return stock.heads == self.stock.heads and len(stacks) == 1

    def restock(self, stock: CarpetStock, /) -> None:
        """Draw the images of a stock."""
        self.stock = stock
        is_whole = stack_for(self._ctx, image_count(stock.growths)) > 1
        for name, value in stock.layer_uniforms(self._seed, whole=is_whole).items():
            self._set_uniform(name, value)
        self.come(self._came)

    def come(self, came: tuple[float, ...], /) -> None:
        """Set the fraction of each kind's plants that have become what the kind is to become."""
        self._came = came
        for name, value in self.stock.uniforms(came).items():
            self._set_uniform(name, value)

    def write_shares(self, shares: Bytes) -> None:
        """Upload the carpet's share, of 255, for each row of the patch table, (rows,)."""
        shelf = self.shelves.now
        shelf.shares.write(shares)
        shelf.sent_shares = shares

    def look_from(self, viewer: Viewer, *, beyond: float) -> None:
        """Set the viewer's cell and direction, and the carpet's share `beyond` the patches around it, in [0, 1]."""
        self.shelves.now.order = order_toward(viewer.cone[0])
        self._block.record["carpet_window"] = *viewer.centre, self._side // 2, beyond
        self._block.record["windows_per_patch"] = 1.0 / self._side

    def use(self) -> None:
        """Bind the textures that all programs read."""
        shelf, on_hosts = self.shelves.now, bool(self._block.record["over_hosts"][0])
        shelf.stride = 1 if on_hosts else self.stride  # it has to lie on the game's ground
        shelf.shares.use(self.units["shares"])
        self.rims.use(self.units["rims"])
        if self._block.given.earth:
            gl = functions_of(self._ctx)
            gl.glActiveTexture(ENUMS["TEXTURE0"] + self.units["earth"])
            gl.glBindTexture(ENUMS["TEXTURE_2D"], self._block.given.earth)
        else:  # some drivers compile programs again for another texture, and any might be bound there
            self._no_earth.use(self.units["earth"])

    def draw_bare(self, *, alone: bool) -> int:
        """Draw the bare ground, if `alone` also where carpet will lie; return the number of draw calls."""
        self.use()
        needs = self._needs()
        bare = cheapest(self.bare, needs)
        calls = bare.draw(BARE, BARE_PIECES, pushed=0.0)
        for layer in self._used(self.edged_bare, needs):
            calls += layer.draw(EDGED)
        if alone:
            calls += bare.draw(EVEN, EVEN_PIECES, pushed=PUSHED)
        return calls

    def draw_under(self) -> int:
        """Draw the opaque layer under the carpet; return the number of draw calls."""
        self.use()
        needs = self._needs()
        calls = cheapest(self.under, needs).draw(UNDER, UNDER_PIECES)
        for layer in self._used(self.edged_under, needs):
            calls += layer.draw(EDGED_CARPET)
        return calls

    def draw_carpet(self, part: int) -> int:
        """Draw a part of the carpet, whose outlines are translucent; return the number of draw calls."""
        self.use()
        needs = self._needs(changes=any(self._came))
        is_coarse = self._is_coarse and not self._is_odd and not needs & {"lamps", "changes"}
        even = cheapest(self.coarse if is_coarse else self.carpet, needs)
        calls = even.draw(OUTLINED if part == THIN else EVEN, EVEN_PIECES, part=part)
        for layer in self._used(self.edged, needs):
            calls += layer.draw(EDGED_CARPET, part=part)
        return calls

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth at which the carpet stops light from a place [m]; return the number of draw calls."""
        self.shelves.now.shares.use(self.units["shares"])
        layer = self.casting["all"]
        layer.set_uniforms({"light": light})
        return layer.draw(EVEN, EVEN_PIECES, EDGED_CARPET)

    def release(self) -> None:
        """Release all GL objects."""
        release_all(*(layer.made for layer in self._layers if layer.made is not None))
        release_all(self.shelves, *self.grids[0], *self.grids[1], *self.skirted[1], self.rims, self._no_earth)
