"""Buffers and textures of records that are filled anew every frame."""

from typing import Any, Protocol

import moderngl
import numpy as np
from numpy.typing import NDArray


class Releasable(Protocol):
    """Anything that holds GL objects: a painter, a stream, or an object of the context itself."""

    def release(self) -> None:
        """Give everything back to the context."""


def release_all(*things: Releasable | None) -> None:
    """Give everything that `things` hold back to the context; None holds nothing."""
    for thing in things:
        if thing is not None:
            thing.release()


def attributes(record: np.dtype[np.void]) -> tuple[str, list[str]]:
    """Return the buffer format and the attribute names of a record of float32 and uint32 fields."""
    names = list(record.names or ())
    counts = [int(np.prod(record[name].shape, dtype=int)) for name in names]
    return " ".join(f"{count}{record[name].base.kind}" for count, name in zip(counts, names, strict=True)), names


class Stream:
    """A vertex buffer of records that grows as it must.

    `record` is a dtype of float32 and uint32 fields whose names are the shader's attributes; at first there is room for
    so many `rows`.
    """

    def __init__(self, ctx: moderngl.Context, record: np.dtype[np.void], *, rows: int = 1024) -> None:
        self.ctx = ctx
        self.record = record
        self.buffer = ctx.buffer(reserve=rows * record.itemsize, dynamic=True)
        self.count, self._most = 0, rows

    def write(self, rows: NDArray[Any]) -> None:
        """Replace the contents by `rows`, shape (n,)."""
        self.room(len(rows))
        if self.count:
            self.buffer.orphan()  # what is drawn still keeps what was written before
            self.buffer.write(np.ascontiguousarray(rows))

    def room(self, count: int) -> None:
        """Make room for `count` records, whose contents are anything until they are written.

        A graphics card that writes them itself does so in its turn: nothing needs to be kept from before.
        """
        self.count = count
        if count > self._most:
            self._most = count * 3 // 2
            self.buffer.orphan(self._most * self.record.itemsize)  # whole ones: transform feedback asks for that

    def binding(self, program: moderngl.Program, *, each: str = "/i") -> tuple[moderngl.Buffer | str, ...]:
        """Return the stream as a vertex array's content; fields the program drops are skipped over.

        A record is for an instance, or with `each` as `/v` for a vertex.
        """
        form, names = attributes(self.record)
        parts = form.split()
        kept = [name for name in names if name in program]
        padded = [
            part if name in program else f"{int(part[:-1]) * 4}x" for part, name in zip(parts, names, strict=True)
        ]
        return self.buffer, " ".join(padded) + each, *kept

    def release(self) -> None:
        """Give the buffer back."""
        self.buffer.release()


class Records:
    """A texture of records that is filled anew and grows as it must, `per_row` of them in a row.

    `record` is a dtype of float32 fields whose size is that of some RGBA texels, or of one integer.
    """

    def __init__(self, ctx: moderngl.Context, record: np.dtype[np.void], per_row: int, *, rows: int = 64) -> None:
        self.ctx = ctx
        self.record = record
        self.per_row = per_row
        self.texels, self.channels = max(record.itemsize // 16, 1), min(record.itemsize // 4, 4)
        self.kind = "u4" if self.channels == 1 else "f4"
        self.texture = self._room(rows)
        self._padded = np.zeros(0, record)
        """Whole rows of what is written, kept from one time to the next."""

    def write(self, records: NDArray[np.void]) -> None:
        """Replace the contents by `records`, shape (n,)."""
        rows = -(-len(records) // self.per_row)
        if rows > self.texture.height:
            self.reserve(rows * 3 // 2)
        if rows:
            if rows * self.per_row > len(self._padded):
                self._padded = np.zeros(rows * self.per_row, self.record)
            self._padded[: len(records)] = records
            whole = self._padded[: rows * self.per_row]  # what comes after them is read by nobody
            self.texture.write(whole, viewport=(0, 0, self.texels * self.per_row, rows))

    def reserve(self, rows: int) -> None:
        """Make room for so many rows; where there is too little, what was written is lost."""
        if rows > self.texture.height:
            self.texture.release()
            self.texture = self._room(rows)

    def _room(self, rows: int) -> moderngl.Texture:
        texture = self.ctx.texture((self.texels * self.per_row, rows), self.channels, dtype=self.kind)
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def release(self) -> None:
        """Give the texture back."""
        self.texture.release()
