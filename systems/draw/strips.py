"""Drawing 2.5D strips: one instanced draw per ring, back to front."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.growth import Strips
from ...components.quality import StripRing
from ...engine.gl.stream import Stream, release_all
from .frame import FrameBlock, by_kind, joined
from .textures import strip_textures

STRIP = np.dtype(
    [
        ("a", "3f4"),
        ("b", "3f4"),
        ("wind", "4f4"),
        ("u", "2f4"),
        ("layer", "f4"),
        ("kind", "f4"),
        ("turn", "f4"),
        ("fade", "f4"),
    ]
)
"""A polygon strip: the feet of its two edges [m], their messages, its span of the texture, layer, kind, the patch's
quarter turns, and how much it shows. The field names are the shader's attributes."""


class StripPainter:
    """Draws the strips of one ring; it owns the ring's textures."""

    def __init__(
        self,
        ctx: moderngl.Context,
        block: FrameBlock,
        ring: StripRing,
        stock: list[list[Strips]],
        units: dict[str, int],
    ) -> None:
        self.sections = ring.sections
        self.units = units
        self.atlas, self.ranks = strip_textures(ctx, stock)
        self.stream = Stream(ctx, STRIP)
        whole, thin = {"SECTIONS": ring.sections}, {"SECTIONS": ring.sections, "THIN": 1}
        self.programs = [joined(ctx, block, units, "strips.vert", "strips.frag", defines) for defines in (whole, thin)]
        kinds = [models[0] for models in stock]
        for made in self.programs:
            made["tall"] = by_kind([strips.height for strips in kinds])
            made["wide_to"] = by_kind([strips.texels.shape[3] / self.atlas.width for strips in kinds])
            made["high_to"] = by_kind([strips.texels.shape[2] / self.atlas.height for strips in kinds])
        self.arrays = [ctx.vertex_array(made, [self.stream.binding(made)]) for made in self.programs]
        self.thin = False

    def write(self, strips: NDArray[np.void], *, thin: bool) -> None:
        """Send the ring's polygon strips (n,), far to near; `thin` says that a kind grows thinly on some of them."""
        self.stream.write(strips)
        self.thin = thin

    def draw(self) -> int:
        """Draw what was written; return the number of draw calls."""
        if not self.stream.count:
            return 0
        self.atlas.use(self.units["atlas"])
        self.ranks.use(self.units["ranks"])
        self.arrays[self.thin].render(
            moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=self.stream.count
        )
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.arrays, *self.programs, self.stream, self.atlas, self.ranks)
