"""What has been cut, sown and cleared, as one texture: by plot the numbers of its pages, and then the pages."""

from collections.abc import Callable
from dataclasses import dataclass, field
from logging import getLogger

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Floats, Ints
from ...engine.gl.functions import NUMBERS, functions_of
from ...engine.gl.limits import limits_of
from ...engine.terrain.part import Part as Cells
from ...engine.terrain.plots import CELLS, Plots, Values
from ..frame.feature import TexturePart
from ..space.grown import Grown
from .mown import Mown

WIDTH = 4096
"""Texels across the texture: OpenGL promises 1024 alone, and every card that has 3.3 has four times as many."""

ROOM = 4
"""Rows of pages that there is room for at first: 256 pages."""

_MOST_PAGES = 65536
"""Pages that two bytes can tell apart."""

_log = getLogger(__name__)

_TWO, _LOW_BYTES = np.uint64(0x0002_0002_0002_0002), np.uint64(0x00FF_00FF_00FF_00FF)
"""Of four numbers of two bytes each, side by side."""

_LEVELS = CELLS.bit_length()

Encoded = Callable[[Values], list[Bytes]]
"""Gives the texels of pages at all levels, each (pages, of each, rows, columns, 4)."""


@dataclass(eq=False)
class _Sheets:
    """What of a map is in the texture."""

    plots: Plots
    each: int
    """Pages of the texture that a page of the map takes."""

    place: Ints = field(default_factory=lambda: np.zeros(0, np.int32))
    """Which page of the texture each page's first is, 0 while it is none, shape (pages,)."""

    sent: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    """At which change each page was written that was sent last, -1 for none, shape (pages,)."""

    seen: int = -1
    """How many changes have been looked at; -1 where any plot may have another page."""

    def grow(self, last: int, most: int) -> int:
        """Give places to pages that have none, the first of them after `last`; return the last that is taken.

        Where there is no room up to `most`, pages have no place.
        """
        more = len(self.plots.written) - len(self.sent)
        if more <= 0:
            return last
        place = last + 1 + self.each * np.arange(more, dtype=np.int32)
        fits = place + self.each - 1 <= most
        self.place = np.append(self.place, np.where(fits, place, 0))
        self.sent = np.append(self.sent, np.full(len(place), -1))
        return last + self.each * int(fits.sum())

    def forget(self) -> None:
        """Send all of it again."""
        self.sent[:], self.seen = -1, -1

    def stale(self) -> NDArray[np.intp]:
        """Return which pages are to be sent, with single ones between them: to part what is sent takes longer."""
        stale = self.sent != self.plots.written
        stale[1:-1] |= stale[:-2] & stale[2:]
        return np.flatnonzero(stale & (self.place > 0))

    def changed(self) -> list[Cells] | None:
        """Return the cells whose plots may have another page; None where any may."""
        return None if self.seen < 0 else self.plots.since(self.seen)


class PlotsPart(TexturePart):
    """Both maps as one GL context holds them."""

    def __init__(self, ctx: moderngl.Context, unit: int, mown: Mown) -> None:
        super().__init__(unit)
        self.ctx, self._mown = ctx, mown
        self.texture = ctx.texture((1, 1), 4, bytes(4))
        """A single texel for as long as nothing has been changed."""
        self._sheets: tuple[_Sheets, _Sheets] | None = None
        self._index: Bytes = np.zeros((0, 4), np.uint8)
        self._rows, self._last, self._tallest = 0, 0, 0.0
        self._most_rows = min(limits_of(functions_of(ctx)).side // CELLS, _MOST_PAGES * CELLS // WIDTH)
        self._is_full = False

    def make_ready(self, grown: Grown, /) -> None:
        """Have room before anything is changed."""
        self._meet(grown)
        if not self._rows:
            self._make(ROOM)

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that something is cut and sown."""
        record["anything_cut"] = record["anything_sown"] = 1.0

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Send the pages that have changed, and which plots have others."""
        mown, sown = self._mown.plots, grown.ground.density.sown
        record["anything_cut"], record["anything_sown"], record["plots_half"] = mown.any, sown.any, mown.half
        if not (mown.any or sown.any):
            return
        self._meet(grown)
        cut, dense = self._sheets or self._begun(mown, sown)
        if (cut.seen, dense.seen) == (mown.count, sown.count):
            return
        most = self._most_rows * (WIDTH // CELLS) - 1
        self._last = dense.grow(cut.grow(self._last, most), most)
        if not (cut.place.all() and dense.place.all()):
            self._tell_full()
        rows = -(-(self._last + 1) * CELLS // WIDTH)
        if rows > self._rows:
            self._make(1 << (rows - 1).bit_length())
        self._send(cut, self._as_heights)
        self._send(dense, _as_densities)
        self._point(cut, dense)

    def _meet(self, grown: Grown) -> None:
        """Begin anew where the maps are others, and send heights again where they are told in other units."""
        mown, sown = self._mown.plots, grown.ground.density.sown
        if self._sheets is None or (self._sheets[0].plots, self._sheets[1].plots) != (mown, sown):
            self._begun(mown, sown)
        elif grown.tallest != self._tallest:
            assert self._sheets is not None
            self._sheets[0].forget()
        self._tallest = grown.tallest

    def _begun(self, mown: Plots, sown: Plots) -> tuple[_Sheets, _Sheets]:
        self._sheets = _Sheets(mown, 1), _Sheets(sown, -(-sown.pages.shape[-1] // 4))
        self._index = np.zeros((-(-4 * mown.half[0] * mown.half[1] // WIDTH) * WIDTH, 4), np.uint8)
        self._last = -(-(len(self._index) // WIDTH) // CELLS) * (WIDTH // CELLS) - 1
        self._rows = 0
        return self._sheets

    def _make(self, rows: int) -> None:
        """Make a texture of so many rows of pages besides what tells of plots, with nothing sent yet."""
        self.texture.release()
        first = -(-(len(self._index) // WIDTH) // CELLS)
        self._rows = rows = min(max(rows, ROOM) + first, self._most_rows)
        self.texture = self.ctx.texture((WIDTH, CELLS * rows), 4, alignment=1)
        gl, target = functions_of(self.ctx), NUMBERS["TEXTURE_2D"]
        gl.glBindTexture(target, self.texture.glo)
        for level in range(1, _LEVELS):
            size = WIDTH >> level, CELLS * rows >> level
            gl.glTexImage2D(target, level, NUMBERS["RGBA8"], *size, 0, NUMBERS["RGBA"], NUMBERS["UNSIGNED_BYTE"], None)
        gl.glTexParameteri(target, NUMBERS["TEXTURE_MAX_LEVEL"], _LEVELS - 1)
        self.texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        self.texture.write(self._index, viewport=(0, 0, WIDTH, len(self._index) // WIDTH), alignment=1)
        for sheets in self._sheets or ():
            sheets.forget()

    def _tell_full(self) -> None:
        if not self._is_full:
            self._is_full = True
            _log.warning("more has been cut and sown than a texture has room for: some of it is not shown")

    def _send(self, sheets: _Sheets, encoded: Encoded) -> None:
        stale = sheets.stale()
        if not len(stale):
            return
        stale = stale[np.argsort(sheets.place[stale])]
        row = WIDTH // CELLS
        places = (sheets.place[stale, None] + np.arange(sheets.each)).reshape(-1)
        ends = np.flatnonzero((np.diff(places, prepend=-2) != 1) | (places % row == 0))
        texels = [each.reshape(-1, *each.shape[2:]) for each in encoded(sheets.plots.pages[stale])]
        for first, last in zip(ends, [*ends[1:], len(places)], strict=True):
            down, across = divmod(int(places[first]), row)
            for level, pages in enumerate(texels):
                side = CELLS >> level
                block = np.ascontiguousarray(pages[first:last].swapaxes(0, 1))
                self._write(block, level, (across * side, down * side, int(last - first) * side, side))
        sheets.sent[:] = sheets.plots.written

    def _write(self, texels: Bytes, level: int, viewport: tuple[int, int, int, int]) -> None:
        """Write a rectangle: from column and row on, so many across and down."""
        if level == 0:
            self.texture.write(texels, viewport=viewport, alignment=1)
            return  # which leaves it bound
        gl, sort = functions_of(self.ctx), (NUMBERS["RGBA"], NUMBERS["UNSIGNED_BYTE"])
        gl.glTexSubImage2D(NUMBERS["TEXTURE_2D"], level, *viewport, *sort, texels.ctypes.data)

    def _point(self, *both: _Sheets) -> None:
        """Tell which pages plots have."""
        touched = np.zeros(0, np.intp)
        for number, sheets in enumerate(both):
            plots, changed = sheets.plots, sheets.changed()
            if sheets.seen == plots.count:
                continue
            sheets.seen = plots.count
            if not plots.any:
                continue
            columns = 2 * plots.half[0]
            if changed is None:
                self._index[:, 2 * number : 2 * number + 2], which = 0, np.flatnonzero(plots.index >= 0)
                touched = np.append(touched, (0, len(self._index) - 1))
            else:
                row, column = np.array(changed)[:, :2].T // CELLS
                which = np.unique((row + plots.half[1]) * columns + column + plots.half[0])
            page = plots.index.reshape(-1)[which]
            place = np.where(page < 0, 0, sheets.place[page])
            self._index[which, 2 * number], self._index[which, 2 * number + 1] = place >> 8, place & 255
            touched = np.append(touched, which)
        if len(touched):
            low, high = int(touched.min()) // WIDTH, int(touched.max()) // WIDTH + 1
            rows = self._index[low * WIDTH : high * WIDTH]
            self.texture.write(rows, viewport=(0, low, WIDTH, high - low), alignment=1)

    def _as_heights(self, pages: Floats) -> list[Bytes]:
        """Return heights of the tallest grass's as two bytes: what is not cut stands above all tips, and means do."""
        part = np.minimum(pages / np.float32(self._tallest), np.float32(1.0))
        whole = np.rint(part * 65535.0).astype(np.uint32)[:, None]
        made = []
        for level in range(_LEVELS):
            texels = np.zeros((*whole.shape, 4), np.uint8)
            texels[..., 0], texels[..., 1] = whole >> 8, whole & 255
            made.append(texels)
            if level < _LEVELS - 1:
                whole = whole[..., ::2, :] + whole[..., 1::2, :]
                whole = (whole[..., ::2] + whole[..., 1::2] + 2) >> 2
        return made


def _as_densities(pages: Bytes) -> list[Bytes]:
    """Return densities four kinds to a page."""
    texels = np.zeros((len(pages), -(-pages.shape[-1] // 4), CELLS, CELLS, 4), np.uint8)
    for kind in range(pages.shape[-1]):  # one by one: numpy is slow where the last axis is short
        texels[:, kind // 4, ..., kind % 4] = pages[..., kind]
    made, level = [texels], texels.astype(np.uint16).view(np.uint64)[..., 0]  # four numbers at once
    while level.shape[-1] > 1:
        level = level[..., ::2, :] + level[..., 1::2, :]
        level = ((level[..., ::2] + level[..., 1::2] + _TWO) >> np.uint64(2)) & _LOW_BYTES
        made.append(level[..., None].view(np.uint16).astype(np.uint8))
    return made
