"""Statistics: what a frame took and held."""

from dataclasses import dataclass, field

import numpy as np

from ..engine.schedule import Schedule
from .around.outlook import Outlook
from .blow import Blown
from .govern import Fineness
from .painter import Painter
from .site import Site


@dataclass(slots=True)
class Statistics:
    """What the last frame took and held."""

    systems_ms: dict[str, float] = field(default_factory=dict)
    """Time of each system but `draw` [ms]."""

    draw_ms: float = 0.0
    """Time of the system `draw`, without waiting for the graphics card [ms]."""

    blades_field: int = 0
    """Blades that grow on the whole terrain."""

    blades_considered: int = 0
    """Blades on the patches inside the view cone, whatever their representation."""

    blades_submitted: int = 0
    """Blades drawn as geometry."""

    receivers: int = 0
    """Receivers that heard the wind."""

    draw_calls: int = 0

    patches: dict[str, int] = field(default_factory=dict)
    """Visible patches by representation."""

    fineness: Fineness = field(default_factory=Fineness)
    """What was drawn of the picture, where a frame time is held."""

    transitions: int = 0
    """Patches that were seen to change their representation, or to be changing it; a change of sub-level is none."""

    _counted: object = field(default=None, repr=False, compare=False)
    """What patches appeared as when they were counted last."""

    def count(self, outlook: Outlook, site: Site, systems: Schedule, painter: Painter, /) -> None:
        """Count what a viewer was shown in a frame."""
        if self._counted is None or self._counted is not outlook.appearance:
            self._count_patches(outlook, site)
        self.receivers, self.transitions = outlook.noted(Blown, Blown()).heard, outlook.changing
        self.blades_submitted = painter.blades
        self.systems_ms, self.draw_calls = dict(systems.milliseconds), painter.draw_calls
        self.draw_ms = self.systems_ms.pop("draw", 0.0)

    def _count_patches(self, outlook: Outlook, site: Site) -> None:
        self._counted, patches = outlook.appearance, outlook.patches
        level = patches.representation[patches.shown]
        counts = np.bincount(level + 1, minlength=1 + len(patches.names)).tolist()
        width, depth = site.ground.terrain.size
        share = self.blades_field * site.ground.patch**2 / (width * depth)
        self.blades_considered = round(share * len(level))
        self.patches = dict(zip(patches.names, counts[1:], strict=True))
