"""The pass that computes the wind at a representation's receivers on the graphics card."""

from collections.abc import Callable, Iterator, Mapping

import moderngl

from ...engine.gl.shaders import set_uniform
from ...engine.gl.stream import release_all
from .representation import Canvas

VERTEX = "engine/gl/fill.vert"


class Hearing:
    """A pass with one fragment for each receiver.

    The representation's `fragment` shader places the receiver; the code of the winds that blow computes its message.
    `set_uniforms` sets the program's other uniforms.
    """

    def __init__(
        self,
        canvas: Canvas,
        fragment: str,
        defines: Mapping[str, str | int],
        set_uniforms: Callable[[moderngl.Program], None],
    ) -> None:
        self._canvas, self._fragment, self._defines, self._set_uniforms = canvas, fragment, defines, set_uniforms
        self._array: moderngl.VertexArray | None = None
        self._runs: tuple[int, ...] = ()
        """The runs of the winds that the array was made for."""

    def array(self) -> moderngl.VertexArray:
        """Return the vertex array that runs the pass in the winds that blow now."""
        canvas = self._canvas
        if self._array is not None and self._runs == canvas.air.runs:
            return self._array
        self._runs = canvas.air.runs
        program = canvas.air.program(VERTEX, self._fragment, defines={**canvas.block.defines, **self._defines})
        if self._array is None or self._array.program is not program:
            self.release()
            for name, unit in canvas.units.items():
                set_uniform(program, name, unit)
            self._set_uniforms(program)
            self._array = canvas.ctx.vertex_array(program, [])
        return self._array

    def update_uniforms(self) -> None:
        """Set the program's other uniforms anew, after their values have changed."""
        if self._array is not None:
            self._set_uniforms(self._array.program)

    def making(self) -> Iterator[None]:
        """Compile the programs for all orders of winds, one at a time."""
        for order in self._canvas.air.orders:
            with self._canvas.air.ordered(order):
                self.array()
            yield
        self.array()

    def release(self) -> None:
        """Release the vertex array; the winds own its program."""
        release_all(self._array)
        self._array = None
