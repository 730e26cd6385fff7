"""Rectangles of the samples of maps."""

from typing import NamedTuple

MOST = 4096
"""Changes that are told apart; who has missed more takes over all heights."""


class Part(NamedTuple):
    """A rectangle of samples."""

    row: int
    """The first of its rows."""

    column: int
    """The first of its columns."""

    rows: int
    columns: int

    def moved(self, down: int, right: int) -> "Part":
        """Return the same rectangle so many samples farther down and to the right."""
        return Part(self.row + down, self.column + right, self.rows, self.columns)

    def within(self, rows: int, columns: int) -> "Part | None":
        """Return what of it lies among the first rows and columns, if any does."""
        top, left = max(self.row, 0), max(self.column, 0)
        bottom, right = min(self.row + self.rows, rows), min(self.column + self.columns, columns)
        return Part(top, left, bottom - top, right - left) if top < bottom and left < right else None

    @property
    def slices(self) -> tuple[slice, slice]:
        """What an array of heights is indexed with."""
        return slice(self.row, self.row + self.rows), slice(self.column, self.column + self.columns)

    @property
    def around(self) -> tuple[slice, slice]:
        """The same with the samples next to it: it and they make out the ground that it is part of."""
        low, left = max(self.row - 1, 0), max(self.column - 1, 0)
        return slice(low, self.row + self.rows + 1), slice(left, self.column + self.columns + 1)
