"""Drawing 3D blades: one instanced draw per sub-level."""

from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.gl.stream import Stream, release_all
from ...frame.block import FrameBlock, joined
from .pool import BLADE

MOVED = np.dtype([("message", "2f4"), ("fade", "f4"), ("slide", "f4")])
"""What changes each frame about a blade: its receiver's message, how much it shows, and how far its joints have slid
together to those of the next coarser ring."""

WHOLE, CORES, EDGES = range(3)
"""What is drawn of soft blades: all; the pixels that count as hidden behind them; the others."""

ROUND = "0.35"
"""How far the face normal turns towards a blade's edges, as if it were rounded."""

SHADER_BLADE = np.dtype([(name if name != "root" else "root_at", BLADE[name]) for name in BLADE.names or ()])
"""`BLADE` under the shader's names: `root` alone is a colour there."""


class BladePainter:
    """Draws blades with a given number of segments, whose joints can slide together to be those of `coarser` blades.

    Soft ones have smooth edges and must come from far to near; only those up to `near` [m] hide one another by depth.
    The others are opaque and may come in any order.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        block: FrameBlock,
        segments: int,
        units: Mapping[str, int],
        *,
        soft: bool,
        coarser: int | None = None,
        near: float = 0.0,
    ) -> None:
        self.segments = segments
        self.soft = soft
        defines: dict[str, str | int] = {"SEGMENTS": segments, "ROUND": ROUND, **({"SOFT": 1} if soft else {})}
        defines["COARSER"] = min(coarser or segments, segments)
        self.program = joined(
            ctx, block, units, "systems/show/blades/blades.vert", "systems/show/blades/blades.frag", defines
        )
        if soft:
            self.program["near"] = near
        self.blades = Stream(ctx, SHADER_BLADE)
        self.moved = Stream(ctx, MOVED)
        self.array = ctx.vertex_array(
            self.program, [self.blades.binding(self.program), self.moved.binding(self.program)]
        )

    def write(self, blades: NDArray[np.void], moved: NDArray[np.void]) -> None:
        """Send the blades, records of `BLADE` and of `MOVED`, each of shape (n,)."""
        self.blades.write(blades.view(SHADER_BLADE))
        self.moved.write(moved)

    def draw(self, part: int = WHOLE) -> int:
        """Draw what was written, of soft blades this part; return the number of draw calls."""
        if not self.blades.count:
            return 0
        if self.soft:
            self.program["part"] = part
        self.array.render(moderngl.TRIANGLE_STRIP, vertices=2 * self.segments + 2, instances=self.blades.count)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(self.array, self.program, self.blades, self.moved)
