"""Painting the carpet, and the ground under everything."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Floats, Mask
from ....components.viewer import Viewer
from ....engine.gl.guest import set_depth_test
from ....engine.gl.mipmaps import at_once
from ....engine.gl.remembered import Remembered
from ....engine.gl.shaders import Texts
from ....engine.gl.stream import release_all
from ...around.asked import Asked
from ...around.outlook import Outlook
from ...around.patches import PatchTable
from ...mow.mown import Mown
from ...press.marks import UNTRODDEN, Trodden
from ...space.cone import HALF_DIAGONAL
from ...space.ground import Ground
from ...space.grown import Grown
from ..representation import Canvas, RepresentationPainter
from .air import Air
from .edges import Edges
from .found import Found
from .ground import DENSE, THIN, WHOLE, GroundPainter
from .pieces import ByLayer, PieceEdges, by_layer, find_edges
from .pool import CarpetKept
from .stock import CarpetStock
from .textures import bent_texture, sending_carpet
from .tiles import (
    GRID,
    Tiles,
    bare_within,
    finest_spacing,
    meets_terrain,
    on_terrain,
    records_of,
    tiles_around,
    which_seen,
)

RIM_OFFSET = 1.0
"""Largest distance of a grid point from its place at a rim of a cliff [grid points]."""

STEP = 0.4
"""Distance that the eye moves before tiles are chosen anew, in sides of the finest tiles."""


class CarpetPainter(RepresentationPainter):
    """Draws the ground and the carpet on it."""

    def __init__(self, canvas: Canvas, stock: CarpetStock, ground: Ground, side: int, *, coarse: bool) -> None:
        self._ground, self._spacing = ground, finest_spacing(ground.terrain, ground.patch)
        self._units, self._block, self._reach = canvas.units, canvas.block, canvas.reach[-2]
        self._around, self._seen = Remembered[Tiles](), Remembered[ByLayer]()
        self._piece_edges = Remembered[PieceEdges]()
        self._edges, self._tallest = Edges(), 0.0
        self._rims, self._rims_sent = Found.of(ground.terrain).rims, -1
        self._shares = Remembered[Bytes]()
        self.images, self.bents = (
            at_once(sending_carpet(canvas.ctx, stock.growths)),
            bent_texture(canvas.ctx, stock.bents(())),
        )
        self._staged: tuple[CarpetStock, moderngl.TextureArray] | None = None
        """The next stock and its images, already in GL."""
        self.air = Air(canvas, side, ground.patch)
        self._heard: tuple[Viewer, int, CarpetKept] | None = None
        """The viewer, the number of the first receiver, and the receivers that `hear` serves."""
        self.ground = GroundPainter(
            canvas.ctx, canvas.block, stock, canvas.units, side=side, seed=canvas.seed, coarse=coarse
        )

    def texts(self) -> Iterator[Texts]:
        """Return the sources of the programs that are not made yet."""
        return self.ground.texts()

    def making(self) -> Iterator[None]:
        """Make the programs that are not made yet, one at a time."""
        return self.ground.making()

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Draw on this ground from now on, with each kind's progress towards what it is to become."""
        if grown.came != self._came:
            self._come(grown.came)
        self._ground, self._tallest = grown.ground, grown.tallest
        self._spacing = finest_spacing(grown.ground.terrain, grown.ground.patch)

    def fits(self, representation: Any, /) -> bool:
        """Return whether the programs can draw another representation's stock too."""
        return self.ground.fits(representation.stock)

    def staging(self, stocks: Mapping[str, Any], /) -> Iterator[None]:
        """Upload the images of another stock, a piece at a time, while the present one is drawn."""
        self._release_staged()
        stock = stocks["carpet"].stock
        self._staged = stock, (yield from sending_carpet(self.images.ctx, stock.growths))

    def restock(self) -> None:
        """Draw the stock that was staged."""
        assert self._staged is not None
        self.images.release()
        (stock, self.images), self._staged = self._staged, None
        self.ground.restock(stock)
        self._come(())

    def _come(self, came: tuple[float, ...]) -> None:
        self._came = came
        self.ground.come(came)
        self.bents.write(self.ground.stock.bents(came))

    def making_for_winds(self) -> Iterator[None]:
        """Make the programs that compute the wind's messages to receivers, one at a time."""
        yield from self.air.hearing.making()
        yield from self.air.hearing_far.making()

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Draw with every program, as if grass were trodden and ended somewhere."""
        self.ground.rehearse()

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return the number of patches, each with one receiver."""
        return [len(outlook.patches.progress)]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Upload the tiles of the ground and the carpet's share of each patch; return 0, as it has no blades."""
        self.lay(outlook, outlook.appearance.cover[-1])
        self.ground.tread(is_trodden=bool(outlook.noted(Trodden, UNTRODDEN)))
        self._heard = outlook.viewer, first["carpet"][0], outlook.keeps(CarpetKept)
        return 0

    def hear(self) -> int:
        """Compute the wind's messages at the middles of all patches; return the number of draw calls."""
        if self._heard is None:
            return 0
        viewer, first, kept = self._heard
        calls = self.air.hear(viewer, first)
        for row, message in kept.receiving[0].messages.written():
            self.air.write(row, message[0])
        return calls + self.air.average()

    def heard(self) -> Air:
        """Return the messages at the patches around the viewer."""
        return self.air

    def lay(self, outlook: Outlook, cover: Floats | None, /) -> None:
        """Upload the tiles of the ground and the carpet's share of each patch.

        `cover` (rows,) is the carpet's cover; with None there is no carpet on the terrain. Beyond the terrain's edge
        the carpet is whole; where a game has taken the grass away, there is none.
        """
        patches, viewer = outlook.patches, outlook.viewer
        self._follow_rims()
        shares_made_of = cover, patches.alive, patches.grows, viewer.centre
        shares = self._shares.of(viewer.name, shares_made_of, partial(_shares, patches, cover))
        in_view = patches.near & patches.alive & (shares > 0)
        carpeted = None if cover is None else in_view.reshape(patches.side, patches.side)
        asked = outlook.noted(Asked, Asked())
        goes_on = "beyond" in asked.parts
        mown = outlook.noted(Mown, None)
        made_of = (
            self._ground,
            viewer.eye,
            viewer.cone,
            viewer.centre,
            carpeted,
            goes_on,
            *self._changes(mown),
            *self._windows,
        )
        shelf = self.ground.shelves.of(viewer.name, outlook)
        tiles = self._seen.of(
            viewer.name,
            made_of,
            partial(self._tiles, viewer, carpeted, mown, goes_on=goes_on),
        )
        if tiles is not shelf.tiles:
            self.ground.write(tiles)
        if shares is not shelf.sent_shares:
            self.ground.write_shares(shares)
        self.ground.look_from(viewer, beyond=float(cover is not None))

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth at which the carpet stops light from a place [m]; return the number of draw calls."""
        return self.ground.cast(light)

    def _tiles(self, viewer: Viewer, carpeted: Mask | None, mown: Mown | None, *, goes_on: bool) -> ByLayer:
        """Return the tiles that a viewer sees, by layer.

        `carpeted` (side, side) tells which patches around the viewer have carpet; with None, there is none on the
        terrain. Tiles beyond the terrain are left out unless the ground `goes_on` there.
        """
        around = self._tiles_around(viewer)
        seen = which_seen(around, viewer.eye, viewer.cone)
        tiles = records_of(around, seen)
        if not goes_on:
            meets = meets_terrain(tiles, self._ground.terrain)
            tiles, seen = tiles[meets], seen[meets]
        bare = on_terrain(tiles, self._ground.terrain)
        if carpeted is not None:
            bare &= bare_within(tiles, carpeted, viewer.centre, patch=self._ground.patch, reach=self._reach)
        return by_layer(tiles, ~bare, self._find_edges(around, viewer, mown).take(seen), viewer.eye)

    def _find_edges(self, around: Tiles, viewer: Viewer, mown: Mown | None) -> PieceEdges:
        """Return which pieces of the tiles all around have edges; remembered until tiles or edges change."""
        touches = partial(self._edges.touch, self._ground, mown, self._tallest)
        offset = RIM_OFFSET if self._rims.any else 0.0
        make = partial(find_edges, around, touches, stride=self.ground.stride, offset=offset)
        return self._piece_edges.of(viewer.name, (around, self._ground, *self._changes(mown), offset), make)

    def _changes(self, mown: Mown | None) -> tuple[int, int, int]:
        """Return the numbers of changes that may move edges: by cutting, by sowing and clearing, and by digging."""
        terrain = self._ground.terrain
        dug = 0 if terrain.holes is None else terrain.changes.count
        return 0 if mown is None else mown.strokes, self._ground.density.sown.count, dug

    def _tiles_around(self, viewer: Viewer) -> Tiles:
        """Return the tiles all around; remembered until the eye has moved by about `STEP`."""
        step, terrain = STEP * self._spacing * GRID, self._ground.terrain
        place = round(viewer.eye[0] / step) * step, round(viewer.eye[2] / step) * step
        rims = self._rims if self._rims.any else None
        make = partial(
            tiles_around,
            terrain,
            place,
            spacing=self._spacing,
            about=step * HALF_DIAGONAL,
            rims=rims,
            quartered=self.ground.stride > 1,
        )
        return self._around.of(viewer.name, (self._ground, place, *self._windows), make)

    @property
    def _windows(self) -> tuple[object, ...]:
        """Identifies the terrain's window of its ground, and the rims known of it."""
        return self._rims, self._rims.version, self._ground.terrain.changes.moves

    def _follow_rims(self) -> None:
        """Follow the terrain's changes and, once its heights are uploaded, its moves to other windows of its ground."""
        terrain = self._ground.terrain
        if terrain is not self._rims.terrain or not self._rims.begin_at(self._block.record["terrain_origin"][0]):
            self._rims, self._rims_sent = Found.of(terrain).rims, -1
        self._rims.follow()
        if self._rims_sent != self._rims.version:
            self._rims_sent = self._rims.version
            self.ground.write_rims(self._rims.distance)

    def draw_ground(self, *, alone: bool) -> int:
        """Draw the bare ground, if `alone` also where carpet will lie; return the number of draw calls."""
        self.air.use()
        return self.ground.draw_bare(alone=alone)

    def draw_solid(self) -> int:
        """Draw the opaque layer under the carpet; return the number of draw calls."""
        self.air.use()
        return self.ground.draw_under()

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the carpet; return the number of draw calls."""
        return self._draw(target, WHOLE)

    def draw_dense(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the carpet where it covers at least half a pixel; return the number of draw calls."""
        return self._draw(target, DENSE)

    def draw_thin(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the rest of the carpet, which writes no depth; return the number of draw calls."""
        self.ground.write_outlined()
        set_depth_test(self.images.ctx, "<")  # dense carpet is there already, at equal depth
        calls = self._draw(target, THIN)
        set_depth_test(self.images.ctx, "<=")
        return calls

    def _draw(self, target: moderngl.Framebuffer, part: int) -> int:
        target.depth_mask = part != THIN
        self.images.use(self._units["images"])
        self.air.use()
        self.bents.use(self._units["bents"])
        calls = self.ground.draw_carpet(part)
        target.depth_mask = False
        return calls

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self.ground, self.air, self.images, self.bents)
        self._release_staged()

    def _release_staged(self) -> None:
        staged, self._staged = self._staged, None
        if staged is not None:
            staged[1].release()


def _shares(patches: PatchTable, cover: Floats | None) -> Bytes:
    """Return the carpet's share, of 255, for each row of the patch table, (rows,)."""
    whole = np.where(patches.alive, np.float32(0.0) if cover is None else cover, np.float32(1.0))
    return np.round(255.0 * np.where(patches.grows, whole, np.float32(0.0))).astype(np.uint8)
