"""Drawing the 2.5D strips of all rings together, from far to near."""

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import Self

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.declared.quality import StripRing
from ....engine.gl.emit import emitted, record_lookup
from ....engine.gl.mipmaps import at_once
from ....engine.gl.remembered import Shelves
from ....engine.gl.shaders import Texts, set_uniform, set_uniform_array
from ....engine.gl.stream import Records, release_all, released_unless_finished
from ...frame.block import filled, joined, room_for
from ...grow.organs import any_heads
from ...grow.record import Form
from ..hearing import Hearing
from ..representation import Canvas
from .gather import ALL_BLADES, BY_RANK, EDGED, LIES_AHEAD, OF_RING, PLACEMENT, RUNS_ALONG
from .grow import strips_of
from .textures import Atlas, extent_texture, sending_strips

PLACEMENTS_ROW, STRIPS_ROW = 64, 1024
"""Records in a row of the texture of placements, and numbers in a row of the texture of polygon strips."""

READY_ROWS = 256
"""Rows reserved in both textures once a game has prepared."""

GLSL = record_lookup("Placement", PLACEMENT, "placements", PLACEMENTS_ROW) + emitted(
    {"STRIPS_ROW": STRIPS_ROW, "RUNS_ALONG": RUNS_ALONG, "LIES_AHEAD": LIES_AHEAD, "OF_RING": OF_RING}
)

Defines = dict[str, str | int]

MODES: dict[int, Defines] = {ALL_BLADES: {}, BY_RANK: {"THIN": 1}, EDGED: {"THIN": 1, "EDGED": 1}}
"""Defines of each drawing mode."""


def _in_all_modes(*variants: Defines) -> list[Defines]:
    """Return the defines of each variant of the program in each drawing mode."""
    return [{**variant, **mode} for variant in variants for mode in MODES.values()]


PROGRAMS = _in_all_modes({}, {"SHADED": 1}, {"SHADED": 1, "CUT": 1})
"""Defines of the programs that draw strips: the plain ones, those with cast shadows, and those with cut grass too."""

DEEP_PROGRAMS = _in_all_modes({"DEEP": 1, "CUT": 1})
"""Defines of the programs that write depth alone."""

FILES = "systems/show/strips/strips.vert", "systems/show/strips/strips.frag"

NUMBER = np.dtype([("number", "u4")])


class StripShelf:
    """One viewer's textures of placements and of numbers of polygon strips, with room for `rows` rows at first."""

    def __init__(self, ctx: moderngl.Context, rows: int) -> None:
        self.placements = Records(ctx, PLACEMENT, PLACEMENTS_ROW, rows=rows)
        self.strips = Records(ctx, NUMBER, STRIPS_ROW, rows=rows)
        self.sent: object = None
        """Gathered frame that was uploaded last."""
        self.numbers: object = None
        """Numbers of polygon strips uploaded last."""

    def reserve(self, rows: int) -> None:
        """Make room for `rows` rows; the contents are lost."""
        self.placements.reserve(rows)
        self.strips.reserve(rows)
        self.sent = self.numbers = None

    def release(self) -> None:
        """Release the textures."""
        release_all(self.placements, self.strips)


class StripDrawing:
    """Draws the strips of all rings, and owns their textures.

    `atlas` holds the pictures of all `forms`, as `strip_atlas` makes it. `heads` says whether any form has heads.
    """

    def __init__(
        self,
        canvas: Canvas,
        rings: Sequence[StripRing],
        forms: Sequence[Form],
        atlas: Atlas,
        *,
        heads: bool,
    ) -> None:
        self.units, self.rings = canvas.units, rings
        self.received, self._block = canvas.received, canvas.block
        self.sections = max(ring.sections for ring in rings)
        self._canvas = canvas
        self._uploaded = _Uploaded.of(canvas.ctx, rings, forms, atlas)
        self._staged: _Uploaded | None = None
        self._rows = 64
        self.shelves = Shelves(lambda: StripShelf(canvas.ctx, self._rows))
        shared: Defines = {"RINGS": room_for(len(rings))}
        self.hearing = Hearing(canvas, "systems/show/strips/receivers.frag", shared, self._set_uniforms)
        self._heads = heads
        self._defines = shared | ({"HEADS": 1} if heads else {})
        self._arrays: dict[tuple[bool, int], moderngl.VertexArray] = {}
        """Vertex arrays by `deep` and the number of the program."""
        self._outdated: set[tuple[bool, int]] = set()
        """Arrays whose program has old uniforms. They are set when it draws, as a frame needs few of the programs."""

    def texts(self) -> Iterator[Texts]:
        """Yield the shader texts of the missing programs."""
        for number in range(len(PROGRAMS)):
            if (False, number) not in self._arrays:
                yield self._block.texts(*FILES, self._defines | PROGRAMS[number])

    def making(self) -> Iterator[None]:
        """Compile the missing programs one at a time."""
        for number in range(len(PROGRAMS)):
            if (False, number) not in self._arrays:
                self.array(number)
                yield

    @property
    def extents(self) -> moderngl.Texture:
        """Texture of `Atlas.extents`."""
        return self._uploaded.extents

    @property
    def forms(self) -> Sequence[Form]:
        """Forms of all kinds whose strips are in use."""
        return self._uploaded.forms

    def fits(self, forms: Sequence[Form], /) -> bool:
        """Return whether the programs can draw the strips of these forms too."""
        return any_heads(form.growth for form in forms) == self._heads

    def staging(self, forms: Sequence[Form], atlas: Atlas, /) -> Iterator[None]:
        """Upload new strips beside those in use, a piece at a time."""
        release_all(self._staged)
        self._staged = None
        self._staged = yield from _uploading(self._canvas.ctx, self.rings, forms, atlas)

    def restock(self) -> None:
        """Replace the strips in use by the staged ones."""
        assert self._staged is not None
        self._uploaded.release()
        self._uploaded, self._staged = self._staged, None
        self.hearing.update_uniforms()
        self._outdated = {*self._arrays}

    def array(self, number: int, *, deep: bool = False) -> moderngl.VertexArray:
        """Return the vertex array of one of `PROGRAMS`, or of `DEEP_PROGRAMS`; the program is compiled on first use."""
        if (deep, number) not in self._arrays:
            canvas, defines = self._canvas, (DEEP_PROGRAMS if deep else PROGRAMS)[number]
            program = joined(canvas.ctx, canvas.block, canvas.units, *FILES, self._defines | defines)
            self._set_uniforms(program)
            self._arrays[deep, number] = canvas.ctx.vertex_array(program, [])
        array = self._arrays[deep, number]
        if (deep, number) in self._outdated:
            self._outdated.remove((deep, number))
            self._set_uniforms(array.program)
        return array

    def _set_uniforms(self, program: moderngl.Program) -> None:
        """Set the uniforms that depend on the strips in use."""
        uploaded = self._uploaded
        set_stacks(program, self.rings)
        set_sizes(program, uploaded.forms)
        set_uniform_array(program, "pictures", uploaded.pictures)
        set_uniform(program, "stride", self.stride)
        set_uniform(program, "strips_per_plane", uploaded.strips_per_plane)
        set_uniform(program, "page_size", float(uploaded.atlas.width), float(uploaded.atlas.height))

    @property
    def stride(self) -> int:
        """Number of polygon strips set aside for a patch: the first of patch i has number i * `stride`."""
        return self._uploaded.strips_per_plane * max(ring.strips * ring.columns for ring in self.rings)

    def make_ready(self) -> None:
        """Reserve room for more than is usually shown, and compile the programs that write depth."""
        self._rows = READY_ROWS
        for shelf in self.shelves:
            shelf.reserve(READY_ROWS)
        for number in range(len(DEEP_PROGRAMS)):
            self.array(number, deep=True)

    def write(self, placements: NDArray[np.void]) -> None:
        """Upload the placements of the patches, ring after ring."""
        self.shelves.now.placements.write(placements)

    def write_strips(self, strips: NDArray[np.uint32]) -> None:
        """Upload the numbers of the polygon strips (n,), far to near."""
        self.shelves.now.strips.write(strips.view(NUMBER))

    def hear(self, ring: int, *, patch: int, first: int, count: int) -> int:
        """Compute the messages of a ring's `count` receivers from number `first` on; return the number of draw calls.

        `patch` is the index of the ring's first placement.
        """
        if not count:
            return 0
        self.shelves.now.placements.texture.use(self.units["placements"])
        array = self.hearing.array()
        set_uniform(array.program, "of_ring", ring, patch)
        return self.received.compute(array, first=first, count=count)

    @property
    def patch(self) -> float:
        """Side of a patch [m]."""
        return float(self._block.record["patch_side"][0])

    def draw(self, first: int, count: int, *, mode: int, deep: bool = False) -> int:
        """Draw `count` of the uploaded polygon strips, from the `first` on; return the number of draw calls.

        `mode` is `ALL_BLADES`, `BY_RANK` or `EDGED`. With `deep`, depth alone is written, where a strip covers at least
        half a pixel.
        """
        if not count:
            return 0
        self._uploaded.atlas.use(self.units["atlas"])
        self._uploaded.ranks.use(self.units["ranks"])
        shelf = self.shelves.now
        shelf.placements.texture.use(self.units["placements"])
        self._uploaded.extents.use(self.units["extents"])
        shelf.strips.texture.use(self.units["strips"])
        frame = self._block.record[0]
        is_cut = bool(frame["anything_cut"])
        is_shaded = bool(self._block.casts or frame["bodies"]["radius"].any())
        variant = 0 if deep else 2 if is_cut else int(is_shaded)
        array = self.array(len(MODES) * variant + mode, deep=deep)
        set_uniform(array.program, "first", first)
        array.render(moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=count)
        return 1

    def release(self) -> None:
        """Release all GL objects."""
        arrays = list(self._arrays.values())
        release_all(*arrays, *(array.program for array in arrays), self.hearing, self.shelves)
        release_all(self._uploaded, self._staged)


@dataclass(frozen=True, slots=True, eq=False)
class _Uploaded:
    """The textures of all forms' strips."""

    forms: Sequence[Form]
    rings: Sequence[StripRing]
    atlas: moderngl.TextureArray
    ranks: moderngl.TextureArray
    extents: moderngl.Texture

    @classmethod
    def of(cls, ctx: moderngl.Context, rings: Sequence[StripRing], forms: Sequence[Form], atlas: Atlas, /) -> Self:
        """Upload an atlas at once."""
        uploaded = at_once(_uploading(ctx, rings, forms, atlas))
        assert isinstance(uploaded, cls)
        return uploaded

    @property
    def strips_per_plane(self) -> int:
        """Largest number of strips in one plane: one of each kind, or two while any kind may change its form."""
        kinds = sum(form.number == form.kind for form in self.forms)
        return kinds if len(self.forms) == kinds else 2 * kinds

    @property
    def pictures(self) -> list[int]:
        """Index of the first picture by ring and form, with room for two forms of each kind."""
        room = 2 * sum(form.number == form.kind for form in self.forms)
        pictures, first = [0] * (room * len(self.rings)), 0
        for ring in range(len(self.rings)):
            for form in self.forms:
                pictures[ring * room + form.number] = first
                first += sum(2 * len(strips_of(model)[ring].plane) for model in form.growth.models)
        return pictures

    def release(self) -> None:
        """Release the textures."""
        release_all(self.atlas, self.ranks, self.extents)


def _uploading(
    ctx: moderngl.Context, rings: Sequence[StripRing], forms: Sequence[Form], atlas: Atlas, /
) -> Generator[None, None, _Uploaded]:
    """Upload an atlas a piece at a time."""
    texels = yield from sending_strips(ctx, atlas.texels)
    with released_unless_finished(texels):
        ranks = yield from sending_strips(ctx, atlas.ranks)
    return _Uploaded(forms, rings, texels, ranks, extent_texture(ctx, atlas.extents))


def set_stacks(program: moderngl.Program, rings: Sequence[StripRing], /) -> None:
    """Set the uniform `stacks` to each ring's number of columns, sections and strips."""
    stacks = [(ring.columns, ring.sections, ring.strips, 0) for ring in rings]
    set_uniform_array(program, "stacks", filled(stacks, room_for(len(rings))))


def set_sizes(program: moderngl.Program, forms: Sequence[Form], /) -> None:
    """Set the uniform `sizes`, if the program has it, to the margin and the height of each form's strips [m]."""
    sizes = [(0.0, 1.0)] * (2 * sum(form.number == form.kind for form in forms))
    for form in forms:
        strips = strips_of(form.growth.models[0])[0]
        sizes[form.number] = strips.margin, strips.height
    set_uniform_array(program, "sizes", sizes)
