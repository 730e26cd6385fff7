"""Culling: which patches the view cone may hold (paper, section 2.2, figure 5)."""

from collections.abc import Iterable
from dataclasses import dataclass

from .around.cone import HALF_DIAGONAL, inside_cone
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
            apex = viewer.eye[0], viewer.eye[2]
            for rows, far in ((patches.visible, HALF_DIAGONAL * self.patch), (patches.near, 2.0 * self.patch)):
                rows[:] = inside_cone(patches.middle, apex=apex, cone=viewer.cone, radius=far + self.sway)
