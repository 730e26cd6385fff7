"""Drawing blades on their way between their own places and their painted places (paper, section 4.2)."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.declared.quality import Quality
from ....engine.gl.records import Records
from ....engine.gl.stream import Stream, release_all
from ...around.outlook import Outlook
from ...around.representation import Canvas
from ...frame.block import by_kind, joined
from ..strips.representation import StripRepresentation
from .draw import ROUND, SHADER_BLADE, WHOLE
from .morph import EDGE, MOVING, gather_morph
from .pool import BladePool
from .shown import Standing

PER_ROW = 64
"""Edges, and blades' targets, in a row of the textures that hold them."""


class MorphPainter:
    """Draws blades on their way, all in one instanced draw; it owns the painted places of all blades."""

    def __init__(self, canvas: Canvas, strips: StripRepresentation, quality: Quality) -> None:
        ctx, targets = canvas.ctx, strips.stock.targets
        points = targets.shape[3]
        self.strips = strips
        self.segments = quality.blade_rings[-1].segments
        self.units = canvas.units
        self.fade = canvas.transitions.fade
        defines: dict[str, str | int] = {"SEGMENTS": self.segments, "ROUND": ROUND, "SOFT": 1, "MORPH": 1}
        defines |= {"PER_ROW": PER_ROW, "POINTS": points}
        self.program = joined(
            ctx,
            canvas.block,
            canvas.units,
            "systems/show/blades/blades.vert",
            "systems/show/blades/blades.frag",
            defines,
        )
        self.program["tall"] = by_kind([strips.height for strips in strips.stock.strips[0]])
        self.program["part"] = WHOLE
        self.blades, self.moving = Stream(ctx, SHADER_BLADE), Stream(ctx, MOVING)
        self.array = ctx.vertex_array(
            self.program, [self.blades.binding(self.program), self.moving.binding(self.program)]
        )
        self.edges = Records(ctx, EDGE, PER_ROW)
        self.targets = target_texture(ctx, targets)

    def write(self, outlook: Outlook, pool: BladePool, shown: Standing) -> int:
        """Send the blades of patches that are on their way, and their strips; return how many blades."""
        morph = gather_morph(outlook, pool, self.strips, shown, fade=self.fade)
        self.blades.write(morph.blades.view(SHADER_BLADE))
        self.moving.write(morph.moving)
        self.edges.write(morph.edges)
        return self.blades.count

    def draw(self) -> int:
        """Draw what was written; return the number of draw calls."""
        if not self.blades.count:
            return 0
        self.edges.texture.use(self.units["edges"])
        self.targets.use(self.units["targets"])
        self.array.render(moderngl.TRIANGLE_STRIP, vertices=2 * self.segments + 2, instances=self.blades.count)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(self.array, self.program, self.blades, self.moving, self.edges, self.targets)


def target_texture(ctx: moderngl.Context, targets: NDArray[np.float32]) -> moderngl.Texture:
    """Return the painted places of all blades, `PER_ROW` of them in a row, one texel (u, v) for each point."""
    points = targets.shape[3]
    flat = targets.reshape(-1, points, 2)
    rows = -(-len(flat) // PER_ROW)
    padded = np.zeros((rows * PER_ROW, points, 2), np.float32)
    padded[: len(flat)] = flat
    texture = ctx.texture((PER_ROW * points, rows), 2, padded.tobytes(), dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture
