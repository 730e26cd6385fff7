"""Drawing 2.5D strips, back to front: those of all rings together."""

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.declared.quality import StripRing
from ....engine.gl.records import Records
from ....engine.gl.stream import release_all
from ...around.representation import Canvas
from ...frame.block import by_kind, joined
from .grow import Strips
from .textures import extent_texture, strip_texture

KINDS = 4
"""Kinds of grass that there is room for."""

STRIP = np.dtype(
    [
        ("a", "3f4"),
        ("b", "3f4"),
        ("wind", "4f4"),
        ("layer", "f4"),
        ("picture", "f4"),
        ("stand", "f4"),
        ("fade", "f4"),
        ("growth", "f4"),
        ("ranks", "f4"),
    ]
)
"""A polygon strip: the feet of its two edges [m], and their messages; the layer of its picture, and which picture;
how it stands; how much it shows, and how high it is, of its full height.

`picture` is `KINDS` times the ring, plus the kind; `stand` is four times the column, plus the patch's quarter turns.
The blades that show are those whose rank is below `ranks`, or where that is negative those whose rank is not below
-`ranks`. The shader reads a record as four texels."""

PER_ROW = 16
"""Records in a row of the texture that holds them."""


class StripPainter:
    """Draws the strips of all rings; it owns their textures.

    `stock` gives the strips by ring, kind and model.
    """

    def __init__(self, canvas: Canvas, rings: Sequence[StripRing], stock: Sequence[list[list[Strips]]]) -> None:
        self.units = canvas.units
        self.sections = max(ring.sections for ring in rings)
        self.atlas = strip_texture(canvas.ctx, stock)
        self.extents = extent_texture(canvas.ctx, stock, [ring.columns for ring in rings])
        layers = [sum(2 * len(strips.plane) for models in kinds for strips in models) for kinds in stock]
        self.first_layer = np.cumsum([0, *layers])
        self.strips = Records(canvas.ctx, STRIP, PER_ROW, rows=1024)
        whole: dict[str, str | int] = {
            "SECTIONS": self.sections,
            "RINGS": len(rings),
            "KINDS": KINDS,
            "PER_ROW": PER_ROW,
            "ATLAS": f"{self.atlas.height}.0",
        }
        self.programs = [
            joined(
                canvas.ctx, canvas.block, canvas.units, "systems/show/strips/strips.vert",
                "systems/show/strips/strips.frag", defines,
            )
            for defines in (whole, {**whole, "THIN": 1})
        ]  # fmt: skip
        for made in self.programs:
            made["tall"] = by_kind([models[0].height for models in stock[0]])
            # An array of one is no array to those that tell it to the card.
            fineness = [(ring.columns, ring.sections) for ring in rings]
            made["fineness"] = fineness if len(rings) > 1 else fineness[0]
            made["picture_to"] = self._picture_sizes(stock)
        self.arrays = [canvas.ctx.vertex_array(made, []) for made in self.programs]

    def _picture_sizes(self, stock: Sequence[list[list[Strips]]]) -> list[tuple[float, float]]:
        """Return how far each picture reaches across its layer and up, by ring and kind."""
        sizes = [(0.0, 0.0)] * (KINDS * len(stock))
        for ring, kinds in enumerate(stock):
            for kind, models in enumerate(kinds):
                rows, columns = models[0].texels.shape[2:4]
                sizes[KINDS * ring + kind] = columns / self.atlas.width, rows / self.atlas.height
        return sizes

    def write(self, strips: NDArray[np.void]) -> None:
        """Send the polygon strips (n,), far to near."""
        self.strips.write(strips)

    def draw(self, first: int, count: int, *, thin: bool) -> int:
        """Draw `count` of what was written, from the `first` on; return the number of draw calls.

        With `thin`, blades are drawn by rank: only those that the density and the strip's `ranks` leave.
        """
        if not count:
            return 0
        self.atlas.use(self.units["atlas"])
        self.extents.use(self.units["extents"])
        self.strips.texture.use(self.units["strips"])
        self.programs[thin]["first"] = first
        self.arrays[thin].render(moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=count)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.arrays, *self.programs, self.strips, self.atlas, self.extents)
