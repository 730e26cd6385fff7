"""Painting blades: the morphing ones first, then all rings from far to near."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import prod
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ....engine.declared.quality import Quality
from ....engine.gl.mipmaps import at_once
from ....engine.gl.remembered import Remembered, Shelves
from ....engine.gl.shaders import Texts, set_uniform
from ....engine.gl.stream import Records, Stream, release_all
from ...around.appearance import handed_over
from ...around.outlook import Outlook
from ...frame.block import room_for
from ...space.grown import Grown
from ..hearing import Hearing
from ..representation import Canvas, RepresentationPainter
from ..strips.draw import set_sizes, set_stacks
from ..strips.pool import StripsKept
from ..strips.representation import StripRepresentation
from ..strips.shown import StripsShown
from .draw import CORES, DEEP, EDGES, PAINTED, RIBBON, Ribbons, blade_program
from .gather import Numbers, distances, gather_blades, may_be_seen
from .morph import at_home, gather_morph
from .plant import BladeStock, rank_bounds
from .pool import BladePool, BladesKept
from .shown import BladesShown, Standing, together
from .store import STANDING, STANDING_ROW, BladeStore, storing

PARTED = 1
"""Distance up to which the depth buffer sorts blades [patch sides]."""

HIDING = 400
"""Blades per patch from which on it pays to compute the height up to which each is hidden. With 320 that costs a
graphics card as much as it saves; with 160 it costs more than it saves."""

WHOLE_EDGE = 0.5
"""Half the width of soft edges that shaders have by themselves [pixels]."""

READY_ROWS = 256
"""Rows of patch records that are allocated once a game has prepared."""

NUMBER = np.dtype([("number", "u4")])


@dataclass(frozen=True, slots=True, eq=False)
class _Order:
    """Blades in drawing order: the morphing ones, then those of each group of rings."""

    numbers: Numbers
    counts: list[int]
    """Number of morphing blades, then of those of each group."""


@dataclass(frozen=True, slots=True, eq=False)
class _Upload:
    """Data of a frame for the graphics card."""

    standing: NDArray[np.void]
    """Patches with blades, records of `STANDING`."""

    order: _Order


class _Shelf:
    """Buffers of one viewer: records of patches, with room for `rows` rows at first, and numbers of blades."""

    def __init__(self, ctx: moderngl.Context, passes: Sequence[moderngl.Program], rows: int) -> None:
        self.standing, self.numbers = Records(ctx, STANDING, STANDING_ROW, rows=rows), Stream(ctx, NUMBER)
        self.arrays = [ctx.vertex_array(program, [self.numbers.binding(program, each="/v")]) for program in passes]
        self.counts: list[int] = []
        """Number of morphing blades, then of those of each group, in `numbers`."""
        self.sent: _Upload | None = None
        """Data that `standing` and `numbers` hold, None if that is lost."""
        self._order: _Order | None = None
        """Blades that `numbers` holds."""

    def send(self, upload: _Upload) -> None:
        """Write a frame's data to the buffers."""
        self.standing.write(upload.standing)
        if upload.order is not self._order:
            self.numbers.write(upload.order.numbers.view(NUMBER))
        self.counts, self.sent, self._order = [*upload.order.counts], upload, upload.order

    def reserve(self, rows: int) -> None:
        """Make room for `rows` rows of patches; records sent before are lost."""
        self.standing.reserve(rows)
        self.sent = None

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.arrays, self.standing, self.numbers)


class BladesPainter(RepresentationPainter):
    """Draws the blades of all rings and the blades that morph into strips."""

    def __init__(self, canvas: Canvas, stock: BladeStock, strips: StripRepresentation, quality: Quality) -> None:
        ctx, block, units, rings = canvas.ctx, canvas.block, canvas.units, quality.blade_rings
        self.ctx, self._stock, self.store = ctx, stock, at_once(storing(ctx, stock, strips.stock))
        self._staged: tuple[BladeStock, StripRepresentation, BladeStore] | None = None
        """Stock, strips and store that `restock` takes over."""
        self._strips, self._units, self._received, self._models = strips, units, canvas.received, len(stock.rank)
        self._fade, self._patch, self._near = canvas.transitions.fade, quality.patch, PARTED * quality.patch
        defines = {**self.store.defines, "STORED": 1, "RINGS": room_for(len(quality.strip_rings))}
        hiding = {"HIDING": 1} if quality.blades >= HIDING else {}
        edge = {"EDGE": repr(quality.edge)} if quality.edge < WHOLE_EDGE else {}
        self.hearing = Hearing(canvas, "systems/show/blades/receivers.frag", defines, self._set_uniforms)
        self.passes = [
            blade_program(ctx, block, units, record, defines | hiding | morph)
            for record, morph in ((RIBBON, {}), (PAINTED, {"MORPH": 1}))
        ]
        for program in self.passes:
            self._set_uniforms(program)
        self._rows = 64
        self.shelves = Shelves(lambda: _Shelf(ctx, self.passes, self._rows))
        segments = [ring.segments for ring in rings]
        self._parted_rings = 1 + sum(ring.to < PARTED for ring in rings[:-1])
        self.groups = [
            Ribbons(ctx, block, counts, units, soft=True, parted=parted, defines={**self.store.organs, **edge})
            for parted, counts in ((True, segments[: self._parted_rings + 1]), (False, segments[self._parted_rings :]))
            if counts
        ]
        self.morph = Ribbons(
            ctx, block, segments[-1:], units, soft=True, record=PAINTED, defines={**defines, **edge, "MORPH": 1},
            set_uniforms=self._set_uniforms,
        )  # fmt: skip
        self._orders, self._uploads = Remembered[_Order](), Remembered[_Upload]()
        self._first_receiver = self._receiver_count = 0
        self._viewer = 0.0, 0.0, 1.0
        """Place of the viewer's eye (x, z) [m], and its zoom."""

    def _set_uniforms(self, program: moderngl.Program) -> None:
        """Set a program's uniforms about blades and strips."""
        for name, value in (("near", self._near), ("models", self._models), ("each", self.store.count)):
            set_uniform(program, name, value)
        set_sizes(program, self._strips.stock)
        set_stacks(program, self._strips.quality.strip_rings)

    def texts(self) -> Iterator[Texts]:
        """Return the sources of the ribbons' programs that are not made yet."""
        for ribbons in (self.morph, *self.groups):
            yield from ribbons.texts()

    def making(self) -> Iterator[None]:
        """Make the ribbons' programs that are missing, one at a time."""
        for ribbons in (self.morph, *self.groups):
            yield from ribbons.making()

    def fits(self, representation: Any, /) -> bool:
        """Return whether blades of another stock have records of the same fields."""
        return bool(representation.stock.records.dtype == self._stock.records.dtype)

    def staging(self, stocks: Mapping[str, Any], /) -> Iterator[None]:
        """Send the blades of another stock to GL, a piece at a time; the current ones stay."""
        release_all(self._staged and self._staged[2])
        self._staged = None
        stock, strips = stocks["blades"].stock, stocks["strips"]
        self._staged = stock, strips, (yield from storing(self.ctx, stock, strips.stock))

    def restock(self) -> None:
        """Replace the stock by the staged one."""
        assert self._staged is not None
        self.store.release()
        (self._stock, self._strips, self.store), self._staged = self._staged, None
        self.hearing.update_uniforms()
        self.morph.update_uniforms()
        for program in self.passes:
            self._set_uniforms(program)
        self._orders, self._uploads = Remembered[_Order](), Remembered[_Upload]()

    def making_for_winds(self) -> Iterator[None]:
        """Compile the programs of the receivers' pass for all orders of winds, one at a time."""
        return self.hearing.making()

    def make_ready(self, grown: Grown, /) -> None:
        """Allocate more patch records than are usually shown, and make the programs that write depth."""
        self._rows = READY_ROWS
        for shelf in self.shelves:
            shelf.reserve(READY_ROWS)
        for ribbons in (self.morph, *self.groups):
            ribbons.array(DEEP)

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Let the frame draw one morphing blade and one of each group, if it has as many, so that all programs run."""
        shelf = self.shelves.now
        if sum(shelf.counts) >= len(shelf.counts):
            shelf.counts, shelf.sent = [1] * len(shelf.counts), None

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return the number of blades on the patches shown, in a list of one."""
        shown = outlook.shows(BladesShown)
        return [len(shown.standing.rows) * self.store.count]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Send the patches with blades and the numbers of the blades to draw; return the number of these."""
        kept, shown, strips = outlook.keeps(BladesKept), outlook.shows(BladesShown), outlook.shows(StripsShown)
        made_of = (
            outlook.view, shown, strips, outlook.appearance, kept, kept.planted, outlook.keeps(StripsKept), self._came,
            *first["strips"], *first["blades"],
        )  # fmt: skip
        shelf = self.shelves.of(outlook.viewer.name, outlook)
        upload = self._uploads.of(outlook.viewer.name, made_of, partial(self._upload, outlook, first))
        if upload is not shelf.sent:
            shelf.send(upload)
        (self._receiver_count,), (self._first_receiver,) = self.receivers(outlook), first["blades"]
        self._viewer = outlook.viewer.eye[0], outlook.viewer.eye[2], outlook.lens.zoom
        return sum(shelf.counts)

    def _upload(self, outlook: Outlook, first: Mapping[str, list[int]]) -> _Upload:
        """Return the data of a viewer's frame; the order is kept while nothing morphs and eye and patches stay."""
        kept, shown, viewer = outlook.keeps(BladesKept), outlook.shows(BladesShown), outlook.viewer
        left, _ = handed_over(outlook.appearance.handed[shown.morphing.rows], fade=self._fade)
        slots, places = shown.standing.slots, (ring.places.tobytes() for ring in shown.rings)
        pool = kept.pool
        planted = pool, slots, *(column.take(slots, axis=0) for column in (pool.stamp, pool.ground, pool.sown))
        made_of = None if len(shown.morphing.rows) else (viewer.eye, viewer.sides, self._came, *planted, *places)
        order = self._orders.of(viewer.name, made_of, partial(self._gather, outlook, pool, shown, left))
        return _Upload(self._standing(outlook, shown, left, first["strips"]), order)

    def _gather(self, outlook: Outlook, pool: BladePool, shown: BladesShown, left: Floats) -> _Order:
        """Return the blades in drawing order; those that are almost home are sorted into the last group."""
        eye, moving = (outlook.viewer.eye[0], outlook.viewer.eye[2]), shown.morphing
        away, due = distances(pool, moving.slots, eye), self._of_form(outlook, moving)
        home = at_home(outlook, moving, away)
        groups = [together(rings) for rings in self._grouped(shown.rings)]
        masks = self._may_be_seen(outlook, pool, groups)
        if home.any():
            groups[-1], masks[-1] = together([groups[-1], moving]), np.concatenate([masks[-1], home & due])
        numbers = [
            gather_morph(outlook, pool, self._strips, moving, away=away, left=left, home=home | ~due),
            *(
                gather_blades(pool, group, eye=eye, stand=mask, to=self._drawn_to(outlook, group))
                for group, mask in zip(groups, masks, strict=True)
            ),
        ]
        return _Order(np.concatenate(numbers), [len(part) for part in numbers])

    def _may_be_seen(self, outlook: Outlook, pool: BladePool, groups: list[Standing]) -> list[NDArray[np.bool_]]:
        """Return a mask of the blades of each group that may be in the picture, of the form that they have now."""
        slots = np.concatenate([group.slots for group in groups])
        ends = np.cumsum([len(group.slots) for group in groups])
        seen = may_be_seen(pool, slots, outlook.viewer.sides, reach=self._stock.reach, patch=self._patch)
        masks = np.split(seen, ends[:-1])
        if not self._came:
            return masks
        return [mask & self._of_form(outlook, group) for mask, group in zip(masks, groups, strict=True)]

    def _drawn_to(self, outlook: Outlook, shown: Standing) -> Floats:
        """Return the distance from which on each blade is left out [m], shape (m, blades)."""
        patches, rows = outlook.patches, shown.rows
        drawn_to = self._stock.drawn_to.take(patches.model[rows] * 4 + patches.turn[rows], axis=0)
        drawn_to *= np.float32(outlook.lens.zoom)
        return drawn_to

    def _of_form(self, outlook: Outlook, shown: Standing) -> NDArray[np.bool_]:
        """Return a mask of the blades of the form that plants of their rank have now, shape (m, blades)."""
        least, most = rank_bounds(self._stock, self._came)
        rank = self._stock.rank[outlook.patches.model[shown.rows]]
        return np.asarray((rank >= least) & (rank < most))

    def _grouped(self, rings: list[Standing]) -> list[list[Standing]]:
        """Return the parted rings, and the others; the blades of a group are drawn together."""
        return [rings[: self._parted_rings], rings[self._parted_rings :]][: len(self.groups)]

    def _standing(self, outlook: Outlook, shown: BladesShown, left: Floats, first: list[int]) -> NDArray[np.void]:
        """Return the patches with blades as records of `STANDING`.

        `left` is the cover of the morphing patches, `first` the number of each strip ring's first receiver.
        """
        patches, rows = outlook.patches, shown.standing.rows
        standing = np.zeros(len(rows), STANDING)
        standing["cell"], standing["model_turn"] = patches.cell[rows], patches.model[rows] * 4 + patches.turn[rows]
        for rings in self._grouped(shown.rings):
            for number, ring in enumerate(rings):
                standing["cover"][ring.places], standing["sublevel"][ring.places] = ring.cover, number + ring.slide
        if len(shown.morphing.rows):
            _set_morph(standing, outlook, shown.morphing, self._strips, first)
            standing["cover"][shown.morphing.places] = left
            standing["sublevel"][shown.morphing.places] = len(self._grouped(shown.rings)[-1]) - 1
        return standing

    def hear(self) -> int:
        """Write the wind's messages to all blades; return the number of draw calls."""
        self.store.blades.texture.use(self._units["blades"])
        self.shelves.now.standing.texture.use(self._units["standing"])
        return self._received.compute(self.hearing.array(), first=self._first_receiver, count=self._receiver_count)

    def look_anew(self) -> int:
        """Run the pass over blades, which computes what is the same along a ribbon; return the number of draw calls."""
        self.store.blades.texture.use(self._units["blades"])
        shelf = self.shelves.now
        shelf.standing.texture.use(self._units["standing"])
        self.store.slices.use(self._units["slices"])
        for program in self.passes:
            set_uniform(program, "blades_from", self._first_receiver)
            set_uniform(program, "viewer", *self._viewer)
        calls = first = 0
        for ribbons, count in zip((self.morph, *self.groups), shelf.counts, strict=True):
            calls += ribbons.fill(shelf.arrays[ribbons is self.morph], count, first=first)
            first += count
        return calls

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw all blades; return the number of draw calls."""
        calls = self.look_anew()
        self.store.targets.use(self._units["targets"])
        calls += self.morph.draw()
        near, *far = self.groups
        calls += sum(ribbons.draw() for ribbons in far)
        # Around the viewer no order is right for all directions: depth sorts the blades, then their edges are blended.
        target.depth_mask = True
        calls += near.draw(CORES)
        target.depth_mask = False
        return calls + near.draw(EDGES)

    def draw_deep(self) -> int:
        """Write the depth of all blades; return the number of draw calls."""
        self.store.targets.use(self._units["targets"])
        return sum(ribbons.draw_deep() for ribbons in (self.morph, *self.groups))

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.groups, self.morph, self.shelves, *self.passes, self.hearing)
        release_all(self.store, self._staged and self._staged[2])


def _set_morph(
    standing: NDArray[np.void], outlook: Outlook, shown: Standing, strips: StripRepresentation, first: list[int]
) -> None:
    """Set the fields about morph and strips in the records of the morphing patches.

    `first` has the number of each strip ring's first receiver.
    """
    appears, rows, places = outlook.appearance, shown.rows, shown.places
    ring, along = strips.ring_and_axis(outlook, rows)
    standing["morph"][places], standing["growth"][places] = appears.morph[rows], appears.growth[rows]
    standing["along"][places], standing["ring"][places] = along, ring
    for number in np.unique(ring).tolist():
        in_ring = ring == number
        index = np.zeros(len(appears.morph), np.int64)
        strip_rows = outlook.shows(StripsShown).rings[number].rows
        index[strip_rows] = np.arange(len(strip_rows))
        receivers = prod(outlook.keeps(StripsKept).pools[number].shape)
        standing["first_edge"][places[in_ring]] = first[number] + index[rows[in_ring]] * receivers
