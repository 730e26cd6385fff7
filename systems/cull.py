"""Culling: patches that may be in the view cone, and from high above in the frustum (paper, section 2.2, figure 5)."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from math import pi

import numpy as np

from .around.outlook import Outlook
from .space.cone import HALF_DIAGONAL, outside_cone
from .space.frustum import outside_planes_on_grid

HIGH_UP = 10.0
"""Height above the highest ground around from which the frustum's upper and lower planes are worth testing [m]."""


@dataclass(slots=True)
class Cull:
    """The system `cull`: marks the patches that may be in the view cone of each viewer that looks."""

    outlooks: Iterable[Outlook]
    patch: float
    """Side of a patch [m]."""

    sway: float
    """Distance that grass may reach beyond its patch [m]."""

    def run(self) -> None:
        """Cull for every viewer that looks."""
        for outlook in self.outlooks:
            viewer = outlook.viewer
            seen = viewer.eye, viewer.cone, viewer.sides.tobytes(), viewer.centre.tobytes(), outlook.heights
            outlook.unless_at_rest(self, seen, partial(self._run, outlook))

    def _run(self, outlook: Outlook) -> None:
        patches, viewer = outlook.patches, outlook.viewer
        patches.was_visible[:] = patches.visible
        outside = outside_cone(*patches.lines, apex=(viewer.eye[0], viewer.eye[2]), cone=viewer.cone)
        if viewer.cone[1] >= pi or viewer.eye[1] > HIGH_UP + float(patches.height.max()):
            heights = patches.height.reshape(patches.side, patches.side)
            outside = np.maximum(outside, outside_planes_on_grid(*patches.lines, heights, viewer.sides))
        outside = outside.ravel()
        np.less_equal(outside, HALF_DIAGONAL * self.patch + self.sway, out=patches.visible)
        np.less_equal(outside, 2.0 * self.patch + self.sway, out=patches.near)
