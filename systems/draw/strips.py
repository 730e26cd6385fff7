"""Drawing 2.5D strips, back to front: an instanced draw for each run of patches of one ring."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.growth import Strips
from ...components.quality import StripRing
from ...engine.gl.stream import release_all
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
quarter turns, and how much it shows. The shader reads it as four texels."""

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
        units: dict[str, int],
    ) -> None:
        self.sections = ring.sections
        self.units = units
        self.atlas, self.ranks = strip_textures(ctx, stock)
        self.ctx = ctx
        self.strips = self._room(1024)
        whole = {"SECTIONS": ring.sections, "PER_ROW": PER_ROW}
        thin = {**whole, "THIN": 1}
        self.programs = [joined(ctx, block, units, "strips.vert", "strips.frag", defines) for defines in (whole, thin)]
        kinds = [models[0] for models in stock]
        for made in self.programs:
            made["tall"] = by_kind([strips.height for strips in kinds])
            made["wide_to"] = by_kind([strips.texels.shape[3] / self.atlas.width for strips in kinds])
            made["high_to"] = by_kind([strips.texels.shape[2] / self.atlas.height for strips in kinds])
        self.arrays = [ctx.vertex_array(made, []) for made in self.programs]
        self.thin = False

    def write(self, strips: NDArray[np.void], *, thin: bool) -> None:
        """Send the ring's polygon strips (n,), far to near; `thin` says that a kind grows thinly on some of them."""
        rows = -(-len(strips) // PER_ROW)
        if rows > self.strips.height:
            self.strips.release()
            self.strips = self._room(rows * 3 // 2)
        if rows:
            padded = np.zeros(rows * PER_ROW, STRIP)
            padded[: len(strips)] = strips
            self.strips.write(padded, viewport=(0, 0, 4 * PER_ROW, rows))
        self.thin = thin

    def draw(self, first: int, count: int) -> int:
        """Draw `count` of what was written, from the `first` on; return the number of draw calls."""
        if not count:
            return 0
        self.atlas.use(self.units["atlas"])
        self.ranks.use(self.units["ranks"])
        self.strips.use(self.units["strips"])
        self.programs[self.thin]["first"] = first
        self.arrays[self.thin].render(moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=count)
        return 1

    def _room(self, rows: int) -> moderngl.Texture:
        texture = self.ctx.texture((4 * PER_ROW, rows), 4, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.arrays, *self.programs, self.strips, self.atlas, self.ranks)
