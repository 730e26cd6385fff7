"""Drawing 2.5D strips, back to front: those of all rings together."""

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
from ....engine.gl.stream import Records, release_all
from ...frame.block import filled, joined, room_for
from ...grow.organs import any_heads
from ...grow.record import Form
from ..hearing import Hearing
from ..representation import Canvas
from .gather import LIES_AHEAD, OF_RING, RUNS_ALONG, STOOD
from .grow import strips_of
from .textures import Atlas, extent_texture, sending_strips

STOOD_ROW, STRIPS_ROW = 64, 1024
"""Records in a row of the textures that hold patches, and the numbers of polygon strips."""

READY_ROWS = 256
"""Rows of both that there is room for once a game has prepared."""

GLSL = record_lookup("Stood", STOOD, "stood", STOOD_ROW) + emitted(
    {"STRIPS_ROW": STRIPS_ROW, "RUNS_ALONG": RUNS_ALONG, "LIES_AHEAD": LIES_AHEAD, "OF_RING": OF_RING}
)

Sort = dict[str, str | int]
"""What a program is told."""


def _sorts(*special: Sort) -> list[Sort]:
    """Return what programs of some sorts are told, each with all blades, by rank, and where density has edges."""
    thin: Sort = {"THIN": 1}
    return [{**each, **more} for each in special for more in ({}, thin, thin | {"EDGED": 1})]


SORTS = _sorts({}, {"SHADED": 1}, {"SHADED": 1, "CUT": 1})
"""The programs that draw strips: of the usual, where shadows fall on it, and where any grass is cut besides."""

DEEP = _sorts({"DEEP": 1, "CUT": 1})
"""Those that write depth alone."""

WAYS = len(DEEP)
"""In how many ways strips of each sort are drawn."""

FILES = "systems/show/strips/strips.vert", "systems/show/strips/strips.frag"

NUMBER = np.dtype([("number", "u4")])


class StripShelf:
    """What is sent of one viewer's strips: the patches, and the numbers of the strips, in this many rows at first."""

    def __init__(self, ctx: moderngl.Context, rows: int) -> None:
        self.stood, self.strips = Records(ctx, STOOD, STOOD_ROW, rows=rows), Records(ctx, NUMBER, STRIPS_ROW, rows=rows)
        self.sent: object = None
        self.numbers: object = None
        """What was sent last, and the strips among it."""

    def reserve(self, rows: int) -> None:
        """Make room for so many rows; what was sent is lost."""
        self.stood.reserve(rows)
        self.strips.reserve(rows)
        self.sent = self.numbers = None

    def release(self) -> None:
        """Give everything back."""
        release_all(self.stood, self.strips)


class StripPainter:
    """Draws the strips of all rings; it owns their textures.

    `forms` are what there is of all kinds, and `atlas` is what `strip_atlas` makes of their strips.
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
        self._held = _Held.of(canvas.ctx, rings, forms, atlas)
        self._beside: _Held | None = None
        """What is brought into GL beside it."""
        self._rows = 64
        self.shelves = Shelves(lambda: StripShelf(canvas.ctx, self._rows))
        laid: dict[str, str | int] = {"RINGS": room_for(len(rings))}
        self.hearing = Hearing(canvas, "systems/show/strips/receivers.frag", laid, self._tell)
        self._heads = heads
        self._whole = laid | ({"HEADS": 1} if heads else {})
        self._made: dict[tuple[bool, int], moderngl.VertexArray] = {}
        self._untold: set[tuple[bool, int]] = set()
        """Those of them that have to be told how strips stand before they draw: of many, a frame draws with a few."""

    def texts(self) -> Iterator[Texts]:
        """Return what the programs that are not there yet are made of."""
        for number in range(len(SORTS)):
            if (False, number) not in self._made:
                yield self._block.texts(*FILES, self._whole | SORTS[number])

    def making(self) -> Iterator[None]:
        """Make the programs that are not there yet, one at a time."""
        for number in range(len(SORTS)):
            if (False, number) not in self._made:
                self.array(number)
                yield

    @property
    def extents(self) -> moderngl.Texture:
        """Where each picture is painted."""
        return self._held.extents

    @property
    def forms(self) -> Sequence[Form]:
        """What there is of all kinds."""
        return self._held.forms

    def fits(self, forms: Sequence[Form], /) -> bool:
        """Return whether its programs draw the strips of other forms too."""
        return any_heads(form.growth for form in forms) == self._heads

    def staging(self, forms: Sequence[Form], atlas: Atlas, /) -> Iterator[None]:
        """Bring other strips into GL beside those that are drawn, a piece at a time."""
        self._beside = yield from _holding(self._canvas.ctx, self.rings, forms, atlas)

    def restock(self) -> None:
        """Draw what was staged."""
        assert self._beside is not None
        self._held.release()
        self._held, self._beside = self._beside, None
        self.hearing.tell_again()
        self._untold = {*self._made}

    def array(self, number: int, *, deep: bool = False) -> moderngl.VertexArray:
        """Return what draws strips as programs of one of `SORTS` do, or of `DEEP`; it is made when it is asked for."""
        if (deep, number) not in self._made:
            canvas = self._canvas
            program = joined(
                canvas.ctx, canvas.block, canvas.units, *FILES, self._whole | (DEEP if deep else SORTS)[number]
            )
            self._tell(program)
            self._made[deep, number] = canvas.ctx.vertex_array(program, [])
        array = self._made[deep, number]
        if (deep, number) in self._untold:
            self._untold.remove((deep, number))
            self._tell(array.program)
        return array

    def _tell(self, made: moderngl.Program) -> None:
        """Tell a program how strips stand."""
        held = self._held
        tell_stacks(made, self.rings)
        tell_sizes(made, held.forms)
        set_uniform_array(made, "pictures", held.pictures)
        set_uniform(made, "most", self.most)
        set_uniform(made, "turns", held.turns)
        set_uniform(made, "page_size", float(held.atlas.width), float(held.atlas.height))

    @property
    def most(self) -> int:
        """Numbers of polygon strips that are set aside for a patch."""
        return self._held.turns * max(ring.strips * ring.columns for ring in self.rings)

    def make_ready(self) -> None:
        """Make room for more than is usually shown."""
        self._rows = READY_ROWS
        for shelf in self.shelves:
            shelf.reserve(READY_ROWS)
        for number in range(len(DEEP)):
            self.array(number, deep=True)

    def write(self, stood: NDArray[np.void]) -> None:
        """Send the patches, ring after ring."""
        self.shelves.now.stood.write(stood)

    def write_strips(self, strips: NDArray[np.uint32]) -> None:
        """Send the numbers of the polygon strips (n,), far to near."""
        self.shelves.now.strips.write(strips.view(NUMBER))

    def hear(self, ring: int, *, patch: int, first: int, count: int) -> int:
        """Ask the receivers of a ring's patches, whose first is number `patch`; return the number of draw calls."""
        if not count:
            return 0
        self.shelves.now.stood.texture.use(self.units["stood"])
        array = self.hearing.array()
        set_uniform(array.program, "of_ring", ring, patch)
        return self.received.ask(array, first=first, count=count)

    @property
    def patch(self) -> float:
        """Side of a patch [m]."""
        return float(self._block.record["patch_side"][0])

    def draw(self, first: int, count: int, *, thin: int, deep: bool = False) -> int:
        """Draw `count` of what was written, from the `first` on; return the number of draw calls.

        With a `thin` of 1, blades are drawn by rank: only those that the density and the patch's `ranks` leave. With 2,
        density has edges. With `deep`, depth alone is written, where a strip covers at least half a pixel.
        """
        if not count:
            return 0
        self._held.atlas.use(self.units["atlas"])
        self._held.ranks.use(self.units["ranks"])
        shelf = self.shelves.now
        shelf.stood.texture.use(self.units["stood"])
        self._held.extents.use(self.units["extents"])
        shelf.strips.texture.use(self.units["strips"])
        frame = self._block.record[0]
        is_cut = bool(frame["anything_cut"])
        is_shaded = bool(self._block.casts or frame["bodies"]["radius"].any())
        rare = 0 if deep else 2 if is_cut else int(is_shaded)
        array = self.array(WAYS * rare + thin, deep=deep)
        set_uniform(array.program, "first", first)
        array.render(moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=count)
        return 1

    def release(self) -> None:
        """Give everything back."""
        arrays = list(self._made.values())
        beside = [] if self._beside is None else [self._beside]
        release_all(*arrays, *(array.program for array in arrays), self.hearing, self.shelves)
        release_all(self._held, *beside)


@dataclass(frozen=True, slots=True, eq=False)
class _Held:
    """The strips of all forms in GL."""

    forms: Sequence[Form]
    rings: Sequence[StripRing]
    atlas: moderngl.TextureArray
    ranks: moderngl.TextureArray
    extents: moderngl.Texture

    @classmethod
    def of(cls, ctx: moderngl.Context, rings: Sequence[StripRing], forms: Sequence[Form], atlas: Atlas, /) -> Self:
        """Return them at once."""
        held = at_once(_holding(ctx, rings, forms, atlas))
        assert isinstance(held, cls)
        return held

    @property
    def turns(self) -> int:
        """How many strips may stand in one place: of each kind, and where any is to become another, as many again."""
        kinds = sum(form.number == form.kind for form in self.forms)
        return kinds if len(self.forms) == kinds else 2 * kinds

    @property
    def pictures(self) -> list[int]:
        """The first of each form's pictures, by ring and form; there is room for two forms of each kind."""
        most = 2 * sum(form.number == form.kind for form in self.forms)
        found, first = [0] * (most * len(self.rings)), 0
        for ring in range(len(self.rings)):
            for form in self.forms:
                found[ring * most + form.number] = first
                first += sum(2 * len(strips_of(model)[ring].plane) for model in form.growth.models)
        return found

    def release(self) -> None:
        """Give everything back."""
        release_all(self.atlas, self.ranks, self.extents)


def _holding(
    ctx: moderngl.Context, rings: Sequence[StripRing], forms: Sequence[Form], atlas: Atlas, /
) -> Generator[None, None, _Held]:
    """Bring the strips of all forms into GL a piece at a time."""
    texels = yield from sending_strips(ctx, atlas.texels)
    ranks = yield from sending_strips(ctx, atlas.ranks)
    return _Held(forms, rings, texels, ranks, extent_texture(ctx, atlas.extents))


def tell_stacks(made: moderngl.Program, rings: Sequence[StripRing], /) -> None:
    """Tell a program how many columns, sections and strips each ring has."""
    stacks = [(ring.columns, ring.sections, ring.strips, 0) for ring in rings]
    set_uniform_array(made, "stacks", filled(stacks, room_for(len(rings))))


def tell_sizes(made: moderngl.Program, forms: Sequence[Form], /) -> None:
    """Tell a program how far strips of each form reach beyond their patch, and how high they are [m], if it asks."""
    sizes = [(0.0, 1.0)] * (2 * sum(form.number == form.kind for form in forms))
    for form in forms:
        strips = strips_of(form.growth.models[0])[0]
        sizes[form.number] = strips.margin, strips.height
    set_uniform_array(made, "sizes", sizes)
