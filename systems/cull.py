"""Culling: which patches the view cone may hold (paper, section 2.2, figure 5)."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from .around.cone import HALF_DIAGONAL, beyond_cone
from .around.outlook import Outlook


@dataclass(slots=True)
class Cull:
    """The system `cull`: which patches the view cone of each viewer that looks may hold."""

    outlooks: Iterable[Outlook]
    patch: float
    """Side of a patch [m]."""

    sway: float
    """How far grass may reach beyond its patch [m]."""

    def run(self) -> None:
        """Cull for every viewer that looks."""
        for outlook in self.outlooks:
            patches, viewer = outlook.patches, outlook.viewer
            patches.was_visible[:] = patches.visible
            beyond = beyond_cone(*patches.lines, apex=(viewer.eye[0], viewer.eye[2]), cone=viewer.cone).ravel()
            np.less_equal(beyond, HALF_DIAGONAL * self.patch + self.sway, out=patches.visible)
            np.less_equal(beyond, 2.0 * self.patch + self.sway, out=patches.near)
