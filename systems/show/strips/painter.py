"""Painting strips: all rings in one far-to-near order."""

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.declared.quality import Quality
from ...around.outlook import Outlook
from ...around.representation import Canvas
from ...grow.record import Growth
from .draw import StripPainter
from .gather import gather_strips, in_one_queue, runs
from .pool import StripsKept
from .shown import StripsShown
from .textures import strip_stock

WHOLE = 0.995
"""Density from which on no blade of a kind is missing."""


class StripsPainter:
    """Draws the strips of all rings from far to near."""

    def __init__(self, canvas: Canvas, growths: Sequence[Growth], quality: Quality) -> None:
        self._fade = canvas.transitions.fade
        rings = quality.strip_rings
        self.strips = StripPainter(canvas, rings, [strip_stock(growths, number) for number in range(len(rings))])
        self.runs: list[tuple[int, int, bool]] = []

    def write(self, outlook: Outlook, /) -> int:
        """Send the strips that are shown; they are no blades."""
        kept: StripsKept = outlook.kept["strips"]
        shown: StripsShown = outlook.shown["strips"]
        patches, centre, appears = outlook.patches, outlook.viewer.centre, outlook.appearance
        assert appears is not None
        gathered = [
            gather_strips(
                pool, ring, appears, patches, centre,
                ring=number, first_layer=int(self.strips.first_layer[number]), fade=self._fade,
            )
            for number, (pool, ring) in enumerate(zip(kept.pools, shown.rings, strict=True))
        ]  # fmt: skip
        records, amount = in_one_queue(shown.rings, gathered)
        self.strips.write(records)
        self.runs = runs(_ranked(kept, shown), amount)
        return 0

    def draw_solid(self) -> int:
        """Draw nothing: strips are blended."""
        return 0

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw all runs; return the number of draw calls."""
        del target
        return sum(self.strips.draw(first, count, thin=thin) for first, count, thin in self.runs)

    def release(self) -> None:
        """Give everything back."""
        self.strips.release()


def _ranked(kept: StripsKept, shown: StripsShown) -> NDArray[np.bool_]:
    """Return which patches have to be drawn by rank, from far to near: some of their blades do not show.

    Where grass is thin anywhere in a ring, all of the ring is.
    """
    place = np.concatenate([ring.queue for ring in shown.rings])
    ranked = [
        (pool.least[ring.slots] < WHOLE).any() | (ring.most < 1.0) | (ring.least > 0.0)
        for pool, ring in zip(kept.pools, shown.rings, strict=True)
    ]
    return np.concatenate(ranked)[np.argsort(place, kind="stable")]
