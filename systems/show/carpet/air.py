"""The wind's messages at the middles of the patches around the viewer, as a texture that wraps round."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.gl.shaders import program, set_uniform
from ....engine.gl.stream import release_all
from ..hearing import VERTEX, Hearing
from ..representation import Canvas


class Air:
    """The messages on the rows of the patch table, and their mean for all that is farther away."""

    def __init__(self, canvas: Canvas, side: int) -> None:
        ctx = canvas.ctx
        self.units, self.side = canvas.units, side
        self.texture, self.mean = ctx.texture((side, side), 2, dtype="f4"), ctx.texture((1, 1), 2, dtype="f4")
        self._target, self._mean_target = ctx.framebuffer([self.texture]), ctx.framebuffer([self.mean])
        self.hearing = Hearing(canvas, "systems/show/carpet/receivers.frag", {}, lambda _: None)
        self._program = program(ctx, VERTEX, "systems/show/carpet/mean.frag")
        self._program["air"] = canvas.units["air"]
        self._array = ctx.vertex_array(self._program, [])

    def hear(self, centre: NDArray[np.int32], first: int) -> int:
        """Compute the messages of all patches around a cell; return the number of draw calls.

        `first` is the number of the first patch's receiver among all receivers.
        """
        array = self.hearing.array()
        set_uniform(array.program, "around", int(centre[0]), int(centre[1]), self.side, first)
        self._target.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def write(self, row: int, message: NDArray[np.float32]) -> None:
        """Replace the message (2,) of a row of the patch table."""
        self.texture.write(np.ascontiguousarray(message), viewport=(row % self.side, row // self.side, 1, 1))

    def average(self) -> int:
        """Compute the mean of all messages; return the number of draw calls."""
        self.texture.use(self.units["air"])
        self._mean_target.use()
        self._array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def use(self) -> None:
        """Bind the messages and their mean."""
        self.texture.use(self.units["air"])
        self.mean.use(self.units["mean_air"])

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self.hearing, self._array, self._program, self._target, self._mean_target, self.texture, self.mean)
