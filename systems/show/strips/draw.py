"""Drawing 2.5D strips, back to front: those of all rings together."""

from collections.abc import Iterator, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.declared.quality import StripRing
from ....engine.gl.emit import emitted, looked_up
from ....engine.gl.mipmaps import stack_for
from ....engine.gl.records import Records
from ....engine.gl.shaders import tell
from ....engine.gl.stream import release_all
from ...frame.block import by_kind, filled, joined, room_for
from ..hearing import Hearing
from ..representation import Canvas
from .gather import LIES_AHEAD, OF_RING, RUNS_ALONG, STOOD
from .grow import Strips
from .textures import Atlas, extent_texture, strip_texture

STOOD_ROW, STRIPS_ROW = 64, 1024
"""Records in a row of the textures that hold patches, and the numbers of polygon strips."""

READY_ROWS = 256
"""Rows of both that there is room for once a game has prepared."""

GLSL = looked_up("Stood", STOOD, "stood", STOOD_ROW) + emitted(
    {"STRIPS_ROW": STRIPS_ROW, "RUNS_ALONG": RUNS_ALONG, "LIES_AHEAD": LIES_AHEAD, "OF_RING": OF_RING}
)

Sort = dict[str, str | int]
"""What a program is told."""

EDGED: Sort = {"SHADED": 1, "CUT": 1, "THIN": 1, "EDGED": 1}
"""What the program is told that draws grass whose density has edges, whatever else there is: it is the last."""


def _sorts(*special: Sort) -> list[Sort]:
    """Return what programs of some sorts are told, each with all blades and by rank."""
    thin: Sort = {"THIN": 1}
    return [{**each, **more} for each in special for more in ({}, thin)]


SORTS = [*_sorts({}, {"SHADED": 1}, {"SHADED": 1, "CUT": 1}), EDGED]
"""The programs that draw strips: of the usual, where shadows fall on it, and where any grass is cut besides."""

DEEP = [*_sorts({"DEEP": 1}, {"DEEP": 1, "CUT": 1}), {"DEEP": 1, **EDGED}]
"""Those that write depth alone: with all blades and by rank, then where any grass is cut, and with edges."""

NUMBER = np.dtype([("number", "u4")])


class StripPainter:
    """Draws the strips of all rings; it owns their textures.

    `stock` gives the strips by ring, kind and model, and `atlas` is what `strip_atlas` makes of them.
    """

    def __init__(
        self,
        canvas: Canvas,
        rings: Sequence[StripRing],
        stock: Sequence[list[list[Strips]]],
        atlas: Atlas,
        *,
        heads: bool,
    ) -> None:
        self.units, self.rings, self.kinds = canvas.units, rings, len(stock[0])
        self.received, self._block = canvas.received, canvas.block
        self.sections = max(ring.sections for ring in rings)
        self.most = self.kinds * max(ring.strips * ring.columns for ring in rings)
        self.atlas, self.ranks = (strip_texture(canvas.ctx, made) for made in (atlas.texels, atlas.ranks))
        stack = stack_for(canvas.ctx, len(atlas.texels[0]))
        self._rows = self.atlas.height // stack
        self.extents = extent_texture(canvas.ctx, stock, [ring.columns for ring in rings])
        self._stock = stock
        self.stood = Records(canvas.ctx, STOOD, STOOD_ROW)
        self.strips = Records(canvas.ctx, NUMBER, STRIPS_ROW)
        laid: dict[str, str | int] = {"RINGS": room_for(len(rings))}
        self.hearing = Hearing(canvas, "systems/show/strips/receivers.frag", laid, self._tell)
        whole = {**laid, "STACK": stack} if stack > 1 else dict(laid)
        if heads:
            whole["HEADS"] = 1
        self._canvas, self._whole = canvas, whole
        self._made: dict[tuple[bool, int], moderngl.VertexArray] = {}

    def making(self) -> Iterator[None]:
        """Make the programs that are not there yet, one at a time."""
        for number in range(len(SORTS)):
            if (False, number) not in self._made:
                self.array(number)
                yield

    def array(self, number: int, *, deep: bool = False) -> moderngl.VertexArray:
        """Return what draws strips as programs of one of `SORTS` do, or of `DEEP`; it is made when it is asked for."""
        if (deep, number) not in self._made:
            canvas = self._canvas
            program = joined(
                canvas.ctx, canvas.block, canvas.units, "systems/show/strips/strips.vert",
                "systems/show/strips/strips.frag", {**self._whole, **(DEEP if deep else SORTS)[number]},
            )  # fmt: skip
            self._tell(program)
            program["most"], program["atlas_rows"] = self.most, self._rows
            program["pictures"] = filled(self._pictures(), room_for(len(self.rings)) * self.kinds)
            self._made[deep, number] = canvas.ctx.vertex_array(program, [])
        return self._made[deep, number]

    def _tell(self, made: moderngl.Program) -> None:
        """Tell a program how strips stand."""
        kinds = [models[0] for models in self._stock[0]]
        tell_stacks(made, self.rings)
        made["margin"] = by_kind([strips.margin for strips in kinds])
        if "tall" in made:
            made["tall"] = by_kind([strips.height for strips in kinds])

    def _pictures(self) -> list[tuple[float, float, float]]:
        """Return how far each picture reaches across its layer and up, and its first layer, by ring and kind."""
        found, layer = [], 0
        for models in (models for kinds in self._stock for models in kinds):
            rows, columns = models[0].texels.shape[2:4]
            found.append((columns / self.atlas.width, rows / self._rows, float(layer)))
            layer += sum(2 * len(strips.plane) for strips in models)
        return found

    def make_ready(self) -> None:
        """Make room for more than is usually shown, and programs for whatever winds will blow."""
        self.stood.reserve(READY_ROWS)
        self.strips.reserve(READY_ROWS)
        self.hearing.make_ready()
        for number in range(len(DEEP)):
            self.array(number, deep=True)

    def write(self, stood: NDArray[np.void]) -> None:
        """Send the patches, ring after ring."""
        self.stood.write(stood)

    def write_strips(self, strips: NDArray[np.uint32]) -> None:
        """Send the numbers of the polygon strips (n,), far to near."""
        self.strips.write(strips.view(NUMBER))

    def hear(self, ring: int, *, patch: int, first: int, count: int) -> int:
        """Ask the receivers of a ring's patches, whose first is number `patch`; return the number of draw calls."""
        if not count:
            return 0
        self.stood.texture.use(self.units["stood"])
        array = self.hearing.array()
        tell(array.program, "of_ring", ring, patch)
        return self.received.ask(array, first=first, count=count)

    def draw(self, first: int, count: int, *, thin: int, deep: bool = False) -> int:
        """Draw `count` of what was written, from the `first` on; return the number of draw calls.

        With a `thin` of 1, blades are drawn by rank: only those that the density and the patch's `ranks` leave. With 2,
        density has edges. With `deep`, depth alone is written, where a strip covers at least half a pixel.
        """
        if not count:
            return 0
        self.atlas.use(self.units["atlas"])
        self.ranks.use(self.units["ranks"])
        self.stood.texture.use(self.units["stood"])
        self.extents.use(self.units["extents"])
        self.strips.texture.use(self.units["strips"])
        frame = self._block.record[0]
        is_cut = bool(frame["anything_cut"])
        casts = frame["maps_shown"] > 0.0 or frame["shades_grid"][3] > 0.0 or "TREES" in self._block.defines
        is_shaded = bool(frame["bodies"]["radius"].any() or casts)
        rare = is_cut if deep else 2 if is_cut else int(is_shaded)
        array = self.array(2 * rare + thin if thin < 2 else len(DEEP if deep else SORTS) - 1, deep=deep)
        tell(array.program, "first", first)
        array.render(moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=count)
        return 1

    def release(self) -> None:
        """Give everything back."""
        textures = self.atlas, self.ranks, self.extents
        arrays = list(self._made.values())
        release_all(*arrays, *(array.program for array in arrays), self.hearing, self.stood, self.strips, *textures)


def tell_stacks(made: moderngl.Program, rings: Sequence[StripRing], /) -> None:
    """Tell a program how many columns, sections and strips each ring has."""
    made["stacks"] = filled([(ring.columns, ring.sections, ring.strips, 0) for ring in rings], room_for(len(rings)))
