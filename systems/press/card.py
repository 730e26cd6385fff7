"""What presses grass on the graphics card: the texture that `press.glsl` reads."""

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ..around.outlook import Outlook
from ..frame.feature import TexturePart
from ..grow.record import Growth
from ..space.grown import Grown
from .lie import recoveries
from .marks import NOTHING, SIDE, UNTRODDEN, Marks, Trodden
from .trail import NUMBERS

ROW = 1024
"""Texels in a row of the texture; the first is the frame's."""

GLSL = {"PRESSED_ROW": ROW}

HEAD = 2 + SIDE * SIDE // ROW
"""Rows of the frame, of how kinds swing back, and of the squares."""

FRESH_ROOM, SETTLED_ROOM = 32, 224
"""Rows for fresh and for settled marks that a game has room for that prepares: 4 MiB in all."""

TEXELS = NUMBERS // 4
"""Texels of a mark."""


class PressPart(TexturePart):
    """All marks as one GL context holds them: the frame and its fresh marks first, then those that have settled."""

    def __init__(self, ctx: moderngl.Context, unit: int) -> None:
        super().__init__(unit)
        self.ctx = ctx
        self._grown: Grown | None = None
        self._head = np.zeros((HEAD * ROW, 4), np.float32)
        self._settled = NOTHING
        self._fresh_rows, self._settled_rows = 4, 0
        self._still = True
        self.texture = self._room()

    def make_ready(self, grown: Grown, /) -> None:
        """Have room for the marks of many."""
        del grown
        self._grow(FRESH_ROOM, SETTLED_ROOM)

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over how kinds of grass swing back, and how long each takes to recover."""
        del record
        if grown is not self._grown:
            self._grown = grown
            self._stand(grown.growths, recoveries(grown.scene))

    def _stand(self, growths: Sequence[Growth], recovery: Floats) -> None:
        samples = len(growths[0].response.fall)
        for kind, growth in enumerate(growths):
            group, own = divmod(kind, 4)
            self._head[1 + 2 * group, own], self._head[2 + 2 * group, own] = recovery[kind], growth.response.step
            self._head[ROW + group * samples :, own][:samples] = growth.response.fall
        self._head[0, 2], self._still = samples, False

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Send what has been trodden; settled marks only where they are others than before."""
        del record
        self._write(outlook.noted(Trodden, UNTRODDEN))

    def _write(self, trodden: Trodden) -> None:
        if not trodden and self._still:
            return
        self._still = not trodden
        fresh, settled = _rows(trodden.fresh), _rows(trodden.settled)
        if fresh > self._fresh_rows or settled > self._settled_rows:
            self._grow(fresh * 2, settled * 3 // 2)
        from_settled = HEAD + self._fresh_rows
        if trodden.settled is not self._settled:
            self._settled = trodden.settled
            self._place(trodden.settled, from_settled, 0)
            if settled:
                self.texture.write(_texels(trodden.settled, from_settled), viewport=(0, from_settled, ROW, settled))
        self._place(trodden.fresh, HEAD, 2)
        self._head[0] = trodden.time - trodden.since, float(bool(trodden)), self._head[0, 2], 0.0
        sent = np.concatenate([self._head, _texels(trodden.fresh, HEAD)])
        self.texture.write(sent, viewport=(0, 0, ROW, HEAD + fresh))

    def _grow(self, fresh: int, settled: int) -> None:
        self._fresh_rows, self._settled_rows = max(fresh, self._fresh_rows), max(settled, self._settled_rows)
        self.texture.release()
        self.texture, self._settled, self._still = self._room(), NOTHING, False

    def _place(self, marks: Marks, row: int, column: int) -> None:
        """Write where the lists of the squares begin, in numbers from the beginning of the texture, and how long."""
        squares = self._head[2 * ROW :]
        squares[:, column], squares[:, column + 1] = marks.first + row * ROW * 4, marks.count

    def _room(self) -> moderngl.Texture:
        rows = HEAD + self._fresh_rows + self._settled_rows
        texture = self.ctx.texture((ROW, rows), 4, np.zeros((rows, ROW, 4), np.float32), dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture


def _rows(marks: Marks) -> int:
    """Return how many rows marks and their lists take."""
    return _list_rows(marks) + -(-len(marks.marks) * TEXELS // ROW)


def _list_rows(marks: Marks) -> int:
    return -(-len(marks.listed) // (4 * ROW))


def _texels(marks: Marks, row: int) -> Floats:
    """Return whole rows of texels (n, 4): lists of the texels of marks, and the marks; `row` is the first."""
    lists = _list_rows(marks)
    texels = np.zeros((_rows(marks) * ROW, 4), np.float32)
    texels[: lists * ROW].reshape(-1)[: len(marks.listed)] = (row + lists) * ROW + marks.listed * TEXELS
    texels[lists * ROW :].reshape(-1)[: marks.marks.size] = marks.marks.reshape(-1)
    return texels
