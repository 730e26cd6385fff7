"""Vertex buffers and textures of records that are refilled every frame."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol

import moderngl
import numpy as np
from numpy.typing import NDArray

from .texture import by_texel


class Releasable(Protocol):
    """Holder of GL objects: a painter, a stream, or a moderngl object."""

    def release(self) -> None:
        """Delete its GL objects."""


def release_all(*things: Releasable | None) -> None:
    """Release each thing; None is skipped."""
    for thing in things:
        if thing is not None:
            thing.release()


@contextmanager
def released_unless_finished(*things: Releasable) -> Iterator[None]:
    """Release each thing if the body raises, or if its generator is closed before its end."""
    try:
        yield
    except BaseException:
        release_all(*things)
        raise


def attributes(record: np.dtype[np.void]) -> tuple[str, list[str]]:
    """Return the buffer format and the attribute names of a record of float32 and uint32 fields."""
    names = list(record.names or ())
    counts = [int(np.prod(record[name].shape, dtype=int)) for name in names]
    return " ".join(f"{count}{record[name].base.kind}" for count, name in zip(counts, names, strict=True)), names


FEWEST = 1024
"""Number of records that a stream has room for at first."""


class Stream:
    """A vertex buffer of records that grows as needed.

    `record` is a dtype of float32 and uint32 fields, named as the shader's attributes.
    """

    def __init__(self, ctx: moderngl.Context, record: np.dtype[np.void]) -> None:
        self.ctx = ctx
        self.record = record
        self.count, self._capacity = 0, FEWEST
        self.buffer = ctx.buffer(reserve=FEWEST * record.itemsize, dynamic=True)

    def write(self, rows: NDArray[Any]) -> None:
        """Replace the contents by `rows`, shape (n,)."""
        self.room(len(rows))
        if self.count:
            self.buffer.orphan()  # pending draw calls keep the old contents
            self.buffer.write(np.ascontiguousarray(rows))

    def room(self, count: int) -> None:
        """Make room for `count` records, whose contents are undefined until they are written.

        Transform feedback writes them in order with the draw calls, so the old contents need not be kept.
        """
        self.count = count
        if count > self._capacity:
            self._capacity = count * 3 // 2
            self.buffer.orphan(self._capacity * self.record.itemsize)  # whole records, for transform feedback

    def binding(self, program: moderngl.Program, *, each: str = "/i") -> tuple[moderngl.Buffer | str, ...]:
        """Return the stream as content of a vertex array, with fields that the program does not use as padding.

        There is a record for each instance, or for each vertex where `each` is `/v`.
        """
        layout, names = attributes(self.record)
        parts = layout.split()
        kept = [name for name in names if name in program]
        padded = [
            part if name in program else f"{int(part[:-1]) * 4}x" for part, name in zip(parts, names, strict=True)
        ]
        return self.buffer, " ".join(padded) + each, *kept

    def point(self, array: moderngl.VertexArray, first: int) -> None:
        """Let a vertex array that has the stream, with a record an instance, read it from record `first` on."""
        size, fields = self.record.itemsize, self.record.fields
        for name, layout in zip(self.record.names or (), attributes(self.record)[0].split(), strict=True):
            member = array.program.get(name, None)
            if fields is not None and isinstance(member, moderngl.Attribute):
                sort, offset = "f" if layout[-1] == "f" else "i", first * size + fields[name][1]
                array.bind(member.location, sort, self.buffer, layout, offset=offset, stride=size, divisor=1)

    def release(self) -> None:
        """Delete the buffer."""
        self.buffer.release()


class Records:
    """A texture of records, `per_row` in a row, that is refilled and grows as needed.

    `record` is a dtype of float32 fields that fill whole RGBA texels, or of one integer.
    """

    def __init__(self, ctx: moderngl.Context, record: np.dtype[np.void], per_row: int, *, rows: int = 64) -> None:
        self.ctx = ctx
        self.record = record
        self.per_row = per_row
        self.texels, self.channels = max(record.itemsize // 16, 1), min(record.itemsize // 4, 4)
        self.kind = "u4" if self.channels == 1 else "f4"
        self.texture = self._room(rows)
        self._padded = np.zeros(0, record)
        """Scratch array for `write`, of whole rows."""

    def write(self, records: NDArray[np.void]) -> None:
        """Replace the contents by `records`, shape (n,)."""
        rows = -(-len(records) // self.per_row)
        if rows > self.texture.height:
            self.reserve(rows * 3 // 2)
        if rows:
            if rows * self.per_row > len(self._padded):
                self._padded = np.zeros(rows * self.per_row, self.record)
            self._padded[: len(records)] = records
            whole = self._padded[: rows * self.per_row]  # records after the last are never read
            self.texture.write(whole, viewport=(0, 0, self.texels * self.per_row, rows))

    def reserve(self, rows: int) -> None:
        """Make room for `rows` rows of texels; the contents are lost where the texture grows."""
        if rows > self.texture.height:
            self.texture.release()
            self.texture = self._room(rows)

    def _room(self, rows: int) -> moderngl.Texture:
        return by_texel(self.ctx.texture((self.texels * self.per_row, rows), self.channels, dtype=self.kind))

    def release(self) -> None:
        """Delete the texture."""
        self.texture.release()
