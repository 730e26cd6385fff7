"""The painter of strips: it draws all rings in one order, from far to near."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from math import prod
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Mask
from ....engine.declared.quality import Quality
from ....engine.gl.mipmaps import at_once
from ....engine.gl.remembered import Remembered, Shelves
from ....engine.gl.shaders import Texts, set_uniform, set_uniform_array
from ....engine.gl.stream import release_all
from ...around.outlook import Outlook
from ...frame.block import joined, room_for
from ...grow.organs import any_heads
from ...space.cone import distance_in_order
from ...space.grown import Grown
from ..hearing import Hearing
from ..representation import Canvas, RepresentationPainter
from .draw import (
    DEEP_PROGRAMS,
    FILES,
    MODES,
    NUMBER,
    PROGRAMS,
    READY_ROWS,
    Defines,
    StripShelf,
    Uploaded,
    set_sizes,
    set_stacks,
    uploading,
)
from .gather import ALL_BLADES, BY_RANK, EDGED, Batch, batches, gather_strips, modes_of, polygon_strips
from .pool import StripPool, StripsKept
from .shown import StripsOfRing, StripsShown
from .stock import StripStock
from .textures import Atlas

Order = tuple[NDArray[np.uint32], NDArray[np.int64]]
"""Polygon strips in the order of drawing, and the number of them on each patch."""


@dataclass(frozen=True, slots=True, eq=False)
class Gathered:
    """Uploads and drawing of a frame."""

    placements: NDArray[np.void]
    strips: NDArray[np.uint32]
    """Numbers of the polygon strips, far to near."""

    batches: list[Batch]

    distance: Doubles
    """Distance of each drawn patch, as `distance_in_order` has it [patch sides], in drawing order, shape (m,)."""

    ends: NDArray[np.int64]
    """Index after each drawn patch's last polygon strip, shape (m,)."""

    receivers: list[tuple[int, int, int]]
    """By ring: its first patch, its first receiver, and the number of its receivers."""


class StripsPainter(RepresentationPainter):
    """Draws the strips of all rings from far to near."""

    def __init__(self, canvas: Canvas, stock: StripStock, quality: Quality, atlas: Atlas) -> None:
        self._canvas, self._block, self.rings = canvas, canvas.block, quality.strip_rings
        self._fade = canvas.transitions.fade
        self.sections = max(ring.sections for ring in self.rings)
        self.uploaded = at_once(uploading(canvas.ctx, self.rings, stock, atlas))
        """Textures of the strips in use."""
        self._staged: Uploaded | None = None
        self._rows = 64
        self.shelves = Shelves(lambda: StripShelf(canvas.ctx, self._rows))
        shared: Defines = {"RINGS": room_for(len(self.rings))}
        self.hearing = Hearing(canvas, "systems/show/strips/receivers.frag", shared, self._set_uniforms)
        self._heads = any_heads(form.growth for form in stock.forms)
        self._defines = shared | ({"HEADS": 1} if self._heads else {})
        self._arrays: dict[tuple[bool, int], moderngl.VertexArray] = {}
        """Vertex arrays by `deep` and the number of the program."""
        self._outdated: set[tuple[bool, int]] = set()
        """Arrays whose program has old uniforms. They are set when it draws, as a frame needs few of the programs."""
        self.batches: list[Batch] = []
        self._drawn = 0
        """Number of polygon strips that this frame has drawn."""
        self.now: Gathered | None = None
        """Uploads and drawing of the current frame."""
        self._gathered, self._ordered = Remembered[Gathered](), Remembered[Order]()

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

    def making_for_winds(self) -> Iterator[None]:
        """Compile the programs of the receivers' pass for all orders of winds, one at a time."""
        return self.hearing.making()

    def make_ready(self, grown: Grown, /) -> None:
        """Reserve room for more than is usually shown, and compile the programs that write depth."""
        self._rows = READY_ROWS
        for shelf in self.shelves:
            shelf.reserve(READY_ROWS)
        for number in range(len(DEEP_PROGRAMS)):
            self.array(number, deep=True)

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
        uploaded, stock = self.uploaded, self.uploaded.stock
        set_stacks(program, self.rings)
        set_sizes(program, stock)
        set_uniform_array(program, "pictures", stock.pictures)
        set_uniform(program, "stride", uploaded.stride)
        set_uniform(program, "strips_per_plane", stock.strips_per_plane)
        set_uniform(program, "page_size", float(uploaded.atlas.width), float(uploaded.atlas.height))

    def fits(self, representation: Any, /) -> bool:
        """Return whether the programs can draw another stock too."""
        return any_heads(form.growth for form in representation.stock.forms) == self._heads

    def staging(self, stocks: Mapping[str, Any], /) -> Iterator[None]:
        """Upload the pictures of a new stock beside those in use, a piece at a time."""
        release_all(self._staged)
        self._staged = None
        new = stocks["strips"]
        self._staged = yield from uploading(self._canvas.ctx, self.rings, new.stock, new.atlas())

    def restock(self) -> None:
        """Replace the stock in use by the staged one."""
        assert self._staged is not None
        self.uploaded.release()
        self.uploaded, self._staged = self._staged, None
        self.hearing.update_uniforms()
        self._outdated = {*self._arrays}
        self._gathered, self._ordered = Remembered[Gathered](), Remembered[Order]()

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Let the frame draw its first batch in all modes, so that the driver has run all programs."""
        modes = ALL_BLADES, BY_RANK, EDGED
        self.batches = [Batch(first, count, mode) for first, count, _ in self.batches[:1] for mode in modes]

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return the number of strip edges in each ring."""
        return [len(receiving.rows) * receiving.per_slot for receiving in outlook.keeps(StripsKept).receiving]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Upload placements and polygon strips where they have changed; return 0, as strips are no blades."""
        kept, shown, centre = outlook.keeps(StripsKept), outlook.shows(StripsShown), outlook.viewer.centre
        made_of = shown, outlook.appearance, kept, kept.planted, centre, self._came, *first["strips"]
        shelf = self.shelves.of(outlook.viewer.name, outlook)
        now = self._gathered.of(outlook.viewer.name, made_of, partial(self._gather, outlook, first))
        if now is not shelf.sent:
            shelf.placements.write(now.placements)
            if now.strips is not shelf.numbers:
                shelf.strips.write(now.strips.view(NUMBER))
            shelf.sent, shelf.numbers = now, now.strips
        self.batches, self.now, self._drawn = now.batches, now, 0
        return 0

    def _gather(self, outlook: Outlook, first: Mapping[str, list[int]]) -> Gathered:
        rings, appears, centre = _rings(outlook), outlook.appearance, outlook.viewer.centre
        shown = [ring for _, ring in rings]
        numbered = [(start, prod(pool.shape)) for start, (pool, _) in zip(first["strips"], rings, strict=True)]
        placements = gather_strips(shown, numbered, appears, outlook.patches, centre, fade=self._fade)
        first_patch = accumulate((len(ring.rows) for ring in shown), initial=0)
        receivers = list(zip(first_patch, first["strips"], self.receivers(outlook), strict=False))
        queue = np.argsort(np.concatenate([ring.queue for ring in shown]), kind="stable")
        patch = queue[placements["cover"].take(queue) > 0.0]
        present = np.concatenate([pool.present.take(ring.slots, axis=0) for pool, ring in rings]).take(patch, axis=0)
        present = self._of_forms(present)
        fineness = [(ring.strips, ring.columns) for ring in self.rings]
        order = partial(polygon_strips, placements, patch, present, fineness, stride=self.uploaded.stride)
        strips, count = self._ordered.of(outlook.viewer.name, (placements["code"], patch, present), order)
        drawn = batches(modes_of(rings, changes=self._changes).take(patch), count)
        distance = distance_in_order(placements["cell"].take(patch, axis=0).astype(np.int32), centre)
        return Gathered(placements, strips, drawn, distance, np.cumsum(count), receivers)

    @property
    def _changes(self) -> bool:
        """Whether any kind is changing its form."""
        return any(0.0 < came < 1.0 for came in self._came)

    def _of_forms(self, present: Mask) -> Mask:
        """Return the forms that stand on patches, (m, forms), of the kinds that are `present` there, (m, kinds)."""
        if not self._came:
            return present
        came, coming = np.array(self._came), np.zeros(present.shape[1], np.bool_)
        coming[[form.kind for form in self.uploaded.stock.forms if form.number != form.kind]] = True
        return np.concatenate([present & (came < 1.0), present & coming & (came > 0.0)], axis=1)

    def hear(self) -> int:
        """Compute the messages of all strip edges; return the number of draw calls."""
        calls = 0
        for ring, (patch, first, count) in enumerate([] if self.now is None else self.now.receivers):
            if count:
                self.shelves.now.placements.texture.use(self._canvas.units["placements"])
                array = self.hearing.array()
                set_uniform(array.program, "of_ring", ring, patch)
                calls += self._canvas.received.compute(array, first=first, count=count)
        return calls

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the strips that this frame has not drawn yet; return the number of draw calls."""
        calls = self._draw_to(None)
        self._drawn = 0
        return calls

    @property
    def patch(self) -> float:
        """Side of a patch, as shaders and trees have it [m]."""
        return float(self._block.record["patch_side"][0])

    @property
    def farthest(self) -> float:
        """Distance of the farthest patch with strips [m]; 0 for none."""
        if self.now is None or not len(self.now.distance):
            return 0.0
        return float(self.now.distance[0]) * self.patch

    def draw_beyond(self, distance: float, /) -> int:
        """Draw the strips of patches at a distance or beyond it [m]; return the number of draw calls."""
        assert self.now is not None
        beyond = int((self.now.distance * self.patch >= distance).sum())
        return self._draw_to(int(self.now.ends[beyond - 1])) if beyond else 0

    def _draw_to(self, end: int | None) -> int:
        """Draw the polygon strips before number `end` that are not drawn yet; return the number of draw calls."""
        calls, done = 0, self._drawn
        for start, count, mode in self.batches:
            first, last = max(start, done), start + count if end is None else min(start + count, end)
            if last > first:
                calls += self.draw_strips(first, last - first, mode=mode)
                self._drawn = last
        return calls

    def draw_strips(self, first: int, count: int, *, mode: int, deep: bool = False) -> int:
        """Draw `count` of the uploaded polygon strips, from the `first` on; return the number of draw calls.

        `mode` is `ALL_BLADES`, `BY_RANK` or `EDGED`. With `deep`, depth alone is written, where a strip covers at least
        half a pixel.
        """
        if not count:
            return 0
        units, uploaded, shelf, frame = self._canvas.units, self.uploaded, self.shelves.now, self._block.record[0]
        uploaded.atlas.use(units["atlas"])
        uploaded.ranks.use(units["ranks"])
        shelf.placements.texture.use(units["placements"])
        uploaded.extents.use(units["extents"])
        shelf.strips.texture.use(units["strips"])
        is_shaded = bool(self._block.given.casts or frame["bodies"]["radius"].any())
        variant = 0 if deep else 2 if frame["anything_cut"] else int(is_shaded)
        array = self.array(len(MODES) * variant + mode, deep=deep)
        set_uniform(array.program, "first", first)
        array.render(moderngl.TRIANGLE_STRIP, vertices=2 * self.sections + 2, instances=count)
        return 1

    def draw_deep(self) -> int:
        """Write the depth of all batches; return the number of draw calls."""
        return sum(self.draw_strips(first, count, mode=mode, deep=True) for first, count, mode in self.batches)

    def release(self) -> None:
        """Release all GL objects."""
        arrays = list(self._arrays.values())
        release_all(*arrays, *(array.program for array in arrays), self.hearing, self.shelves)
        release_all(self.uploaded, self._staged)


def _rings(outlook: Outlook) -> list[tuple[StripPool, StripsOfRing]]:
    """Return the pool of each ring, and its patches that are shown."""
    return list(zip(outlook.keeps(StripsKept).pools, outlook.shows(StripsShown).rings, strict=True))
