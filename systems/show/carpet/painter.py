"""Painting the carpet, and the ground under everything."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Floats
from ....components.viewer import Viewer
from ....engine.gl.guest import set_depth_test
from ....engine.gl.remembered import Remembered
from ....engine.gl.shaders import Texts
from ....engine.gl.stream import release_all
from ...around.appearance import border_width
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
from .ground import DENSE, OUTLINE, RAISED, THIN, WHOLE, GroundPainter
from .pieces import ByLayer, Parted, by_layer, part, whole
from .pool import CarpetKept
from .stock import CarpetStock
from .textures import bent_texture, carpet_texture, sending_carpet
from .tiles import (
    GRID,
    Tiles,
    finest_spacing,
    ground_tiles,
    meets_terrain,
    on_terrain,
    records_of,
    tiles_around,
    which_seen,
    within,
)

AT_RIMS = 1.0
"""How far grid points are from their places at rims of cliffs at most, where they are farthest apart [grid points]."""

STEP = 0.4
"""How far the eye goes before tiles are chosen anew, in sides of the finest."""


class CarpetPainter(RepresentationPainter):
    """Draws the ground and the carpet on it."""

    def __init__(self, canvas: Canvas, stock: CarpetStock, ground: Ground, side: int, *, coarse: bool = False) -> None:
        self._ground, self._spacing = ground, finest_spacing(ground.terrain, ground.patch)
        self._whole_to = canvas.reach[-2] - int(border_width(canvas.reach[-2])) - 1
        self._units = canvas.units
        self._around, self._seen = Remembered[Tiles](), Remembered[ByLayer]()
        self._parted = Remembered[Parted]()
        self._edges, self._tallest = Edges(), 0.0
        self._rims, self._rims_sent = Found.of(ground.terrain).rims, -1
        self._laid = Remembered[Bytes]()
        self.images, self.bents = carpet_texture(canvas.ctx, stock.growths), bent_texture(canvas.ctx, stock.bents(()))
        self._beside: tuple[CarpetStock, moderngl.TextureArray] | None = None
        """What is brought into GL beside its own."""
        self._came: tuple[float, ...] = ()
        self.air = Air(canvas, side)
        self._deep = False
        """Whether it writes depth only where it covers at least half a pixel."""
        self._heard: tuple[NDArray[np.int32], int, CarpetKept] | None = None
        self.ground = GroundPainter(
            canvas.ctx, canvas.block, stock, canvas.units, side=side, seed=canvas.seed, coarse=coarse
        )

    def texts(self) -> Iterator[Texts]:
        """Return what the programs that are not there yet are made of."""
        return self.ground.texts()

    def making(self) -> Iterator[None]:
        """Make the programs that are not there yet, one at a time."""
        return self.ground.making()

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Draw on this ground from now on, with as much of each kind as has become what it is to be."""
        if grown.came != self._came:
            self._come(grown.came)
        terrain = grown.ground.terrain
        if terrain is not self._rims.terrain or not self._rims.lie_over(record["terrain_origin"][0]):
            self._rims, self._rims_sent = Found.of(terrain).rims, -1
        self._ground, self._tallest = grown.ground, grown.tallest
        self._spacing = finest_spacing(grown.ground.terrain, grown.ground.patch)

    def fits(self, representation: Any, /) -> bool:
        """Return whether its programs draw the images of another stock too."""
        return self.ground.fits(representation.stock)

    def staging(self, stocks: Sequence[Any], /) -> Iterator[None]:
        """Bring the images of another stock into GL beside its own."""
        made = next(each for each in stocks if each.name == "carpet")
        images = yield from sending_carpet(self.images.ctx, made.stock.growths)
        self._beside = made.stock, images

    def restock(self) -> None:
        """Draw what was staged."""
        assert self._beside is not None
        self.images.release()
        (stock, self.images), self._beside = self._beside, None
        self.ground.restock(stock)
        self._come(())

    def _come(self, came: tuple[float, ...]) -> None:
        self._came = came
        self.ground.come(came)
        self.bents.write(self.ground.stock.bents(came))

    def making_for_winds(self) -> Iterator[None]:
        """Make the programs by which receivers hear whatever winds will blow, one at a time."""
        return self.air.hearing.making()

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that somebody treads it, and that grass ends somewhere."""
        del record
        self.ground.rehearse()

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return how many patches there are."""
        return [len(outlook.patches.progress)]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Send the tiles of the ground, and how much carpet lies on each patch; it has no blades."""
        assert outlook.appearance is not None
        self.lay(outlook, outlook.appearance.cover[-1])
        self.ground.tread(is_trodden=bool(outlook.noted(Trodden, UNTRODDEN)))
        self._heard = outlook.viewer.centre, first["carpet"][0], outlook.keeps(CarpetKept)
        return 0

    def hear(self) -> int:
        """Let the middles of all patches hear the wind; return the number of draw calls."""
        if self._heard is None:
            return 0
        centre, first, kept = self._heard
        calls = self.air.hear(centre, first)
        for row, message in kept.receiving[0].letters.written():
            self.air.write(row, message[0])
        return calls + self.air.sum_up()

    def heard(self) -> Air:
        """Return what the patches around the viewer have heard."""
        return self.air

    def lay(self, outlook: Outlook, cover: Floats | None, /) -> None:
        """Send the tiles of the ground, and how much carpet lies on each patch.

        `cover` has shape (rows,); without it there is none on the terrain. Beyond the terrain's edge it is whole, where
        a game has taken the grass away there is none.
        """
        patches, viewer = outlook.patches, outlook.viewer
        self._follow_rims()
        bare_to = self._bare_to(patches, cover)
        asked = outlook.noted(Asked, Asked())
        goes_on, self._deep = "beyond" in asked.parts, asked.is_deep
        mown = outlook.noted(Mown, None)
        made_of = (
            self._ground,
            viewer.eye,
            viewer.cone,
            viewer.centre,
            cover is None,
            bare_to,
            goes_on,
            *self._changes(mown),
            *self._windows,
        )
        shelf = self.ground.shelves.of(viewer.name, outlook)
        tiles = self._seen.of(
            viewer.name,
            made_of,
            partial(self._tiles, viewer, None if cover is None else bare_to, mown, goes_on=goes_on),
        )
        if tiles is not shelf.tiles:
            self.ground.write(tiles)
        laid = cover, patches.alive, patches.grows, viewer.centre
        shares = self._laid.of(viewer.name, laid, partial(_shares, patches, cover))
        if shares is not shelf.shown:
            self.ground.write_shares(shares)
        self.ground.look_from(viewer, beyond=float(cover is not None))

    def cast(self, light: tuple[float, float, float], /) -> int:
        """Write the depth at which grass stops light from a place [m]; return the number of draw calls."""
        return self.ground.cast(light)

    def _tiles(self, viewer: Viewer, bare_to: int | None, mown: Mown | None, *, goes_on: bool) -> ByLayer:
        """Return the tiles that a viewer sees, by layer.

        Up to the discrete distance `bare_to` there is no carpet on the terrain; None is everywhere. Tiles beyond the
        terrain are left out unless ground `goes_on` there.
        """
        around = self._tiles_around(viewer)
        seen = which_seen(around, viewer.eye, viewer.cone)
        tiles = records_of(around, seen)
        if not goes_on:
            meets = meets_terrain(tiles, self._ground.terrain)
            tiles, seen = tiles[meets], seen[meets]
        bare = on_terrain(tiles, self._ground.terrain)
        if bare_to is not None:
            bare &= within(tiles, viewer.centre, patch=self._ground.patch, reach=bare_to)
        return by_layer(tiles, ~bare, self._parted_by(around, viewer, mown).of(seen), viewer.eye)

    def _parted_by(self, around: Tiles, viewer: Viewer, mown: Mown | None) -> Parted:
        """Return which pieces of the tiles all around have edges: the same as long as these and the edges are."""
        touches = partial(self._edges.at, self._ground, mown, self._tallest)
        wider, off = self.ground.wider, AT_RIMS if self._rims.any else 0.0
        make = partial(part, around, touches, wider=wider, off=off)
        return self._parted.of(viewer.name, (around, self._ground, *self._changes(mown), off), make)

    def _changes(self, mown: Mown | None) -> tuple[int, int, int]:
        """Return how often edges may have changed: by cutting, by sowing and clearing, and by digging."""
        terrain = self._ground.terrain
        dug = 0 if terrain.holes is None else terrain.changes.count
        return 0 if mown is None else mown.strokes, self._ground.density.sown.count, dug

    def _tiles_around(self, viewer: Viewer) -> Tiles:
        """Return the tiles all around: the same as long as the eye stays about where it is."""
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
            parted=self.ground.wider > 1,
        )
        return self._around.of(viewer.name, (self._ground, place, *self._windows), make)

    @property
    def _windows(self) -> tuple[object, ...]:
        """What tells apart which part of a ground is there, and which rims are known of it."""
        return self._rims, self._rims.version, self._ground.terrain.changes.moves

    def _follow_rims(self) -> None:
        self._rims.follow()
        if self._rims_sent != self._rims.version:
            self._rims_sent = self._rims.version
            self.ground.write_rims(self._rims.far)

    def _bare_to(self, patches: PatchTable, cover: Floats | None) -> int:
        """Return the discrete distance up to which there is no carpet: it is nearer than always while ranges are."""
        if cover is None:
            return self._whole_to
        seen = patches.alive & patches.near & (cover > 0.0)
        nearest = patches.distance.min(where=seen, initial=self._whole_to + 1)
        return int(nearest) - 1

    def lay_everywhere(self, outlook: Outlook, /, *, height: float) -> None:
        """Send a carpet that lies everywhere, at this part of the height of the grass."""
        viewer, rims = outlook.viewer, self._rims if self._rims.any else None
        tiles = ground_tiles(self._ground.terrain, viewer.eye, viewer.cone, spacing=self._spacing, rims=rims)
        self.ground.write(by_layer(tiles, np.ones(len(tiles), np.bool_), whole(tiles), viewer.eye))
        everywhere = np.full(len(outlook.patches.progress), 255, np.uint8)
        self.ground.write_shares(everywhere)
        self.ground.look_from(viewer, beyond=1.0)
        self.ground.raise_carpet(height)

    def lay_as_always(self) -> None:
        """Lay the carpet at its own height again."""
        self.ground.raise_carpet(RAISED, outline=OUTLINE)

    def draw_ground(self, *, alone: bool) -> int:
        """Draw the bare ground, where it comes `alone` that of the carpet too; return the number of draw calls."""
        self.air.use()
        return self.ground.draw_bare(alone=alone)

    def draw_solid(self) -> int:
        """Draw what lies under the carpet; return the number of draw calls."""
        self.air.use()
        return self.ground.draw_under()

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the carpet; return the number of draw calls."""
        if self._deep:
            return self.draw_dense(target) + self.draw_thin(target)
        return self._draw(target, WHOLE)

    def draw_dense(self, target: moderngl.Framebuffer, /) -> int:
        """Draw it where it covers at least half a pixel; return the number of draw calls."""
        return self._draw(target, DENSE)

    def draw_thin(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the rest, which writes no depth; return the number of draw calls."""
        self.ground.write_outlined()
        set_depth_test(self.images.ctx, "<")  # where it is dense, it is itself in the way
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
        """Give everything back."""
        release_all(self.ground, self.air, self.images, self.bents)
        if self._beside is not None:
            self._beside[1].release()


def _shares(patches: PatchTable, cover: Floats | None) -> Bytes:
    """Return how much carpet lies on each row of the patch table, of 255, shape (rows,)."""
    whole = np.where(patches.alive, np.float32(0.0) if cover is None else cover, np.float32(1.0))
    return np.round(255.0 * np.where(patches.grows, whole, np.float32(0.0))).astype(np.uint8)
