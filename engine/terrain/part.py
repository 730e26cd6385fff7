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

    @property
    def slices(self) -> tuple[slice, slice]:
        """What an array of heights is indexed with."""
        return slice(self.row, self.row + self.rows), slice(self.column, self.column + self.columns)

    @property
    def around(self) -> tuple[slice, slice]:
        """The same with the samples next to it: it and they make out the ground that it is part of."""
        low, left = max(self.row - 1, 0), max(self.column - 1, 0)
        return slice(low, self.row + self.rows + 1), slice(left, self.column + self.columns + 1)
