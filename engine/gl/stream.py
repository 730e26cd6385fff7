"""Buffers that are filled anew every frame."""

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
