"""The record of a figure: its number in the paper, its texts, and the function that draws it."""

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class Detail:
    """The resolution and quality of figures."""

    size: tuple[int, int] = (960, 540)
    """Width and height of each rendered picture [pixels]."""

    preset: str | None = None
    """Name of the quality preset; None for each scene's own quality."""

    dots: int = 1440
    """Width of a plot [pixels]."""


@dataclass(frozen=True, slots=True)
class PaperFigure:
    """One figure of the paper."""

    number: int
    title: str

    shows: str
    """One sentence on its contents."""

    made: str
    """One sentence on how it was made."""

    draw: Callable[[Detail], Figure]

    @property
    def file(self) -> str:
        """Name of its file."""
        return f"figure-{self.number:02d}.png"
