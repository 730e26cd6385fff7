"""Painting blades: those on their way first, then all rings from far to near."""

import moderngl

from ....engine.declared.quality import Quality
from ....engine.gl.stream import release_all
from ...around.outlook import Outlook
from ...around.representation import Canvas
from ..strips.representation import StripRepresentation
from .draw import CORES, EDGES, BladePainter
from .gather import gather_blades
from .morph_draw import MorphPainter
from .pool import BladesKept
from .shown import BladesShown

PARTED = 1
"""Distance up to which blades hide one another by depth [patch sides]."""


class BladesPainter:
    """Draws the blades of all rings, and those on their way to their strips."""

    def __init__(self, canvas: Canvas, strips: StripRepresentation, quality: Quality) -> None:
        rings, near = quality.blade_rings, PARTED * quality.patch
        self.rings = [
            BladePainter(
                canvas.ctx, canvas.block, fine.segments, canvas.units, soft=True, coarser=coarse.segments, near=near
            )
            for fine, coarse in zip(rings, rings[1:] + rings[-1:], strict=True)
        ]
        self._parted = 1 + sum(ring.to < PARTED for ring in rings[:-1])
        self.morph = MorphPainter(canvas, strips, quality)

    def write(self, outlook: Outlook, /) -> int:
        """Send the blades that are shown; return how many."""
        kept: BladesKept = outlook.kept["blades"]
        shown: BladesShown = outlook.shown["blades"]
        eye = outlook.viewer.eye[0], outlook.viewer.eye[2]
        for ring, painter in zip(shown.rings, self.rings, strict=True):
            painter.write(*gather_blades(kept.pool, ring, eye=eye))
        moving = self.morph.write(outlook, kept.pool, shown.morphing)
        return moving + sum(painter.blades.count for painter in self.rings)

    def draw_solid(self) -> int:
        """Draw nothing: blades come after all that is coarser."""
        return 0

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw all blades; return the number of draw calls."""
        calls = self.morph.draw()
        near, far = self.rings[: self._parted], self.rings[self._parted :]
        calls += sum(painter.draw() for painter in reversed(far))
        # Around the viewer no order is right for every direction: there blades are parted by depth, and then edged.
        target.depth_mask = True
        calls += sum(painter.draw(CORES) for painter in near)
        target.depth_mask = False
        return calls + sum(painter.draw(EDGES) for painter in reversed(near))

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.rings, self.morph)
