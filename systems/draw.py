"""Drawing: what was gathered is drawn into the host's framebuffer."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from .around.asked import Asked
from .around.outlook import Outlook
from .govern import Governor
from .painter import Painter


@dataclass(slots=True)
class Draw:
    """The system `draw`: the receivers of what is shown hear the winds, and it is drawn, as fine as time lets it be."""

    outlooks: Iterable[Outlook]
    painter: Callable[[], Painter]
    """Gives the painter of the GL context that is drawn in."""

    governor: Governor

    def run(self) -> None:
        """Draw for every viewer that looks."""
        for outlook in self.outlooks:
            assert outlook.view is not None
            painter = self.painter()
            with self.governor.watching(painter, outlook.viewer.name) as fineness:
                assert painter.site is not None
                scale = fineness.scale * painter.site.quality.pixels
                painter.draw(outlook.view, outlook.noted(Asked, Asked()), scale=scale)
