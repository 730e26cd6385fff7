"""Gathering: what a frame shows is uploaded to the graphics card."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from .around.outlook import Outlook
from .painter import Painter


@dataclass(slots=True)
class Gather:
    """The system `gather`: uploads what each representation and each feature shows."""

    outlooks: Iterable[Outlook]
    painter: Callable[[], Painter]
    """Returns the painter of the current GL context."""

    def run(self) -> None:
        """Gather for every viewer that looks."""
        for outlook in self.outlooks:
            self.painter().write(outlook)
