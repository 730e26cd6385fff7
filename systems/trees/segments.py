"""Trees of all streams in the same few vertex buffers, each stream in a segment of its own."""

from collections.abc import Iterable, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.stream import Stream, release_all
from .standing import INSTANCE, STOOD, WORDS

SPARE_PART, SPARE_TREES = 8, 4
"""Spare room of a segment, so that it seldom moves: a tree for each `SPARE_PART` that it holds, and `SPARE_TREES`
more."""


class Segment:
    """The trees of a stream: records of the buffers of `Segments`, one after another."""

    def __init__(self, buffers: Sequence[Stream]) -> None:
        self.first = self.count = self.room = 0
        self._buffers, self._arrays = buffers, list[moderngl.VertexArray]()

    def bindings(self, program: moderngl.Program) -> list[tuple[moderngl.Buffer | str, ...]]:
        """Return the buffers as content of a vertex array; hand that array to `lead`."""
        return [each.binding(program) for each in self._buffers]

    def lead(self, array: moderngl.VertexArray) -> None:
        """Let a vertex array of this content read the segment, wherever it moves."""
        self._arrays.append(array)
        self._point(array)

    def lose(self) -> None:
        """Forget all vertex arrays."""
        self._arrays.clear()

    def move(self, first: int, room: int) -> None:
        """Begin at another record."""
        self.first, self.room = first, room
        for array in self._arrays:
            self._point(array)

    def _point(self, array: moderngl.VertexArray) -> None:
        for each in self._buffers:
            each.point(array, self.first)


class Segments:
    """The buffers, and their division into segments: a frame fills them all in one go.

    The first holds records of `INSTANCE`, and the second what `stand.vert` makes of them.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self.instances, self.stood = Stream(ctx, INSTANCE), Stream(ctx, STOOD)
        self._rows = np.zeros(0, INSTANCE)
        """Scratch array of the first buffer's records."""
        self._filled: Sequence[Segment] = []
        self._roomy = set[Segment]()
        """Segments that have room."""
        self._end = 0

    def segment(self) -> Segment:
        """Return a new segment, empty so far."""
        return Segment((self.instances, self.stood))

    def write(self, filled: Sequence[Segment], trees: Sequence[Sequence[NDArray[np.void]]], /) -> None:
        """Fill segments with records of `INSTANCE` each, one array after another, and empty all others.

        `upload` brings them to the card.
        """
        for segment in self._filled:
            segment.count = 0
        self._filled = filled
        for segment, parts in zip(filled, trees, strict=True):
            segment.count = sum(map(len, parts))
            if segment.count > segment.room:
                self._give_room(segment)
        if self._end > 2 * (sum(segment.count for segment in filled) + SPARE_TREES * len(filled)):
            self._close_gaps()
        if self._end > len(self._rows):
            self._rows = np.zeros(2 * self._end, INSTANCE)
        words = self._rows.view(np.uint64)
        for segment, parts in zip(filled, trees, strict=True):
            first = WORDS * segment.first
            for rows in parts:
                words[first : (first := first + WORDS * len(rows))] = rows.view(np.uint64)

    def overwrite(self, changed: Iterable[tuple[Segment, int, NDArray[np.void]]], /) -> None:
        """Write other trees over some in segments, from a place on in each, as many or fewer."""
        words = self._rows.view(np.uint64)
        for segment, place, rows in changed:
            first = WORDS * (segment.first + place)
            words[first : first + WORDS * len(rows)] = rows.view(np.uint64)

    def upload(self) -> None:
        """Upload what was written."""
        self.instances.write(self._rows[: self._end])
        self.stood.room(self._end)

    def _give_room(self, segment: Segment) -> None:
        """Move a segment to the end, with room to spare."""
        room = segment.count + segment.count // SPARE_PART + SPARE_TREES
        segment.move(self._end, room)
        self._roomy.add(segment)
        self._end += room

    def _close_gaps(self) -> None:
        """Take all room from empty segments, and move the others together."""
        for segment in self._roomy.difference(self._filled):
            segment.room = 0
        self._roomy.clear()
        self._end = 0
        for segment in self._filled:
            self._give_room(segment)

    def release(self) -> None:
        """Delete the buffers."""
        release_all(self.instances, self.stood)
