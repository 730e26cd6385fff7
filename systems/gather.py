"""Gathering: what is shown is sent to the graphics card."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from .around.outlook import Outlook
from .painter import Painter


@dataclass(slots=True)
class Gather:
    """The system `gather`: what each representation and each feature shows is sent to the graphics card."""

    outlooks: Iterable[Outlook]
    painter: Callable[[], Painter]
    """Gives the painter of the GL context that is drawn in."""

    def run(self) -> None:
        """Gather for every viewer that looks."""
        for outlook in self.outlooks:
            self.painter().write(outlook)
