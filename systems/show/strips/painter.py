"""Painting strips: all rings in one far-to-near order."""

from collections.abc import Sequence

import moderngl

from ....engine.declared.quality import Quality
from ....engine.gl.stream import release_all
from ...around.outlook import Outlook
from ...around.representation import Canvas
from ...grow.record import Growth
from .draw import StripPainter
from .gather import gather_strips, runs
from .pool import StripsKept
from .shown import StripsShown
from .textures import strip_stock

WHOLE = 0.995
"""Density from which on no blade of a kind is missing."""


class StripsPainter:
    """Draws the strips of all rings, in runs of patches of one ring from far to near."""

    def __init__(self, canvas: Canvas, growths: Sequence[Growth], quality: Quality) -> None:
        self._fade = canvas.transitions.fade
        self.rings = [
            StripPainter(canvas.ctx, canvas.block, ring, strip_stock(growths, number), canvas.units)
            for number, ring in enumerate(quality.strip_rings)
        ]
        self.runs: list[tuple[int, int, int, bool]] = []

    def write(self, outlook: Outlook, /) -> int:
        """Send the strips that are shown; they are no blades."""
        kept: StripsKept = outlook.kept["strips"]
        shown: StripsShown = outlook.shown["strips"]
        patches, centre, appears = outlook.patches, outlook.viewer.centre, outlook.appearance
        assert appears is not None
        counts, thin = [], []
        for pool, ring, painter in zip(kept.pools, shown.rings, self.rings, strict=True):
            thin.append(bool((pool.least[ring.slots] < WHOLE).any()))
            records, count = gather_strips(pool, ring, appears, patches, centre, fade=self._fade)
            painter.write(records)
            counts.append(count)
        self.runs = runs(shown.rings, counts, thin)
        return 0

    def draw_solid(self) -> int:
        """Draw nothing: strips are blended."""
        return 0

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw all runs; return the number of draw calls."""
        del target
        return sum(self.rings[ring].draw(first, count, thin=thin) for ring, first, count, thin in self.runs)

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.rings)
