"""The texture of marks that `press.glsl` reads."""

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.gl.texture import by_texel
from ..around.outlook import Outlook
from ..frame.feature import TexturePart
from ..grow.record import Growth
from ..space.grown import Grown
from .lie import recoveries
from .marks import NOTHING, SIDE, UNTRODDEN, Marks, Trodden
from .trail import COLUMNS

ROW = 1024
"""Texels in a row of the texture."""

GLSL = {"PRESSED_ROW": ROW}

HEAD_ROWS = 2 + SIDE * SIDE // ROW
"""Number of rows before the marks: the frame's numbers, the kinds' responses, and the squares."""

FRESH_ROOM, SETTLED_ROOM = 32, 224
"""Rows for fresh and for settled marks that `prepare` makes room for: 4 MiB in all."""

MARK_TEXELS = COLUMNS // 4
"""Number of texels of a mark."""


class PressPart(TexturePart):
    """Holds all marks in one GL context: the head, fresh marks, then settled ones."""

    def __init__(self, ctx: moderngl.Context, unit: int) -> None:
        super().__init__(unit)
        self.ctx = ctx
        self._grown: Grown | None = None
        self._head = np.zeros((HEAD_ROWS * ROW, 4), np.float32)
        self._settled = NOTHING
        self._fresh_rows, self._settled_rows = 4, 0
        self._is_empty = True
        """Whether the uploaded texture is up to date and has no marks."""
        self.texture = self._new_texture()

    def make_ready(self, grown: Grown, /) -> None:
        """Make room for the marks of many pressers."""
        self._grow(FRESH_ROOM, SETTLED_ROOM)

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over the kinds' responses and recovery times."""
        if grown is not self._grown:
            self._grown = grown
            self._write_responses(grown.growths, recoveries(grown.scene))

    def _write_responses(self, growths: Sequence[Growth], recovery: Floats) -> None:
        """Write the kinds' recovery times and responses after a wind into the head, four kinds to a texel."""
        samples = len(growths[0].response.fall)
        for kind, growth in enumerate(growths):
            group, channel = divmod(kind, 4)
            self._head[1 + 2 * group, channel] = recovery[kind]
            self._head[2 + 2 * group, channel] = growth.response.step
            self._head[ROW + group * samples :, channel][:samples] = growth.response.fall
        self._head[0, 2], self._is_empty = samples, False

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Upload head and fresh marks, and settled marks when they are others; nothing while there are none."""
        trodden = outlook.noted(Trodden, UNTRODDEN)
        if not trodden and self._is_empty:
            return
        self._is_empty = not trodden
        fresh, settled = _rows(trodden.fresh), _rows(trodden.settled)
        if fresh > self._fresh_rows or settled > self._settled_rows:
            self._grow(fresh * 2, settled * 3 // 2)
        from_settled = HEAD_ROWS + self._fresh_rows
        if trodden.settled is not self._settled:
            self._settled = trodden.settled
            self._write_squares(trodden.settled, from_settled, 0)
            if settled:
                self.texture.write(_texels(trodden.settled, from_settled), viewport=(0, from_settled, ROW, settled))
        self._write_squares(trodden.fresh, HEAD_ROWS, 2)
        self._head[0] = trodden.time - trodden.since, float(bool(trodden)), self._head[0, 2], 0.0
        texels = np.concatenate([self._head, _texels(trodden.fresh, HEAD_ROWS)])
        self.texture.write(texels, viewport=(0, 0, ROW, HEAD_ROWS + fresh))

    def _grow(self, fresh: int, settled: int) -> None:
        """Make a texture with at least these rows for fresh and settled marks; all is uploaded again."""
        self._fresh_rows, self._settled_rows = max(fresh, self._fresh_rows), max(settled, self._settled_rows)
        self.texture.release()
        self.texture, self._settled, self._is_empty = self._new_texture(), NOTHING, False

    def _write_squares(self, marks: Marks, row: int, column: int) -> None:
        """Write start and length of the squares' lists into two channels; starts count the texture's floats."""
        squares = self._head[2 * ROW :]
        squares[:, column], squares[:, column + 1] = marks.first + row * ROW * 4, marks.count

    def _new_texture(self) -> moderngl.Texture:
        """Return an empty texture with all rows."""
        rows = HEAD_ROWS + self._fresh_rows + self._settled_rows
        return by_texel(self.ctx.texture((ROW, rows), 4, np.zeros((rows, ROW, 4), np.float32), dtype="f4"))


def _rows(marks: Marks) -> int:
    """Return the number of rows for marks and their lists."""
    return _list_rows(marks) + -(-len(marks.marks) * MARK_TEXELS // ROW)


def _list_rows(marks: Marks) -> int:
    """Return the number of rows for the lists of marks."""
    return -(-len(marks.listed) // (4 * ROW))


def _texels(marks: Marks, row: int) -> Floats:
    """Return rows of texels (n, 4) from `row` on: the lists, as indices of the marks' first texels, then the marks."""
    lists = _list_rows(marks)
    texels = np.zeros((_rows(marks) * ROW, 4), np.float32)
    texels[: lists * ROW].reshape(-1)[: len(marks.listed)] = (row + lists) * ROW + marks.listed * MARK_TEXELS
    texels[lists * ROW :].reshape(-1)[: marks.marks.size] = marks.marks.reshape(-1)
    return texels
