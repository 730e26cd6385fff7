"""Statistics: times and counts of a frame."""

from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..engine.gl.remembered import Remembered
from ..engine.schedule import Schedule
from .around.outlook import Outlook
from .blow import Blown
from .govern import Fineness
from .painter import Painter
from .site import Site

Counts = tuple[int, dict[str, int]]
"""Number of blades considered, and numbers of visible patches by representation."""


@dataclass(slots=True)
class Statistics:
    """Times and counts of the last frame."""

    systems_ms: dict[str, float] = field(default_factory=dict)
    """Time of each system but `draw` [ms]."""

    draw_ms: float = 0.0
    """Time of the system `draw`, without the graphics card's [ms]."""

    blades_field: int = 0
    """Number of blades on the whole terrain."""

    blades_considered: int = 0
    """Number of blades on the patches in the view cone, in all representations."""

    blades_submitted: int = 0
    """Number of blades drawn as geometry."""

    receivers: int = 0
    """Number of receivers that heard the wind."""

    draw_calls: int = 0

    patches: dict[str, int] = field(default_factory=dict)
    """Numbers of visible patches by representation."""

    fineness: Fineness = field(default_factory=Fineness)
    """Fractions of pixels and distances that were drawn to hold the frame time."""

    transitions: int = 0
    """Number of visible patches that changed or were changing their representation, not merely a sub-level."""

    _counts: Remembered[Counts] = field(default_factory=Remembered, repr=False, compare=False)

    def count(self, outlook: Outlook, site: Site, systems: Schedule, painter: Painter, /) -> None:
        """Take the times and counts of a viewer's frame."""
        appears = outlook.appearance
        made_of = None if appears is None else (appears, site)
        made = self._counts.of(outlook.viewer.name, made_of, partial(_counts_of, outlook, site, self.blades_field))
        self.blades_considered, self.patches = made[0], dict(made[1])
        self.receivers, self.transitions = outlook.noted(Blown, Blown()).heard, outlook.changing
        self.blades_submitted = painter.blades
        self.systems_ms, self.draw_calls = dict(systems.milliseconds), painter.draw_calls
        self.draw_ms = self.systems_ms.pop("draw", 0.0)


def _counts_of(outlook: Outlook, site: Site, blades: int) -> Counts:
    patches, ground = outlook.patches, site.ground
    level = patches.representation[patches.shown]
    counts = np.bincount(level + 1, minlength=1 + len(patches.names)).tolist()
    width, depth = ground.terrain.size
    share = blades * ground.patch**2 / (width * depth)
    return round(share * len(level)), dict(zip(patches.names, counts[1:], strict=True))
