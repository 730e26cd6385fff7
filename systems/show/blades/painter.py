"""Painting blades: those on their way first, then all rings from far to near."""

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
from ....engine.gl.remembered import Remembered, Shelves
from ....engine.gl.shaders import Texts, set_uniform
from ....engine.gl.stream import Records, Stream, release_all
from ...around.appearance import handed_over
from ...around.outlook import Outlook
from ...frame.block import room_for
from ...space.grown import Grown
from ..hearing import Hearing
from ..representation import Canvas, RepresentationPainter
from ..strips.draw import tell_sizes, tell_stacks
from ..strips.pool import StripsKept
from ..strips.representation import StripRepresentation
from ..strips.shown import StripsShown
from .draw import CORES, DEEP, EDGES, PAINTED, RIBBON, Ribbons, blade_program
from .gather import Numbers, distances, gather_blades, may_be_seen
from .morph import at_home, gather_morph
from .plant import BladeStock, standing_of
from .pool import BladePool, BladesKept
from .shown import BladesShown, Standing, together
from .store import STANDING, STANDING_ROW, BladeStore

PARTED = 1
"""Distance up to which blades hide one another by depth [patch sides]."""

HIDING = 400
"""Blades of a patch from which on it pays to make out up to where each is hidden: with fewer that costs a graphics card
as much as it saves (320), or more (160)."""

READY_ROWS = 256
"""Rows of patches that there is room for once a game has prepared."""

NUMBER = np.dtype([("number", "u4")])


@dataclass(frozen=True, slots=True, eq=False)
class _Gathered:
    """The numbers of blades, group after group, and how many each has."""

    numbers: Numbers
    counts: list[int]


@dataclass(frozen=True, slots=True, eq=False)
class _Told:
    """What is sent of a frame: the patches, and the numbers of the blades."""

    standing: NDArray[np.void]
    numbers: "_Gathered"


class _Shelf:
    """What is sent of one viewer's blades: the patches, in this many rows at first, and the blades' numbers."""

    def __init__(self, ctx: moderngl.Context, passes: Sequence[moderngl.Program], rows: int) -> None:
        self.standing, self.numbers = Records(ctx, STANDING, STANDING_ROW, rows=rows), Stream(ctx, NUMBER)
        self.arrays = [ctx.vertex_array(made, [self.numbers.binding(made, each="/v")]) for made in passes]
        self.counts: list[int] = []
        self.sent: _Told | None = None
        self._gathered: _Gathered | None = None
        """What was sent last, and the numbers among it."""

    def send(self, told: _Told) -> None:
        """Send what its viewer is shown."""
        self.standing.write(told.standing)
        if told.numbers is not self._gathered:
            self.numbers.write(told.numbers.numbers.view(NUMBER))
        self.counts, self.sent, self._gathered = [*told.numbers.counts], told, told.numbers

    def reserve(self, rows: int) -> None:
        """Make room for so many rows of patches; those that were sent are lost."""
        self.standing.reserve(rows)
        self.sent = None

    def release(self) -> None:
        """Give everything back."""
        release_all(*self.arrays, self.standing, self.numbers)


class BladesPainter(RepresentationPainter):
    """Draws the blades of all rings, and those on their way to their strips."""

    def __init__(self, canvas: Canvas, stock: BladeStock, strips: StripRepresentation, quality: Quality) -> None:
        ctx, block, units, rings = canvas.ctx, canvas.block, canvas.units, quality.blade_rings
        self.ctx, self._stock, self.store = ctx, stock, BladeStore(ctx, stock, strips.stock)
        self._beside: tuple[BladeStock, StripRepresentation, BladeStore] | None = None
        """What is brought into GL beside them."""
        self._came: tuple[float, ...] = ()
        self._strips, self._units, self._received, self._models = strips, units, canvas.received, len(stock.rank)
        self._fade, self._patch, self._near = canvas.transitions.fade, quality.patch, PARTED * quality.patch
        laid = {**self.store.defines, "STORED": 1, "RINGS": room_for(len(quality.strip_rings))}
        hiding = {"HIDING": 1} if quality.blades >= HIDING else {}
        self.hearing = Hearing(canvas, "systems/show/blades/receivers.frag", laid, self._tell)
        self.passes = [
            blade_program(ctx, block, units, record, defines)
            for record, defines in ((RIBBON, laid | hiding), (PAINTED, {**laid, **hiding, "MORPH": 1}))
        ]
        for made in self.passes:
            self._tell(made)
        self._rows = 64
        self.shelves = Shelves(lambda: _Shelf(ctx, self.passes, self._rows))
        segments = [ring.segments for ring in rings]
        self._parted = 1 + sum(ring.to < PARTED for ring in rings[:-1])
        self.groups = [
            Ribbons(ctx, block, counts, units, soft=True, parted=parted, defines=self.store.organs)
            for parted, counts in ((True, segments[: self._parted + 1]), (False, segments[self._parted :]))
            if counts
        ]
        self.morph = Ribbons(
            ctx, block, segments[-1:], units, soft=True, record=PAINTED, defines={**laid, "MORPH": 1}, tell=self._tell
        )
        self._gathered, self._told = Remembered[_Gathered](), Remembered[_Told]()
        self._first = self._asked = 0

    def _tell(self, made: moderngl.Program) -> None:
        """Tell a program what it has to know of blades and of strips."""
        for name, value in (("near", self._near), ("models", self._models), ("each", self.store.count)):
            set_uniform(made, name, value)
        tell_sizes(made, self._strips.stock.forms)
        tell_stacks(made, self._strips.quality.strip_rings)

    def texts(self) -> Iterator[Texts]:
        """Return what the programs of ribbons that are not there yet are made of."""
        for ribbons in (self.morph, *self.groups):
            yield from ribbons.texts()

    def making(self) -> Iterator[None]:
        """Make the programs of ribbons that are not there yet, one at a time."""
        for ribbons in (self.morph, *self.groups):
            yield from ribbons.making()

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over how much of each kind has become what it is to be."""
        del record
        self._came = grown.came

    def fits(self, representation: Any, /) -> bool:
        """Return whether blades of another stock are records of the same."""
        return bool(representation.stock.records.dtype == self._stock.records.dtype)

    def staging(self, stocks: Sequence[Any], /) -> Iterator[None]:
        """Bring the blades of another stock into GL beside its own."""
        blades, strips = (next(each for each in stocks if each.name == name) for name in ("blades", "strips"))
        store = yield from BladeStore.beside(self.ctx, blades.stock, strips.stock)
        self._beside = blades.stock, strips, store

    def restock(self) -> None:
        """Draw what was staged."""
        assert self._beside is not None
        self.store.release()
        (self._stock, self._strips, self.store), self._beside = self._beside, None
        self.hearing.tell_again()
        self.morph.tell_again()
        for made in self.passes:
            self._tell(made)
        self._gathered, self._told = Remembered[_Gathered](), Remembered[_Told]()

    def making_for_winds(self) -> Iterator[None]:
        """Make the programs by which receivers hear whatever winds will blow, one at a time."""
        return self.hearing.making()

    def make_ready(self, grown: Grown, /) -> None:
        """Make room for more patches than are usually shown."""
        del grown
        self._rows = READY_ROWS
        for shelf in self.shelves:
            shelf.reserve(READY_ROWS)
        for ribbons in (self.morph, *self.groups):
            ribbons.array(DEEP)

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that some are on their way, and that there are others of each ring."""
        del record
        shelf = self.shelves.now
        if sum(shelf.counts) >= len(shelf.counts):
            shelf.counts, shelf.sent = [1] * len(shelf.counts), None

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return how many blades there are on the patches that are shown."""
        shown = outlook.shows(BladesShown)
        return [len(shown.standing.rows) * self.store.count]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Send the patches with blades, and the numbers of the blades that are shown; return how many."""
        kept, shown, strips = outlook.keeps(BladesKept), outlook.shows(BladesShown), outlook.shows(StripsShown)
        stands = (
            outlook.view,
            shown,
            strips,
            outlook.appearance,
            kept,
            kept.planted,
            outlook.keeps(StripsKept),
            self._came,
        )
        made_of = *stands, *first["strips"], *first["blades"]
        shelf = self.shelves.of(outlook.viewer.name, outlook)
        told = self._told.of(outlook.viewer.name, made_of, partial(self._tell_of, outlook, first))
        if told is not shelf.sent:
            shelf.send(told)
        (self._asked,), (self._first,) = self.receivers(outlook), first["blades"]
        return sum(shelf.counts)

    def _tell_of(self, outlook: Outlook, first: Mapping[str, list[int]]) -> "_Told":
        """Return what a viewer is shown."""
        kept, shown, viewer = outlook.keeps(BladesKept), outlook.shows(BladesShown), outlook.viewer
        assert outlook.appearance is not None
        left, _ = handed_over(outlook.appearance.handed[shown.morphing.rows], fade=self._fade)
        slots, places = shown.standing.slots, (ring.places.tobytes() for ring in shown.rings)
        pool = kept.pool
        planted = pool, slots, *(each.take(slots, axis=0) for each in (pool.stamp, pool.ground, pool.sown))
        made_of = None if len(shown.morphing.rows) else (viewer.eye, viewer.sides, self._came, *planted, *places)
        gather = partial(self._gather, outlook, kept.pool, shown, left)
        numbers = self._gathered.of(viewer.name, made_of, gather)
        return _Told(self._standing(outlook, shown, left, first["strips"]), numbers)

    def _gather(self, outlook: Outlook, pool: BladePool, shown: BladesShown, left: Floats) -> _Gathered:
        """Return the numbers of the blades that are on their way, and of those that stand, group after group."""
        eye, moving = (outlook.viewer.eye[0], outlook.viewer.eye[2]), shown.morphing
        away = distances(pool, moving.slots, eye)
        home = at_home(outlook, moving, away)
        groups = [together(rings) for rings in self._grouped(shown.rings)]
        of_form = partial(self._of_form, outlook)
        slots, ends = np.concatenate([each.slots for each in groups]), np.cumsum([len(each.slots) for each in groups])
        seen = may_be_seen(pool, slots, outlook.viewer.sides, reach=self._stock.reach, patch=self._patch)
        stand = np.split(seen, ends[:-1])
        if self._came:
            stand = [seen & of_form(each) for seen, each in zip(stand, groups, strict=True)]
        if home.any():
            groups[-1], stand[-1] = together([groups[-1], moving]), np.concatenate([stand[-1], home & of_form(moving)])
        found = [
            gather_morph(outlook, pool, self._strips, moving, away=away, left=left, home=home | ~of_form(moving)),
            *(gather_blades(pool, each, eye=eye, stand=those) for each, those in zip(groups, stand, strict=True)),
        ]
        return _Gathered(np.concatenate(found), [len(each) for each in found])

    def _of_form(self, outlook: Outlook, shown: Standing) -> NDArray[np.bool_]:
        """Return which blades of patches are of the form that plants of their rank have by now, shape (m, blades)."""
        least, most = standing_of(self._stock, self._came)
        rank = self._stock.rank[outlook.patches.model[shown.rows]]
        return np.asarray((rank >= least) & (rank < most))

    def _grouped(self, rings: list[Standing]) -> list[list[Standing]]:
        """Return the rings whose blades depth parts, and the others: in each group, blades come from far to near."""
        return [rings[: self._parted], rings[self._parted :]][: len(self.groups)]

    def _standing(self, outlook: Outlook, shown: BladesShown, left: Floats, first: list[int]) -> NDArray[np.void]:
        """Return the patches with blades as records of `STANDING`.

        `left` is how much those on their way still show, `first` the number of each strip ring's first receiver.
        """
        patches, rows = outlook.patches, shown.standing.rows
        standing = np.zeros(len(rows), STANDING)
        standing["cell"], standing["row"] = patches.cell[rows], patches.model[rows] * 4 + patches.turn[rows]
        for rings in self._grouped(shown.rings):
            for number, ring in enumerate(rings):
                standing["fade"][ring.places], standing["slide"][ring.places] = ring.fade, number + ring.slide
        if len(shown.morphing.rows):
            _send_away(standing, outlook, shown.morphing, self._strips, first)
            standing["fade"][shown.morphing.places] = left
            standing["slide"][shown.morphing.places] = len(self._grouped(shown.rings)[-1]) - 1
        return standing

    def hear(self) -> int:
        """Let all blades hear the wind; return the number of draw calls."""
        self.store.blades.texture.use(self._units["blades"])
        self.shelves.now.standing.texture.use(self._units["standing"])
        return self._received.ask(self.hearing.array(), first=self._first, count=self._asked)

    def look_anew(self) -> int:
        """Make out all about each blade that is the same along its ribbon; return the number of draw calls."""
        self.store.blades.texture.use(self._units["blades"])
        shelf = self.shelves.now
        shelf.standing.texture.use(self._units["standing"])
        self.store.slices.use(self._units["slices"])
        for made in self.passes:
            set_uniform(made, "blades_from", self._first)
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
        # Around the viewer no order is right for every direction: there blades are parted by depth, and then edged.
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
        release_all(self.store, *([] if self._beside is None else [self._beside[2]]))


def _send_away(
    standing: NDArray[np.void], outlook: Outlook, shown: Standing, strips: StripRepresentation, first: list[int]
) -> None:
    """Tell the patches on their way where to: to which strips, and how far they have come."""
    appears, rows, places = outlook.appearance, shown.rows, shown.places
    assert appears is not None
    ring, along = strips.ring_and_axis(outlook, rows)
    standing["morph"][places], standing["growth"][places] = appears.morph[rows], appears.growth[rows]
    standing["along"][places], standing["ring"][places] = along, ring
    for number in np.unique(ring).tolist():
        here = ring == number
        stands = np.zeros(len(appears.morph), np.int64)
        of_ring = outlook.shows(StripsShown).rings[number].rows
        stands[of_ring] = np.arange(len(of_ring))
        each = prod(outlook.keeps(StripsKept).pools[number].shape)
        standing["edges"][places[here]] = first[number] + stands[rows[here]] * each
