"""Painting strips: all rings in one far-to-near order."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from math import prod
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Mask
from ....engine.declared.quality import Quality
from ....engine.gl.remembered import Remembered
from ....engine.gl.shaders import Texts
from ...around.outlook import Outlook
from ...grow.organs import any_heads
from ...space.grown import Grown
from ..representation import Canvas, RepresentationPainter
from .draw import StripPainter
from .gather import gather_strips, polygon_strips, runs
from .pool import StripPool, StripsKept
from .shown import StripsOfRing, StripsShown
from .stock import StripStock
from .textures import Atlas

WHOLE = 0.995
"""Density from which on no blade of a kind is missing."""


Order = tuple[NDArray[np.uint32], NDArray[np.int64]]
"""Polygon strips in the order of drawing, and how many there are on each patch."""


@dataclass(frozen=True, slots=True, eq=False)
class _Sent:
    """What is sent of a frame."""

    stood: NDArray[np.void]
    strips: NDArray[np.uint32]

    runs: list[tuple[int, int, int]]
    """The draws: first strip, how many, and whether by rank."""

    off: Floats
    """How far off the patches are that are drawn, in their order, none farther than the one before [patches], (m,)."""

    ends: NDArray[np.int64]
    """Where the strips of each end, shape (m,)."""

    asked: list[tuple[int, int, int]]
    """By ring, the first patch, its first receiver, and how many receivers there are."""


class StripsPainter(RepresentationPainter):
    """Draws the strips of all rings from far to near."""

    def __init__(self, canvas: Canvas, stock: StripStock, quality: Quality, atlas: Atlas) -> None:
        self._fade = canvas.transitions.fade
        self._fineness = [(ring.strips, ring.columns) for ring in quality.strip_rings]
        heads = any_heads(form.growth for form in stock.forms)
        self.strips = StripPainter(canvas, quality.strip_rings, stock.forms, atlas, heads=heads)
        self._came: tuple[float, ...] = ()
        self.runs: list[tuple[int, int, int]] = []
        self._drawn = 0
        """How many of their strips this frame has drawn."""
        self._sent: _Sent | None = None
        self._asked: list[tuple[int, int, int]] = []
        self._gathered, self._ordered = Remembered[_Sent](), Remembered[Order]()

    def texts(self) -> Iterator[Texts]:
        """Return what the programs that are not there yet are made of."""
        return self.strips.texts()

    def making(self) -> Iterator[None]:
        """Make the programs that are not there yet, one at a time."""
        return self.strips.making()

    def making_for_winds(self) -> Iterator[None]:
        """Make the programs by which receivers hear whatever winds will blow, one at a time."""
        return self.strips.hearing.making()

    def make_ready(self, grown: Grown, /) -> None:
        """Make all that strips may come to need."""
        del grown
        self.strips.make_ready()

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over how much of each kind has become what it is to be."""
        del record
        self._came = grown.came

    def fits(self, representation: Any, /) -> bool:
        """Return whether the pictures of another stock stand in textures as those of this one do."""
        return self.strips.fits(representation.stock.forms)

    def staging(self, stocks: Sequence[Any], /) -> Iterator[None]:
        """Bring the pictures of another stock into GL beside its own."""
        made = next(each for each in stocks if each.name == "strips")
        yield from self.strips.staging(made.stock.forms, made.atlas())

    def restock(self) -> None:
        """Draw what was staged."""
        self.strips.restock()
        self._gathered, self._ordered = Remembered[_Sent](), Remembered[Order]()

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that some are whole, others drawn by rank, and that grass ends somewhere."""
        del record
        self.runs = [(first, count, thin) for first, count, _ in self.runs[:1] for thin in range(3)]

    def receivers(self, outlook: Outlook, /) -> list[int]:
        """Return how many edges each ring has."""
        return [len(receiving.rows) * receiving.per_slot for receiving in outlook.keeps(StripsKept).receiving]

    def write(self, outlook: Outlook, first: Mapping[str, list[int]], /) -> int:
        """Send the patches with strips, and the strips that are shown; they are no blades."""
        kept, shown, centre = outlook.keeps(StripsKept), outlook.shows(StripsShown), outlook.viewer.centre
        made_of = shown, outlook.appearance, kept, kept.planted, centre, self._came, *first["strips"]
        shelf = self.strips.shelves.of(outlook.viewer.name, outlook)
        sent = self._gathered.of(outlook.viewer.name, made_of, partial(self._gather, outlook, first))
        if sent is not shelf.sent:
            self.strips.write(sent.stood)
            if sent.strips is not shelf.numbers:
                self.strips.write_strips(sent.strips)
            shelf.sent, shelf.numbers = sent, sent.strips
        self.runs, self._asked, self._sent, self._drawn = sent.runs, sent.asked, sent, 0
        return 0

    def _gather(self, outlook: Outlook, first: Mapping[str, list[int]]) -> "_Sent":
        rings, appears, centre = _rings(outlook), outlook.appearance, outlook.viewer.centre
        assert appears is not None
        shown = [ring for _, ring in rings]
        numbered = [(start, prod(pool.shape)) for start, (pool, _) in zip(first["strips"], rings, strict=True)]
        stood = gather_strips(shown, numbered, appears, outlook.patches, centre, fade=self._fade)
        before = accumulate((len(ring.rows) for ring in shown), initial=0)
        asked = list(zip(before, first["strips"], self.receivers(outlook), strict=False))
        queue = np.argsort(np.concatenate([ring.queue for ring in shown]), kind="stable")
        patch = queue[stood["fade"].take(queue) > 0.0]
        present = np.concatenate([pool.present.take(ring.slots, axis=0) for pool, ring in rings]).take(patch, axis=0)
        present = self._of_forms(present)
        order = partial(polygon_strips, stood, patch, present, self._fineness, most=self.strips.most)
        strips, amount = self._ordered.of(outlook.viewer.name, (stood["stand"], patch, present), order)
        shown_as = runs(_ranked(rings, changes=self._changes).take(patch), amount)
        off = np.hypot(*(stood["cell"].take(patch, axis=0) - centre).T)
        return _Sent(stood, strips, shown_as, np.minimum.accumulate(off), np.cumsum(amount), asked)

    @property
    def _changes(self) -> bool:
        """Whether any kind is becoming another."""
        return any(0.0 < came < 1.0 for came in self._came)

    def _of_forms(self, present: Mask) -> Mask:
        """Return which forms stand on patches of which it is known which kinds grow there, (m, kinds)."""
        if not self._came:
            return present
        came, coming = np.array(self._came), np.zeros(present.shape[1], np.bool_)
        coming[[form.kind for form in self.strips.forms if form.number != form.kind]] = True
        return np.concatenate([present & (came < 1.0), present & coming & (came > 0.0)], axis=1)

    def hear(self) -> int:
        """Let all edges hear the wind; return the number of draw calls."""
        return sum(
            self.strips.hear(ring, patch=patch, first=first, count=count)
            for ring, (patch, first, count) in enumerate(self._asked)
        )

    def draw(self, target: moderngl.Framebuffer, /) -> int:
        """Draw what is left of all runs; return the number of draw calls."""
        del target
        calls = self._draw_to(None)
        self._drawn = 0
        return calls

    @property
    def reach(self) -> float:
        """How far off its farthest patch is [m]."""
        return float(self._sent.off[0]) * self.strips.patch if self._sent is not None and len(self._sent.off) else 0.0

    def draw_beyond(self, off: float, /) -> int:
        """Draw strips of patches that are farther off [m]; return the number of draw calls."""
        assert self._sent is not None
        beyond = int((self._sent.off * self.strips.patch > off).sum())
        return self._draw_to(int(self._sent.ends[beyond - 1])) if beyond else 0

    def _draw_to(self, end: int | None) -> int:
        """Draw those strips before the `end` that have not been drawn; return the number of draw calls."""
        calls, done = 0, self._drawn
        for start, count, thin in self.runs:
            first, last = max(start, done), start + count if end is None else min(start + count, end)
            if last > first:
                calls += self.strips.draw(first, last - first, thin=thin)
                self._drawn = max(self._drawn, last)
        return calls

    def draw_deep(self) -> int:
        """Write the depth of all runs; return the number of draw calls."""
        return sum(self.strips.draw(first, count, thin=thin, deep=True) for first, count, thin in self.runs)

    def release(self) -> None:
        """Give everything back."""
        self.strips.release()


def _rings(outlook: Outlook) -> list[tuple[StripPool, StripsOfRing]]:
    """Return each ring's pool, and which of its patches are shown."""
    return list(zip(outlook.keeps(StripsKept).pools, outlook.shows(StripsShown).rings, strict=True))


def _ranked(rings: list[tuple[StripPool, StripsOfRing]], *, changes: bool) -> NDArray[np.int8]:
    """Return which patches, ring after ring, have to be drawn by rank, 1: some of their blades do not show.

    Where grass is thin anywhere in a ring, all of the ring is, and everywhere while any kind `changes`. Those whose
    density has edges are drawn with these, 2.
    """
    ranked = []
    for pool, ring in rings:
        is_thin = (pool.least.take(ring.slots) < WHOLE).any() | (ring.most < 1.0) | (ring.least > 0.0) | changes
        ranked.append(np.where(pool.edged.take(ring.slots), 2, is_thin))
    return np.concatenate(ranked).astype(np.int8)
