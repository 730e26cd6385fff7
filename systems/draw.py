"""Drawing: what was uploaded is drawn into the host's framebuffer."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from .around.asked import Asked
from .around.outlook import Outlook
from .govern import Governor
from .painter import Painter


@dataclass(slots=True)
class Draw:
    """The system `draw`: lets receivers hear the winds and draws the picture, as finely as the governor allows."""

    outlooks: Iterable[Outlook]
    painter: Callable[[], Painter]
    """Returns the painter of the current GL context."""

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
