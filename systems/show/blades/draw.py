"""Drawing 3D blades: a pass computes a record of each blade, then each record is drawn as a ribbon."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.gl.shaders import Texts, set_uniform
from ....engine.gl.stream import Stream, release_all
from ...frame.block import FrameBlock, filled, joined, room_for
from .organs import organ_defines

RIBBON = np.dtype(
    [
        ("foot", "4f4"),
        ("lean_across", "4f4"),
        ("root_pigment", "4f4"),
        ("tip_pigment", "4f4"),
        ("canopy_organ", "4f4"),
        ("level_kind", "4f4"),
        ("lit", "16f4"),
    ]
)
"""Record that the pass over blades writes of each: the varyings of `blade.vert`."""

PAINTED = np.dtype([*RIBBON.descr, ("base", "4f4"), ("painted", "4f4")])
"""The same of a morphing blade, with its painted place."""

MESSAGE = np.dtype([("message", "2f4")])

CORES, EDGES = 1, 2
"""The two passes over parted blades: the pixels that hide what is behind them, with depth; then the others."""

ROUND = "0.35"
"""Turn of the normal from the middle of a blade to its edges, as if it were rounded [rad]."""

FILES = "systems/show/blades/ribbon.vert", "systems/show/blades/blades.frag"

USUAL, SHADED, DEEP = SORTS = range(3)
"""The programs of ribbons: without casters of shadows; with a game's casters; writing depth only."""

Defines = Mapping[str, str | int]


def blade_program(
    ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], record: np.dtype[np.void], defines: Defines
) -> moderngl.Program:
    """Return the program of the pass over blades; `record` is `RIBBON` or `PAINTED`."""
    return joined(
        ctx, block, units, "systems/show/blades/blade.vert", None, {"ROUND": ROUND, **defines},
        varyings=tuple(record.names or ()),
    )  # fmt: skip


def own_segment_defines(own: Sequence[int | None], /) -> dict[str, str | int]:
    """Return the defines of kinds that set the number of segments of their blades at the finest level.

    `own` has that number for each kind, or None. Without any, there are no defines.
    """
    counts = [count or 0 for count in own]
    listed = f"int[]({', '.join(map(str, counts))})"
    return {"OWN_SEGMENTS": listed, "MOST_OWN_SEGMENTS": max(counts)} if any(counts) else {}


class Ribbons:
    """A stream of ribbons of one or several sub-levels: joints slide between those of a sub-level and of the next.

    Where all sub-levels have as many segments, joints stay, and no shader computes how they would slide.

    `counts` has the segments of each sub-level. Soft ribbons have antialiased edges and must come from far to near;
    others are opaque and may come in any order. Parted ribbons are soft too, but drawn in two passes, `CORES` and
    `EDGES`, so that depth sorts them. Parted and opaque ribbons include the finest sub-level.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        block: FrameBlock,
        counts: Sequence[int],
        units: Mapping[str, int],
        *,
        soft: bool,
        parted: bool = False,
        record: np.dtype[np.void] = RIBBON,
        defines: Defines | None = None,
        set_uniforms: Callable[[moderngl.Program], None] = lambda _: None,
    ) -> None:
        finest = parted or not soft
        own = int(block.defines.get("MOST_OWN_SEGMENTS", 0)) if finest else 0
        self.segments = max(*counts, own)
        shaded = {
            "SUBLEVELS": room_for(len(counts)), **({"SOFT": 1} if soft else {}), **({"PARTED": 1} if parted else {}),
            **({"FINEST": 1} if finest else {}), **(defines or {}),
            **({"SLIDES": 1} if len(counts) > 1 and (own or len(set(counts)) > 1) else {}),
        }  # fmt: skip
        plain = {**shaded, "PLAIN": 1}
        deep = {name: value for name, value in plain.items() if name != "PARTED"} | {"DEEP": 1}
        self._make, self._defines = partial(joined, ctx, block, units, *FILES), (plain, shaded, deep)
        self._texts, self._set_uniforms, self._counts = partial(block.texts, *FILES), set_uniforms, counts
        self._block, self.stream = block, Stream(ctx, record)
        self._arrays: dict[int, moderngl.VertexArray] = {}

    def array(self, sort: int) -> moderngl.VertexArray:
        """Return the vertex array of one of `SORTS`, made when first needed. `DEEP` writes depth by `deep.glsl`."""
        if sort not in self._arrays:
            program = self._make(self._defines[sort])
            program["segments"], program["counts"] = self.segments, len(self._counts)
            program["segments_of"] = filled(self._counts, room_for(len(self._counts)))
            self._set_uniforms(program)
            self._arrays[sort] = program.ctx.vertex_array(program, [self.stream.binding(program)])
        return self._arrays[sort]

    def texts(self) -> Iterator[Texts]:
        """Return the sources of the colour programs that are not made yet."""
        for sort in (USUAL, SHADED):
            if sort not in self._arrays:
                yield self._texts(self._defines[sort])

    def making(self) -> Iterator[None]:
        """Make the colour programs that are missing, one at a time."""
        for sort in (USUAL, SHADED):
            if sort not in self._arrays:
                self.array(sort)
                yield

    def update_uniforms(self) -> None:
        """Set the uniforms of the programs made so far anew."""
        for array in self._arrays.values():
            self._set_uniforms(array.program)

    def fill(self, blades: moderngl.VertexArray, count: int, *, first: int = 0) -> int:
        """Compute the stream of `count` blades from `first` on; return the number of draw calls."""
        self.stream.room(count)
        if count:
            blades.transform(self.stream.buffer, moderngl.POINTS, vertices=count, first=first)
        return int(count > 0)

    def draw(self, part: int | None = None) -> int:
        """Draw the stream, of parted ribbons only this `part`: `CORES` or `EDGES`; return the number of draw calls."""
        if not self.stream.count:
            return 0
        array = self.array(SHADED if self._block.given.casts else USUAL)
        if part is not None:
            set_uniform(array.program, "part", part)
        return self._draw(array)

    def draw_deep(self) -> int:
        """Write the depth of the stream; return the number of draw calls."""
        return self._draw(self.array(DEEP)) if self.stream.count else 0

    def _draw(self, array: moderngl.VertexArray) -> int:
        array.render(moderngl.TRIANGLE_STRIP, vertices=2 * self.segments + 2, instances=self.stream.count)
        return 1

    def release(self) -> None:
        """Give everything back."""
        arrays = self._arrays.values()
        release_all(*arrays, *(array.program for array in arrays), self.stream)


class BladeDrawing:
    """Draws given blades, records of `BLADE` or `ORGAN`, opaque and in any order."""

    def __init__(
        self,
        ctx: moderngl.Context,
        block: FrameBlock,
        segments: int,
        units: Mapping[str, int],
        record: np.dtype[np.void],
    ) -> None:
        organs = organ_defines(record)
        self.ribbons = Ribbons(ctx, block, [segments], units, soft=False, defines=organs)
        self.program = blade_program(ctx, block, units, RIBBON, organs)
        attributes = [(name if name != "root" else "root_at", record[name]) for name in record.names or ()]
        self.blades = Stream(ctx, np.dtype(attributes))  # in shaders, `root` is a colour
        self.messages = Stream(ctx, MESSAGE)
        streams = [stream.binding(self.program, each="/v") for stream in (self.blades, self.messages)]
        self.array = ctx.vertex_array(self.program, streams)

    def write(self, blades: NDArray[np.void], messages: NDArray[np.float32]) -> None:
        """Send the blades, records (n,), and their messages (n, 2)."""
        self.blades.write(blades.view(self.blades.record))
        self.messages.write(messages)

    def draw(self) -> int:
        """Draw what was written; return the number of draw calls."""
        return self.ribbons.fill(self.array, self.blades.count) + self.ribbons.draw()

    def release(self) -> None:
        """Give everything back."""
        release_all(self.ribbons, self.array, self.program, self.blades, self.messages)
