"""Programs that draw trees, compiled ahead or when they are first asked for."""

from collections.abc import Iterator, Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.shaders import Texts
from ...engine.gl.stream import Stream, release_all
from ..frame.block import FrameBlock, joined
from .habit import HABITS
from .segments import Segment
from .standing import HUNG, HUNG_LEAVES
from .stream import CAST, FAR, IN_ROWS, LEAVES, NEAR, PICTURED, WOOD, GpuModel

SORTS: Mapping[str, tuple[str, str, Mapping[str, str | int]]] = {
    NEAR: ("card", "card", {}),
    PICTURED: ("twig", "twig", {"OF_TREE": 1}),
    LEAVES: ("twig", "twig", {}),
    WOOD: ("wood", "wood", {"STANDS": 1}),
    FAR: ("far", "far", {"STANDS": 1}),
    IN_ROWS: ("far", "far", {"STANDS": 1, "IN_ROWS": 1}),
    CAST: ("far", "far", {"CAST": 1}),
}
"""Vertex shader, fragment shader and defines of each way to draw."""

HARD, SOFT, SAMPLED = "HARD", "SOFT", "SAMPLED"
"""Ways to draw pixels covered in part, as defines: opaque where coverage is nearly whole; blended where it is less; or
opaque in as many samples of a pixel as are covered."""

STAND, HANG, HANG_LEAVES = "stand", "hang", "hang leaves"
"""Transform feedback passes: once a tree, once a twig on its card, and once a twig leaf by leaf."""

FEEDBACK: Mapping[str, tuple[str, tuple[str, ...], Mapping[str, str | int]]] = {
    STAND: ("stand", ("out_wind_response", "out_haze", "out_grass", "out_light_from_grass"), {}),
    HANG: ("hang", HUNG.names or (), {"STANDS": 1}),
    HANG_LEAVES: ("hang", HUNG_LEAVES.names or (), {"STANDS": 1, "LEAVES": 1}),
}
"""Vertex shader, outputs and defines of each of these passes."""

MOST_QUADS = max(habit.leaf.quads for habit in HABITS.values())
"""Greatest number of quads of a draw: a twig's leaves."""


Content = tuple[moderngl.Buffer | str, ...]
"""Content of a vertex array: a buffer, its format and its attributes."""


class Programs:
    """Programs and vertex arrays of one GL context, for scenes with the same defines."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self._ctx, self._block, self._units = ctx, block, units
        self.defines = dict(block.defines)
        self._programs: dict[tuple[str, str, bool], moderngl.Program] = {}
        self._feedback_programs: dict[str, moderngl.Program] = {}
        self._arrays: dict[tuple[int, str, str, bool], moderngl.VertexArray] = {}
        self._segments = set[Segment]()
        """Segments that some of these arrays read."""
        self._quads = ctx.buffer(_quads())

    def texts(self, *, in_rows: bool) -> Iterator[Texts]:
        """Return the sources of programs not compiled yet; `in_rows` says whether far trees stand for rows."""
        for sort, edges in self._missing(in_rows=in_rows):
            yield self._block.texts(*_shaders(sort, edges=edges, baked=False))

    def making(self, *, in_rows: bool) -> Iterator[None]:
        """Compile these programs, one at a time."""
        for sort, edges in self._missing(in_rows=in_rows):
            self._program(sort, edges=edges, baked=False)
            yield
        for what in FEEDBACK.keys() - self._feedback_programs:
            self._feedback_program(what)
            yield

    def _missing(self, *, in_rows: bool) -> list[tuple[str, str]]:
        sorts = NEAR, LEAVES, WOOD, IN_ROWS if in_rows else FAR
        drawn = [*((sort, edges) for sort in sorts for edges in (HARD, SOFT)), (CAST, HARD)]
        return [(sort, edges) for sort, edges in drawn if (sort, edges, False) not in self._programs]

    def array(
        self, sort: str, stream: Stream | Segment, model: GpuModel | None = None, /, *, edges: str = HARD,
        baked: bool = False,
    ) -> moderngl.VertexArray:  # fmt: skip
        """Return the vertex array of a stream for these edges, or for baking; `WOOD` needs its model."""
        key = id(stream), sort, edges, baked
        if key not in self._arrays:
            program = self._program(sort, edges=edges, baked=baked)
            bark = [model.bark(program)] if sort == WOOD and model is not None else []
            quads = None if baked or sort in (NEAR, FAR, IN_ROWS) else self._quads
            indices = model.triangles if sort == WOOD and model is not None else quads
            each = "/r" if baked else "/i"  # of a baked tree, an instance is a twig
            self._arrays[key] = self._reading(program, stream, *bark, indices=indices, each=each)
        return self._arrays[key]

    def feedback(self, what: str, stream: Stream | Segment) -> moderngl.VertexArray:
        """Return the vertex array of a feedback pass: over a stream's records, or over the twigs of each tree."""
        key = id(stream), what, HARD, False
        if key not in self._arrays:
            each = "/v" if what == STAND else "/i"
            self._arrays[key] = self._reading(self._feedback_program(what), stream, each=each)
        return self._arrays[key]

    def _reading(
        self, program: moderngl.Program, stream: Stream | Segment, *contents: Content, each: str = "/i",
        indices: moderngl.Buffer | None = None,
    ) -> moderngl.VertexArray:  # fmt: skip
        """Return a vertex array that reads a stream, and other contents."""
        read = stream.bindings(program) if isinstance(stream, Segment) else [stream.binding(program, each=each)]
        used = [content for content in (*contents, *read) if len(content) > 2]
        array = self._ctx.vertex_array(program, used, index_buffer=indices)
        if isinstance(stream, Segment):
            stream.lead(array)
            self._segments.add(stream)
        return array

    def _feedback_program(self, what: str) -> moderngl.Program:
        if what not in self._feedback_programs:
            name, written, defines = FEEDBACK[what]
            shader = f"systems/trees/{name}.vert"
            program = joined(self._ctx, self._block, self._units, shader, None, defines, varyings=written)
            self._feedback_programs[what] = program
        return self._feedback_programs[what]

    def _program(self, sort: str, *, edges: str, baked: bool) -> moderngl.Program:
        key = sort, edges, baked
        if key not in self._programs:
            shaders = _shaders(sort, edges=edges, baked=baked)
            self._programs[key] = joined(self._ctx, self._block, self._units, *shaders)
        return self._programs[key]

    def release(self) -> None:
        """Release all GL objects."""
        for segment in self._segments:
            segment.lose()
        release_all(*self._arrays.values(), *self._programs.values(), *self._feedback_programs.values(), self._quads)


def _shaders(sort: str, *, edges: str, baked: bool) -> tuple[str, str, Mapping[str, str | int]]:
    """Return the vertex shader, fragment shader and defines of a way to draw."""
    vertex, fragment, defines = SORTS[sort]
    if baked:
        still = {name: value for name, value in defines.items() if name != "STANDS"}
        defines = {**still, "BAKED": 1, SAMPLED: 1}
    else:
        defines = {**defines, edges: 1}
    return f"systems/trees/{vertex}.vert", f"systems/trees/{fragment}.frag", defines


def _quads() -> NDArray[np.uint32]:
    """Return indices that make two triangles of each four corners."""
    return (np.arange(MOST_QUADS, dtype=np.uint32)[:, None] * 4 + np.array([0, 1, 2, 2, 1, 3], np.uint32)).reshape(-1)
