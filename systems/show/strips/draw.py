"""Drawing 2.5D strips, back to front: an instanced draw for each run of patches of one ring."""

from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.declared.quality import StripRing
from ....engine.gl.records import Records
from ....engine.gl.stream import release_all
from ...frame.block import FrameBlock, by_kind, joined
from .grow import Strips
from .textures import strip_textures

STRIP = np.dtype(
    [
        ("a", "3f4"),
        ("b", "3f4"),
        ("wind", "4f4"),
        ("layer", "f4"),
        ("kind", "f4"),
        ("turn", "f4"),
        ("fade", "f4"),
        ("growth", "f4"),
        ("ranks", "f4"),
    ]
)
"""A polygon strip: the feet of its two edges [m], their messages, layer, kind, the patch's quarter turns, how much it
shows, and how high it stands, of its full height. It shows the blades whose rank is below `ranks`, or where that is
negative those whose rank is not below -`ranks`. The shader reads it as four texels."""

PER_ROW = 16
"""Records in a row of the texture that holds them."""


class StripPainter:
    """Draws the strips of one ring; it owns the ring's textures."""

    def __init__(
        self,
        ctx: moderngl.Context,
        block: FrameBlock,
        ring: StripRing,
        stock: list[list[Strips]],
        units: Mapping[str, int],
    ) -> None:
        self.sections, self.columns = ring.sections, ring.columns
        self.units = units
        self.atlas, self.ranks = strip_textures(ctx, stock)
        self.strips = Records(ctx, STRIP, PER_ROW, rows=1024)
        whole = {"SECTIONS": ring.sections, "COLUMNS": ring.columns, "PER_ROW": PER_ROW}
        thin = {**whole, "THIN": 1}
        self.programs = [
            joined(ctx, block, units, "systems/show/strips/strips.vert", "systems/show/strips/strips.frag", defines)
            for defines in (whole, thin)
        ]
        kinds = [models[0] for models in stock]
        for made in self.programs:
            made["tall"] = by_kind([strips.height for strips in kinds])
            made["wide_to"] = by_kind([strips.texels.shape[3] / self.atlas.width for strips in kinds])
            made["high_to"] = by_kind([strips.texels.shape[2] / self.atlas.height for strips in kinds])
        self.arrays = [ctx.vertex_array(made, []) for made in self.programs]

    def write(self, strips: NDArray[np.void]) -> None:
        """Send the ring's polygon strips (n,), far to near."""
        self.strips.write(strips)

    def draw(self, first: int, count: int, *, thin: bool) -> int:
        """Draw `count` of what was written, from the `first` on; return the number of draw calls.

        With `thin`, blades are drawn by rank: only those that the density and the strip's `ranks` leave.
        """
        if not count:
            return 0
        self.atlas.use(self.units["atlas"])
        self.ranks.use(self.units["ranks"])
        self.strips.texture.use(self.units["strips"])
        self.programs[thin]["first"] = first
        self.arrays[thin].render(moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=count)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.arrays, *self.programs, self.strips, self.atlas, self.ranks)
