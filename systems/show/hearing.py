"""How the receivers of a representation hear the wind on the graphics card."""

from collections.abc import Callable, Iterator, Mapping

import moderngl

from ...engine.gl.shaders import set_uniform
from .representation import Canvas

VERTEX = "engine/gl/fill.vert"


class Hearing:
    """A pass over receivers: the fragment shader says where each stands, the winds that blow say what it is told.

    `tell` tells a program what else it has to know.
    """

    def __init__(
        self,
        canvas: Canvas,
        fragment: str,
        defines: Mapping[str, str | int],
        tell: Callable[[moderngl.Program], None],
    ) -> None:
        self._canvas, self._fragment, self._defines, self._tell = canvas, fragment, defines, tell
        self._array: moderngl.VertexArray | None = None
        self._runs: tuple[int, ...] = ()
        """Those of the winds that it was made for."""

    def array(self) -> moderngl.VertexArray:
        """Return what the receivers are asked with, in the winds of now."""
        canvas = self._canvas
        if self._array is not None and self._runs == canvas.air.runs:
            return self._array
        self._runs = canvas.air.runs
        made = canvas.air.program(VERTEX, self._fragment, defines={**canvas.block.defines, **self._defines})
        if self._array is None or self._array.program is not made:
            self.release()
            for name, unit in canvas.units.items():
                set_uniform(made, name, unit)
            self._tell(made)
            self._array = canvas.ctx.vertex_array(made, [])
        return self._array

    def tell_again(self) -> None:
        """Tell what it has to know, which is something else now."""
        if self._array is not None:
            self._tell(self._array.program)

    def making(self) -> Iterator[None]:
        """Make the programs for whatever winds will blow, one at a time."""
        for order in self._canvas.air.orders:
            with self._canvas.air.ordered(order):
                self.array()
            yield
        self.array()

    def release(self) -> None:
        """Give everything back; the program is that of the winds."""
        if self._array is not None:
            self._array.release()
            self._array = None
