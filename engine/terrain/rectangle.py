"""Rectangles of the samples of maps."""

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
