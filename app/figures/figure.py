"""What a figure is: its number in the paper, what it tells, and what draws it."""

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class Detail:
    """How fine figures are drawn."""

    size: tuple[int, int] = (960, 540)
    """Width and height of each rendered picture [pixels]."""

    preset: str | None = None
    """Quality of what is rendered; without it each scene's own."""

    dots: int = 1440
    """Width of a plot [pixels]."""


@dataclass(frozen=True, slots=True)
class PaperFigure:
    """One figure of the paper."""

    number: int
    title: str

    shows: str
    """One sentence on what is to be seen."""

    made: str
    """One sentence on how it was made."""

    draw: Callable[[Detail], Figure]

    @property
    def file(self) -> str:
        """Name of its file."""
        return f"figure-{self.number:02d}.png"
