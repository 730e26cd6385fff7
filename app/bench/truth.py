"""The reference along a walk, drawn on demand: a whole picture, or a single tile."""

from typing import Self

from ...components.arrays import Floats
from ...systems.lod import farthest
from ...systems.prairie import Prairie
from ...systems.reference import cropped, draw_truth
from ...systems.room import room_for
from ..studio.encode import Picture
from ..studio.offscreen import Offscreen
from ..studio.studio import Studio
from ..studio.take import SAMPLES
from .flicker import TILE
from .stroll import Leg, Moment, advance_to, moments, raise_gusts

TINY = (16, 9)
"""Size of the picture that brings the prairie to an instant; it is thrown away [pixels]."""


class Truth:
    """Every blade of a studio's scene at the moments of a walk; they must be asked for in their order.

    A context manager, with a prairie of its own.
    """

    def __init__(self, studio: Studio, walk: list[Leg]) -> None:
        self._studio, take = studio, studio.take
        # Carpet alone brings the prairie to an instant: a reference plants its own blades on it.
        self._prairie = Prairie.load(take.scene, ctx=studio.ctx, preset=take.preset, lod="carpet", live=False)
        raise_gusts(self._prairie, walk)
        self._tiny = Offscreen(TINY, studio.ctx)
        self._at: Moment | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._prairie.release()
        self._tiny.release()

    def whole(self, moment: Moment) -> Picture:
        """Return a picture of every blade, as `--reference` draws it."""
        view, projection = self._go(moment)
        return draw_truth(self._prairie, view, projection, self._studio.take.size, samples=SAMPLES).picture

    def near(self, moment: Moment) -> Picture:
        """Return a reference of what changes on the leg: blades up to where strips end, and leaves of changing trees.

        Beyond lies the prairie's own carpet; other trees are its own imposters.
        """
        return self._near(moment, self._go(moment), self._studio.take.size)

    def tile(self, moment: Moment, corner: tuple[int, int]) -> Picture:
        """Return a tile of the picture `near`, and one pixel around it, shape (TILE + 2, TILE + 2, 3).

        `corner` is the column and row of the tile's first pixel, from the top left.
        """
        view, projection = self._go(moment)
        first, part = (corner[0] - 1, corner[1] - 1), (TILE + 2, TILE + 2)
        return self._near(moment, (view, cropped(projection, first, part, self._studio.take.size)), part)

    def _near(self, moment: Moment, matrices: tuple[Floats, Floats], size: tuple[int, int]) -> Picture:
        room = room_for(self._studio.prairie.site.reach, self._prairie.viewers["main"].lens.factor)
        reach = farthest(room)[-1]
        seen_at = tuple(each.camera.position for each in moments(self._prairie, moment.leg))
        return draw_truth(self._prairie, *matrices, size, samples=SAMPLES, reach=reach, seen_at=seen_at).picture

    def _go(self, moment: Moment) -> tuple[Floats, Floats]:
        matrices = self._studio.matrices(moment.camera)
        if self._at != moment:
            advance_to(self._prairie, moment.time)
            host = self._studio.ctx.detect_framebuffer()
            self._tiny.begin()
            self._prairie.draw(*matrices)
            host.use()
            self._at = moment
        return matrices
