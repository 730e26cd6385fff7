"""The programs that trees are drawn with, each made when it is first asked for, or ahead of that."""

from collections.abc import Iterator, Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.shaders import Texts
from ...engine.gl.stream import Stream, release_all
from ..frame.block import FrameBlock, joined
from .card import CAST, FAR, IN_ROWS, LEAVES, NEAR, PICTURED, WOOD, ModelOnCard
from .grow import MOST_TWIGS
from .habit import HABITS
from .standing import HUNG, HUNG_LEAVES

SORTS: Mapping[str, tuple[str, str, Mapping[str, str | int]]] = {
    NEAR: ("card", "card", {}),
    PICTURED: ("twig", "twig", {}),
    LEAVES: ("twig", "twig", {"LEAVES": 1}),
    WOOD: ("wood", "wood", {"STANDS": 1}),
    FAR: ("far", "far", {"STANDS": 1}),
    IN_ROWS: ("far", "far", {"STANDS": 1, "IN_ROWS": 1}),
    CAST: ("far", "far", {"CAST": 1}),
}
"""By what is drawn: vertex and fragment shader, and what they are told."""

HARD, SOFT, SAMPLED = "HARD", "SOFT", "SAMPLED"
"""Which way pixels are drawn that are covered in part, as shaders are told: those that are covered nearly wholly, as
opaque; the others, blended; or all of them, opaque in as many samples of a pixel as are covered."""

STAND, HANG, HANG_LEAVES = "stand", "hang", "hang leaves"
"""What is made out: once a tree, once a twig on its card, and once a twig leaf by leaf."""

MADE: Mapping[str, tuple[str, tuple[str, ...], Mapping[str, str | int]]] = {
    STAND: ("stand", ("moved", "veil", "among", "sent_up"), {}),
    HANG: ("hang", HUNG.names or (), {"STANDS": 1}),
    HANG_LEAVES: ("hang", HUNG_LEAVES.names or (), {"STANDS": 1, "LEAVES": 1}),
}
"""By that: the shader, what it writes, and what it is told."""

MOST_QUADS = max(MOST_TWIGS, *(habit.leaf.quads for habit in HABITS.values()))
"""Quads that are drawn at most of a tree or a twig: its twigs on cards as they are baked, or its leaves."""


class Programs:
    """Programs and vertex arrays of one GL context, for trees in scenes that are told the same."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self._ctx, self._block, self._units = ctx, block, units
        self.made_of = dict(block.defines)
        self._programs: dict[tuple[str, str, bool], moderngl.Program] = {}
        self._makers: dict[str, moderngl.Program] = {}
        self._arrays: dict[tuple[int, str, str, bool], moderngl.VertexArray] = {}
        self._quads = ctx.buffer(_quads())

    def texts(self, *, in_rows: bool) -> Iterator[Texts]:
        """Return what is not there yet of all that may be drawn is made of, far trees in rows or one by one."""
        for sort, edges in self._due(in_rows=in_rows):
            yield self._block.texts(*_shaders(sort, edges=edges, baked=False))

    def making(self, *, in_rows: bool) -> Iterator[None]:
        """Make what is not there yet of that, one at a time."""
        for sort, edges in self._due(in_rows=in_rows):
            self._program(sort, edges=edges, baked=False)
            yield
        for what in MADE.keys() - self._makers:
            self._maker(what)
            yield

    def _due(self, *, in_rows: bool) -> list[tuple[str, str]]:
        sorts = NEAR, LEAVES, WOOD, IN_ROWS if in_rows else FAR
        drawn = [*((sort, edges) for sort in sorts for edges in (HARD, SOFT)), (CAST, HARD)]
        return [(sort, edges) for sort, edges in drawn if (sort, edges, False) not in self._programs]

    def array(
        self, sort: str, stream: Stream, model: ModelOnCard | None = None, /, *, edges: str = HARD, baked: bool = False
    ) -> moderngl.VertexArray:  # fmt: skip
        """Return what draws trees of a stream: with such edges, or as they are baked; `WOOD` is a model's."""
        key = id(stream), sort, edges, baked
        if key not in self._arrays:
            program, indices = self._program(sort, edges=edges, baked=baked), self._quads
            contents = [stream.binding(program)]
            if model is not None:
                if not baked and (told := model.told.get(id(stream))) is not None:
                    contents.append(told.binding(program))
                if sort == WOOD:
                    contents.insert(0, model.bark(program))
                    indices = model.triangles
            whole = [each for each in contents if len(each) > 2]
            self._arrays[key] = self._ctx.vertex_array(
                program, whole, index_buffer=None if sort in (NEAR, FAR, IN_ROWS) else indices
            )
        return self._arrays[key]

    def made(self, what: str, stream: Stream, told: Stream | None = None) -> moderngl.VertexArray:
        """Return what makes out what `MADE` has of each tree of a stream, or with `told` of each of its twigs."""
        key = id(stream), what, HARD, False
        if key not in self._arrays:
            program = self._maker(what)
            each = "/v" if told is None else "/i"
            streams = [one.binding(program, each=each) for one in (stream, told) if one is not None]
            self._arrays[key] = self._ctx.vertex_array(program, streams)
        return self._arrays[key]

    def _maker(self, what: str) -> moderngl.Program:
        if what not in self._makers:
            name, written, defines = MADE[what]
            shader = f"systems/trees/{name}.vert"
            made = joined(self._ctx, self._block, self._units, shader, None, defines, varyings=written)
            self._makers[what] = made
        return self._makers[what]

    def _program(self, sort: str, *, edges: str, baked: bool) -> moderngl.Program:
        key = sort, edges, baked
        if key not in self._programs:
            shaders = _shaders(sort, edges=edges, baked=baked)
            self._programs[key] = joined(self._ctx, self._block, self._units, *shaders)
        return self._programs[key]

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._arrays.values(), *self._programs.values(), *self._makers.values(), self._quads)


def _shaders(sort: str, *, edges: str, baked: bool) -> tuple[str, str, Mapping[str, str | int]]:
    """Return the vertex and the fragment shader of what is drawn, and what they are told."""
    vertex, fragment, told = SORTS[sort]
    told = {**told, edges: 1} if not baked else {**{k: v for k, v in told.items() if k != "STANDS"}, "BAKED": 1}
    return f"systems/trees/{vertex}.vert", f"systems/trees/{fragment}.frag", told


def _quads() -> NDArray[np.uint32]:
    """Return the corners of quads, four each, as two triangles each."""
    return (np.arange(MOST_QUADS, dtype=np.uint32)[:, None] * 4 + np.array([0, 1, 2, 2, 1, 3], np.uint32)).reshape(-1)
