"""Rectangles of the samples of maps, and logs of which have changed."""

from collections import deque
from dataclasses import dataclass, field
from typing import NamedTuple

MOST = 4096
"""Number of changes that are logged; a reader that has missed more reads the whole map again."""


class Rectangle(NamedTuple):
    """A rectangle of samples of a map."""

    row: int
    """First row."""

    column: int
    """First column."""

    rows: int
    columns: int

    def moved(self, down: int, right: int) -> "Rectangle":
        """Return the rectangle moved by a number of samples down and to the right."""
        return Rectangle(self.row + down, self.column + right, self.rows, self.columns)

    def within(self, rows: int, columns: int) -> "Rectangle | None":
        """Return the rectangle clipped to a map of `rows` by `columns`; None if nothing is left."""
        top, left = max(self.row, 0), max(self.column, 0)
        bottom, right = min(self.row + self.rows, rows), min(self.column + self.columns, columns)
        return Rectangle(top, left, bottom - top, right - left) if top < bottom and left < right else None

    @property
    def slices(self) -> tuple[slice, slice]:
        """Index of the rectangle in an array (rows, columns, ...)."""
        return slice(self.row, self.row + self.rows), slice(self.column, self.column + self.columns)

    @property
    def around(self) -> tuple[slice, slice]:
        """Index of the rectangle with a border of one sample: all that the ground's surface there depends on."""
        low, left = max(self.row - 1, 0), max(self.column - 1, 0)
        return slice(low, self.row + self.rows + 1), slice(left, self.column + self.columns + 1)


@dataclass(slots=True, eq=False)
class Log:
    """Log of the changes of a map."""

    count: int = 0
    """Number of changes so far."""

    last: deque[Rectangle] = field(default_factory=lambda: deque(maxlen=MOST))
    """Parts changed last, the oldest first."""

    def note(self, part: Rectangle, /) -> None:
        """Log the change of a part."""
        self.count += 1
        self.last.append(part)

    def since(self, count: int, /) -> list[Rectangle] | None:
        """Return the parts changed since the change number `count`; None where too many are, so that any may be."""
        missed = self.count - count
        return None if missed > len(self.last) else list(self.last)[len(self.last) - missed :]
