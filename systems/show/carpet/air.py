"""The air over the carpet: what the middle of each patch around the viewer hears, as a texture that wraps round."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.gl.shaders import program, set_uniform
from ....engine.gl.stream import release_all
from ..hearing import VERTEX, Hearing
from ..representation import Canvas


class Air:
    """The messages on the rows of the patch table, and their mean for what lies farther off."""

    def __init__(self, canvas: Canvas, side: int) -> None:
        ctx = canvas.ctx
        self.units, self.side = canvas.units, side
        self.texture, self.mean = ctx.texture((side, side), 2, dtype="f4"), ctx.texture((1, 1), 2, dtype="f4")
        self._target, self._summed = ctx.framebuffer([self.texture]), ctx.framebuffer([self.mean])
        self.hearing = Hearing(canvas, "systems/show/carpet/receivers.frag", {}, lambda _: None)
        self._program = program(ctx, VERTEX, "systems/show/carpet/mean.frag")
        self._program["air"] = canvas.units["air"]
        self._array = ctx.vertex_array(self._program, [])

    def hear(self, centre: NDArray[np.int32], first: int) -> int:
        """Let the middles of all patches around a cell hear the wind; return the number of draw calls.

        `first` is the number of the first of them among all receivers.
        """
        array = self.hearing.array()
        set_uniform(array.program, "around", int(centre[0]), int(centre[1]), self.side, first)
        self._target.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def write(self, row: int, message: NDArray[np.float32]) -> None:
        """Replace the message (2,) of a row of the patch table."""
        self.texture.write(np.ascontiguousarray(message), viewport=(row % self.side, row // self.side, 1, 1))

    def sum_up(self) -> int:
        """Take the mean of them all; return the number of draw calls."""
        self.texture.use(self.units["air"])
        self._summed.use()
        self._array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def use(self) -> None:
        """Bind both."""
        self.texture.use(self.units["air"])
        self.mean.use(self.units["mean_air"])

    def release(self) -> None:
        """Give everything back."""
        release_all(self.hearing, self._array, self._program, self._target, self._summed, self.texture, self.mean)
