"""Gathering: what is shown is sent to the graphics card."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from ..components.body import Body
from ..components.shade import Shade
from .around.outlook import Outlook
from .painter import Painter


@dataclass(slots=True)
class Gather:
    """The system `gather`: what each representation shows, and what flies, is sent to the graphics card."""

    outlooks: Iterable[Outlook]
    painter: Callable[[], Painter]
    """Gives the painter of the GL context that is drawn in."""

    bodies: Callable[[float], Sequence[Body]]
    """Gives what is in the air at a time [s]."""

    shades: Callable[[], Sequence[Shade]] = tuple
    """Gives what else casts shadows."""

    def run(self) -> None:
        """Gather for every viewer that looks."""
        for outlook in self.outlooks:
            outlook.blades = self.painter().write(outlook, self.bodies(outlook.viewer.time), self.shades())
