"""The texture of what has been cut, sown and cleared: an index with the plots' pages, and then the pages."""

from collections.abc import Callable
from dataclasses import dataclass, field
from logging import getLogger

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Floats, Ints
from ...engine.gl.functions import ENUMS, functions_of
from ...engine.gl.limits import limits_of
from ...engine.terrain.plots import CELLS, Plots, Values
from ...engine.terrain.rectangle import Rectangle
from ..frame.feature import TexturePart
from ..space.grown import Grown
from .mown import Mown

WIDTH = 4096
"""Width of the texture [texels]: OpenGL guarantees only 1024, but every card with 3.3 has four times as many."""

ROOM = 4
"""Rows of pages in the first texture: 256 pages."""

_MOST_SHEETS = 65536
"""Number of pages that two bytes can index."""

_log = getLogger(__name__)

_ROUND_MEANS, _MEAN_MASK = np.uint64(0x0002_0002_0002_0002), np.uint64(0x00FF_00FF_00FF_00FF)
"""Constants for the mean of four packed 16-bit numbers in one uint64: rounding, and a mask of the results."""

_LEVELS = CELLS.bit_length()
"""Number of mip levels of a page."""

Encoder = Callable[[Values], list[Bytes]]
"""Function from pages of a map to their texels at all mip levels, each (pages, sheets, rows, columns, 4)."""


@dataclass(eq=False)
class _Sheets:
    """The pages of one map in the texture; each takes one or more sheets, the texture's pages."""

    plots: Plots
    sheets_each: int
    """Number of sheets of a page."""

    first_sheet: Ints = field(default_factory=lambda: np.zeros(0, np.int32))
    """Number of each page's first sheet, 0 for none, shape (pages,)."""

    written_when_sent: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    """Change at which each uploaded page had been written, -1 if none is uploaded, shape (pages,)."""

    seen: int = -1
    """Number of changes that the index includes; -1 if any plot may have another page."""

    def grow(self, last: int, most: int) -> int:
        """Assign sheets after `last` to new pages; return the last assigned one. Pages get none beyond `most`."""
        more = len(self.plots.written) - len(self.written_when_sent)
        if more <= 0:
            return last
        first_sheet = last + 1 + self.sheets_each * np.arange(more, dtype=np.int32)
        fits = first_sheet + self.sheets_each - 1 <= most
        self.first_sheet = np.append(self.first_sheet, np.where(fits, first_sheet, 0))
        self.written_when_sent = np.append(self.written_when_sent, np.full(len(first_sheet), -1))
        return last + self.sheets_each * int(fits.sum())

    def forget(self) -> None:
        """Mark all pages and the index as not uploaded."""
        self.written_when_sent[:], self.seen = -1, -1

    def stale(self) -> NDArray[np.intp]:
        """Return the pages to upload, with single ones between them: splitting an upload takes longer."""
        stale = self.written_when_sent != self.plots.written
        stale[1:-1] |= stale[:-2] & stale[2:]
        return np.flatnonzero(stale & (self.first_sheet > 0))

    def changed(self) -> list[Rectangle] | None:
        """Return the cells whose plots may have another page; None for all."""
        return None if self.seen < 0 else self.plots.since(self.seen)


class PlotsPart(TexturePart):
    """Holds both maps, cut and sown, in one GL context."""

    def __init__(self, ctx: moderngl.Context, unit: int, mown: Mown) -> None:
        super().__init__(unit)
        self.ctx, self._mown = ctx, mown
        self.texture = ctx.texture((1, 1), 4, bytes(4))
        """Texture of index and sheets; a single texel while nothing has been changed."""
        self._sheets: tuple[_Sheets, _Sheets] | None = None
        self._index: Bytes = np.zeros((0, 4), np.uint8)
        self._rows, self._last_sheet, self._tallest = 0, 0, 0.0
        self._most_rows = min(limits_of(functions_of(ctx)).side // CELLS, _MOST_SHEETS * CELLS // WIDTH)
        self._is_full = False

    def make_ready(self, grown: Grown, /) -> None:
        """Make room before anything is changed."""
        self._follow_maps(grown)
        if not self._rows:
            self._make_texture(ROOM)

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Set something as cut and as sown."""
        record["anything_cut"] = record["anything_sown"] = 1.0

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Upload changed pages, and the index of plots with other pages."""
        mown, sown = self._mown.plots, grown.ground.density.sown
        record["anything_cut"], record["anything_sown"], record["plots_half"] = mown.any, sown.any, mown.half
        if not (mown.any or sown.any):
            return
        self._follow_maps(grown)
        cut, dense = self._sheets or self._begin(mown, sown)
        if (cut.seen, dense.seen) == (mown.count, sown.count):
            return
        most = self._most_rows * (WIDTH // CELLS) - 1
        self._last_sheet = dense.grow(cut.grow(self._last_sheet, most), most)
        if not (self._is_full or (cut.first_sheet.all() and dense.first_sheet.all())):
            self._is_full = True
            _log.warning("more has been cut and sown than a texture has room for: some of it is not shown")
        rows = -(-(self._last_sheet + 1) * CELLS // WIDTH)
        if rows > self._rows:
            self._make_texture(1 << (rows - 1).bit_length())
        self._upload_pages(cut, self._encoded_heights)
        self._upload_pages(dense, _encoded_densities)
        self._upload_index(cut, dense)

    def _follow_maps(self, grown: Grown) -> None:
        """Begin anew with other maps, and upload heights again when their unit, the tallest grass, has changed."""
        mown, sown = self._mown.plots, grown.ground.density.sown
        if self._sheets is None or (self._sheets[0].plots, self._sheets[1].plots) != (mown, sown):
            self._begin(mown, sown)
        elif grown.tallest != self._tallest:
            assert self._sheets is not None
            self._sheets[0].forget()
        self._tallest = grown.tallest

    def _begin(self, mown: Plots, sown: Plots) -> tuple[_Sheets, _Sheets]:
        """Begin with two maps: an empty index, and nothing uploaded."""
        self._sheets = _Sheets(mown, 1), _Sheets(sown, -(-sown.pages.shape[-1] // 4))
        self._index = np.zeros((-(-4 * mown.half[0] * mown.half[1] // WIDTH) * WIDTH, 4), np.uint8)
        self._last_sheet = -(-(len(self._index) // WIDTH) // CELLS) * (WIDTH // CELLS) - 1
        self._rows = 0
        return self._sheets

    def _make_texture(self, rows: int) -> None:
        """Make a texture for the index and at least `rows` rows of sheets; nothing is uploaded to it yet."""
        self.texture.release()
        first = -(-(len(self._index) // WIDTH) // CELLS)
        self._rows = rows = min(max(rows, ROOM) + first, self._most_rows)
        self.texture = self.ctx.texture((WIDTH, CELLS * rows), 4, alignment=1)
        gl, target = functions_of(self.ctx), ENUMS["TEXTURE_2D"]
        gl.glBindTexture(target, self.texture.glo)
        for level in range(1, _LEVELS):
            size = WIDTH >> level, CELLS * rows >> level
            gl.glTexImage2D(target, level, ENUMS["RGBA8"], *size, 0, ENUMS["RGBA"], ENUMS["UNSIGNED_BYTE"], None)
        gl.glTexParameteri(target, ENUMS["TEXTURE_MAX_LEVEL"], _LEVELS - 1)
        self.texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        self.texture.write(self._index, viewport=(0, 0, WIDTH, len(self._index) // WIDTH), alignment=1)
        for sheets in self._sheets or ():
            sheets.forget()

    def _upload_pages(self, sheets: _Sheets, encoder: Encoder) -> None:
        """Upload the stale pages of a map, in runs of neighbouring sheets."""
        stale = sheets.stale()
        if not len(stale):
            return
        stale = stale[np.argsort(sheets.first_sheet[stale])]
        row = WIDTH // CELLS
        places = (sheets.first_sheet[stale, None] + np.arange(sheets.sheets_each)).reshape(-1)
        ends = np.flatnonzero((np.diff(places, prepend=-2) != 1) | (places % row == 0))
        texels = [level.reshape(-1, *level.shape[2:]) for level in encoder(sheets.plots.pages[stale])]
        for first, last in zip(ends, [*ends[1:], len(places)], strict=True):
            down, across = divmod(int(places[first]), row)
            for level, pages in enumerate(texels):
                side = CELLS >> level
                block = np.ascontiguousarray(pages[first:last].swapaxes(0, 1))
                self._write_texels(block, level, (across * side, down * side, int(last - first) * side, side))
        sheets.written_when_sent[:] = sheets.plots.written

    def _write_texels(self, texels: Bytes, level: int, viewport: tuple[int, int, int, int]) -> None:
        """Write a rectangle of the bound texture: column, row, width, height."""
        if level == 0:
            self.texture.write(texels, viewport=viewport, alignment=1)
            return  # which leaves it bound
        gl, sort = functions_of(self.ctx), (ENUMS["RGBA"], ENUMS["UNSIGNED_BYTE"])
        gl.glTexSubImage2D(ENUMS["TEXTURE_2D"], level, *viewport, *sort, texels.ctypes.data)

    def _upload_index(self, *both: _Sheets) -> None:
        """Write the plots' first sheets into the index and upload its changed rows."""
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
            first_sheet = np.where(page < 0, 0, sheets.first_sheet[page])
            self._index[which, 2 * number], self._index[which, 2 * number + 1] = first_sheet >> 8, first_sheet & 255
            touched = np.append(touched, which)
        if len(touched):
            low, high = int(touched.min()) // WIDTH, int(touched.max()) // WIDTH + 1
            rows = self._index[low * WIDTH : high * WIDTH]
            self.texture.write(rows, viewport=(0, low, WIDTH, high - low), alignment=1)

    def _encoded_heights(self, pages: Floats) -> list[Bytes]:
        """Encode heights relative to the tallest grass as two bytes, clipped at 1: means of uncut cells are 1."""
        fraction = np.minimum(pages / np.float32(self._tallest), np.float32(1.0))
        whole = np.rint(fraction * 65535.0).astype(np.uint32)[:, None]
        levels = []
        for level in range(_LEVELS):
            texels = np.zeros((*whole.shape, 4), np.uint8)
            texels[..., 0], texels[..., 1] = whole >> 8, whole & 255
            levels.append(texels)
            if level < _LEVELS - 1:
                whole = whole[..., ::2, :] + whole[..., 1::2, :]
                whole = (whole[..., ::2] + whole[..., 1::2] + 2) >> 2
        return levels


def _encoded_densities(pages: Bytes) -> list[Bytes]:
    """Encode densities, four kinds to a sheet."""
    texels = np.zeros((len(pages), -(-pages.shape[-1] // 4), CELLS, CELLS, 4), np.uint8)
    for kind in range(pages.shape[-1]):  # one by one: numpy is slow on a short last axis
        texels[:, kind // 4, ..., kind % 4] = pages[..., kind]
    made, level = [texels], texels.astype(np.uint16).view(np.uint64)[..., 0]  # four numbers at once
    while level.shape[-1] > 1:
        level = level[..., ::2, :] + level[..., 1::2, :]
        level = ((level[..., ::2] + level[..., 1::2] + _ROUND_MEANS) >> np.uint64(2)) & _MEAN_MASK
        made.append(level[..., None].view(np.uint16).astype(np.uint8))
    return made
