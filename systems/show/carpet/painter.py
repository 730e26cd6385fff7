"""Painting the carpet, and the ground under everything."""

from collections.abc import Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ....engine.gl.stream import release_all
from ....engine.gl.unchanged import Unchanged
from ...around.appearance import border_of
from ...around.outlook import Outlook
from ...around.patches import PatchTable
from ...grow.record import Growth
from ...space.cone import HALF_DIAGONAL
from ...space.ground import Ground
from ..representation import Canvas
from .air import Air
from .ground import (
    GRID,
    OUTLINE,
    RAISED,
    GroundPainter,
    Tiles,
    finest_spacing,
    ground_tiles,
    on_terrain,
    tiles_around,
    tiles_seen,
    within,
)
from .pool import CarpetKept
from .textures import carpet_texture

STEP = 0.4
"""How far the eye goes before tiles are chosen anew, in sides of the finest."""


class CarpetPainter:
    """Draws the ground and the carpet on it."""

    def __init__(self, canvas: Canvas, growths: Sequence[Growth], ground: Ground, side: int) -> None:
        self.stand_on(ground)
        self._whole_to = canvas.reach[-2] - int(border_of(canvas.reach[-2])) - 1
        self._units = canvas.units
        self._unchanged, self._stays = Unchanged(), Unchanged()
        self._tiles: Tiles = np.zeros((0, 4))
        self.images = carpet_texture(canvas.ctx, growths)
        self.air = Air(canvas, side)
        self._heard: tuple[NDArray[np.int32], int, CarpetKept] | None = None
        self.ground = GroundPainter(canvas.ctx, canvas.block, growths, canvas.units, side=side, seed=canvas.seed)

    def stand_on(self, ground: Ground, /) -> None:
        """Draw on this ground from now on."""
        self._ground = ground
        self._spacing = finest_spacing(ground.terrain, ground.patch)

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return how many patches there are."""
        return [len(outlook.patches.progress)]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Send the tiles of the ground, and how much carpet lies on each patch; it has no blades."""
        assert outlook.appearance is not None
        self.lay(outlook, outlook.appearance.cover[-1])
        self.ground.is_trodden = bool(outlook.trodden)
        self._heard = outlook.viewer.centre, first["carpet"][0], outlook.kept["carpet"]
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

    def lay(self, outlook: Outlook, cover: Floats | None, /) -> None:
        """Send the tiles of the ground, and how much carpet lies on each patch.

        `cover` has shape (rows,); without it there is none on the terrain. Beyond the terrain's edge it is whole, where
        a game has taken the grass away there is none.
        """
        patches, viewer = outlook.patches, outlook.viewer
        bare_to = self._bare_to(patches, cover)
        if not self._unchanged.since(self._ground, viewer.eye, viewer.cone, viewer.centre, cover is None, bare_to):
            tiles = tiles_seen(self._tiles_around(viewer.eye), viewer.eye, viewer.cone)
            bare = on_terrain(tiles, self._ground.terrain)
            if cover is not None:
                bare &= within(tiles, viewer.centre, patch=self._ground.patch, reach=bare_to)
            self.ground.write(tiles, ~bare)
        whole = np.where(patches.alive, np.float32(0.0) if cover is None else cover, np.float32(1.0))
        self.ground.write_shares(
            np.where(patches.grows, whole, np.float32(0.0)), viewer.centre, beyond=float(cover is not None)
        )

    def _tiles_around(self, eye: tuple[float, float, float]) -> Tiles:
        """Return the tiles all around: the same as long as the eye stays about where it is."""
        step = STEP * self._spacing * GRID
        place = round(eye[0] / step) * step, round(eye[2] / step) * step
        if not self._stays.since(self._ground, place):
            self._tiles = tiles_around(self._ground.terrain, place, spacing=self._spacing, about=step * HALF_DIAGONAL)
        return self._tiles

    def _bare_to(self, patches: PatchTable, cover: Floats | None) -> int:
        """Return the discrete distance up to which there is no carpet: it is nearer than always while ranges are."""
        if cover is None:
            return self._whole_to
        seen = patches.alive & patches.near & (cover > 0.0)
        nearest = patches.distance.min(where=seen, initial=self._whole_to + 1)
        return int(nearest) - 1

    def lay_everywhere(self, outlook: Outlook, /, *, height: float) -> None:
        """Send a carpet that lies everywhere, at this part of the height of the grass."""
        tiles = ground_tiles(self._ground.terrain, outlook.viewer.eye, outlook.viewer.cone, spacing=self._spacing)
        self.ground.write(tiles, np.ones(len(tiles), np.bool_))
        self._unchanged.since()
        self.ground.write_shares(np.ones(len(outlook.patches.progress), np.float32), outlook.viewer.centre, beyond=1.0)
        self.ground.raise_carpet(height)

    def lay_as_always(self) -> None:
        """Lay the carpet at its own height again."""
        self.ground.raise_carpet(RAISED, outline=OUTLINE)

    def draw_solid(self) -> int:
        """Draw the bare ground, and what lies under the carpet; return the number of draw calls."""
        self.air.use()
        return self.ground.draw_opaque()

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the carpet; return the number of draw calls."""
        target.depth_mask = True
        self.images.use(self._units["images"])
        calls = self.ground.draw_carpet()
        target.depth_mask = False
        return calls

    def release(self) -> None:
        """Give everything back."""
        release_all(self.ground, self.air, self.images)
