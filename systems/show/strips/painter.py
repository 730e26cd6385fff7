"""The painter of strips: it draws all rings in one order, from far to near."""

from collections.abc import Iterator, Mapping, Sequence
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
from ....engine.gl.remembered import Remembered
from ....engine.gl.shaders import Texts
from ...around.outlook import Outlook
from ...grow.organs import any_heads
from ...space.cone import distance_in_order
from ...space.grown import Grown
from ..representation import Canvas, RepresentationPainter
from .draw import StripDrawing
from .gather import ALL_BLADES, BY_RANK, EDGED, Batch, batches, gather_strips, polygon_strips
from .pool import StripPool, StripsKept
from .shown import StripsOfRing, StripsShown
from .stock import StripStock
from .textures import Atlas

FULL_DENSITY = 0.995
"""Density from which on no blade of a kind is missing."""


Order = tuple[NDArray[np.uint32], NDArray[np.int64]]
"""Polygon strips in the order of drawing, and the number of them on each patch."""


@dataclass(frozen=True, slots=True, eq=False)
class _Gathered:
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
        self._fade = canvas.transitions.fade
        self._fineness = [(ring.strips, ring.columns) for ring in quality.strip_rings]
        heads = any_heads(form.growth for form in stock.forms)
        self.strips = StripDrawing(canvas, quality.strip_rings, stock.forms, atlas, heads=heads)
        self._came: tuple[float, ...] = ()
        """Progress of each kind's change into its next form, in [0, 1]; empty where no kind ever changes."""
        self.batches: list[Batch] = []
        self._drawn = 0
        """Number of polygon strips that this frame has drawn."""
        self._now: _Gathered | None = None
        """Uploads and drawing of the current frame."""
        self._gathered, self._ordered = Remembered[_Gathered](), Remembered[Order]()

    def texts(self) -> Iterator[Texts]:
        """Yield the shader texts of the missing programs."""
        return self.strips.texts()

    def making(self) -> Iterator[None]:
        """Compile the missing programs one at a time."""
        return self.strips.making()

    def making_for_winds(self) -> Iterator[None]:
        """Compile the programs of the receivers' pass for all orders of winds, one at a time."""
        return self.strips.hearing.making()

    def make_ready(self, grown: Grown, /) -> None:
        """Make ahead all that strips may come to need."""
        del grown
        self.strips.make_ready()

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Note how far each kind has changed into its next form."""
        del record
        self._came = grown.came

    def fits(self, representation: Any, /) -> bool:
        """Return whether the programs can draw another stock too."""
        return self.strips.fits(representation.stock.forms)

    def staging(self, stocks: Sequence[Any], /) -> Iterator[None]:
        """Upload the pictures of a new stock beside those in use, a piece at a time."""
        new = next(each for each in stocks if each.name == "strips")
        yield from self.strips.staging(new.stock.forms, new.atlas())

    def restock(self) -> None:
        """Replace the stock in use by the staged one."""
        self.strips.restock()
        self._gathered, self._ordered = Remembered[_Gathered](), Remembered[Order]()

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Let the frame draw its first batch in all modes, so that the driver has run all programs."""
        del record
        modes = ALL_BLADES, BY_RANK, EDGED
        self.batches = [Batch(first, count, mode) for first, count, _ in self.batches[:1] for mode in modes]

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return the number of strip edges in each ring."""
        return [len(receiving.rows) * receiving.per_slot for receiving in outlook.keeps(StripsKept).receiving]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Upload placements and polygon strips where they have changed; return 0, as strips are no blades."""
        kept, shown, centre = outlook.keeps(StripsKept), outlook.shows(StripsShown), outlook.viewer.centre
        made_of = shown, outlook.appearance, kept, kept.planted, centre, self._came, *first["strips"]
        shelf = self.strips.shelves.of(outlook.viewer.name, outlook)
        now = self._gathered.of(outlook.viewer.name, made_of, partial(self._gather, outlook, first))
        if now is not shelf.sent:
            self.strips.write(now.placements)
            if now.strips is not shelf.numbers:
                self.strips.write_strips(now.strips)
            shelf.sent, shelf.numbers = now, now.strips
        self.batches, self._now, self._drawn = now.batches, now, 0
        return 0

    def _gather(self, outlook: Outlook, first: Mapping[str, list[int]]) -> "_Gathered":
        rings, appears, centre = _rings(outlook), outlook.appearance, outlook.viewer.centre
        assert appears is not None
        shown = [ring for _, ring in rings]
        numbered = [(start, prod(pool.shape)) for start, (pool, _) in zip(first["strips"], rings, strict=True)]
        placements = gather_strips(shown, numbered, appears, outlook.patches, centre, fade=self._fade)
        first_patch = accumulate((len(ring.rows) for ring in shown), initial=0)
        receivers = list(zip(first_patch, first["strips"], self.receivers(outlook), strict=False))
        queue = np.argsort(np.concatenate([ring.queue for ring in shown]), kind="stable")
        patch = queue[placements["cover"].take(queue) > 0.0]
        present = np.concatenate([pool.present.take(ring.slots, axis=0) for pool, ring in rings]).take(patch, axis=0)
        present = self._of_forms(present)
        order = partial(polygon_strips, placements, patch, present, self._fineness, stride=self.strips.stride)
        strips, count = self._ordered.of(outlook.viewer.name, (placements["code"], patch, present), order)
        drawn = batches(_modes(rings, changes=self._changes).take(patch), count)
        distance = distance_in_order(placements["cell"].take(patch, axis=0).astype(np.int32), centre)
        return _Gathered(placements, strips, drawn, distance, np.cumsum(count), receivers)

    @property
    def _changes(self) -> bool:
        """Whether any kind is changing its form."""
        return any(0.0 < came < 1.0 for came in self._came)

    def _of_forms(self, present: Mask) -> Mask:
        """Return the forms that stand on patches, (m, forms), of the kinds that are `present` there, (m, kinds)."""
        if not self._came:
            return present
        came, coming = np.array(self._came), np.zeros(present.shape[1], np.bool_)
        coming[[form.kind for form in self.strips.forms if form.number != form.kind]] = True
        return np.concatenate([present & (came < 1.0), present & coming & (came > 0.0)], axis=1)

    def hear(self) -> int:
        """Compute the messages of all strip edges; return the number of draw calls."""
        receivers = [] if self._now is None else self._now.receivers
        return sum(
            self.strips.hear(ring, patch=patch, first=first, count=count)
            for ring, (patch, first, count) in enumerate(receivers)
        )

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw the strips that this frame has not drawn yet; return the number of draw calls."""
        del target
        calls = self._draw_to(None)
        self._drawn = 0
        return calls

    @property
    def farthest(self) -> float:
        """Distance of the farthest patch with strips [m]; 0 for none."""
        if self._now is None or not len(self._now.distance):
            return 0.0
        return float(self._now.distance[0]) * self.strips.patch

    def draw_beyond(self, distance: float, /) -> int:
        """Draw the strips of patches at a distance or beyond it [m]; return the number of draw calls."""
        assert self._now is not None
        beyond = int((self._now.distance * self.strips.patch >= distance).sum())
        return self._draw_to(int(self._now.ends[beyond - 1])) if beyond else 0

    def _draw_to(self, end: int | None) -> int:
        """Draw the polygon strips before number `end` that are not drawn yet; return the number of draw calls."""
        calls, done = 0, self._drawn
        for start, count, mode in self.batches:
            first, last = max(start, done), start + count if end is None else min(start + count, end)
            if last > first:
                calls += self.strips.draw(first, last - first, mode=mode)
                self._drawn = max(self._drawn, last)
        return calls

    def draw_deep(self) -> int:
        """Write the depth of all batches; return the number of draw calls."""
        return sum(self.strips.draw(first, count, mode=mode, deep=True) for first, count, mode in self.batches)

    def release(self) -> None:
        """Release all GL objects."""
        self.strips.release()


def _rings(outlook: Outlook) -> list[tuple[StripPool, StripsOfRing]]:
    """Return the pool of each ring, and its patches that are shown."""
    return list(zip(outlook.keeps(StripsKept).pools, outlook.shows(StripsShown).rings, strict=True))


def _modes(rings: list[tuple[StripPool, StripsOfRing]], *, changes: bool) -> NDArray[np.int8]:
    """Return the drawing mode of each patch, ring after ring.

    A patch is drawn `BY_RANK` where only some ranks show, where grass is thin anywhere in its ring, and everywhere
    while any kind `changes`.
    """
    modes = []
    for pool, ring in rings:
        is_thin = (pool.least.take(ring.slots) < FULL_DENSITY).any() | (ring.most < 1.0) | (ring.least > 0.0) | changes
        modes.append(np.where(pool.edged.take(ring.slots), EDGED, np.where(is_thin, BY_RANK, ALL_BLADES)))
    return np.concatenate(modes).astype(np.int8)
