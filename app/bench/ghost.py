"""Ghosts: whether a patch on its way is the picture before and the picture after, laid over one another."""

import numpy as np

from ...components.arrays import Doubles
from ...engine.camera import Camera
from ...systems.prairie import Prairie
from ..studio.studio import Studio
from .contrast import luma

FAINT = 1.0
"""Difference between the two pictures that nobody sees, as a root of the mean square [steps of 255]."""


def ends_of_change(studio: Studio, prairie: Prairie, camera: Camera, /) -> tuple[Doubles, Doubles]:
    """Return the luma of this instant as if no change had begun yet, and as if all were over, both (height, width).

    The prairie must have been drawn at this instant from there, and be held as to how far its changes are. Nothing that
    it keeps is changed.
    """
    patches, matrices = prairie.viewers["main"].patches, studio.matrices(camera)
    columns = (patches.progress, patches.sublevel_progress)
    kept, pictures = [column.copy() for column in columns], []
    for end in (0.0, 1.0):
        for column, before in zip(columns, kept, strict=True):
            column[:] = np.where(before < 1.0, np.float32(end), before)
        studio.begin()
        prairie.draw(*matrices)
        pictures.append(luma(studio.read()))
    for column, before in zip(columns, kept, strict=True):
        column[:] = before
    prairie.follow(*matrices)  # what the next frame goes on from is this one as it was
    return pictures[0], pictures[1]


def ghosted(seen: Doubles, before: Doubles, after: Doubles, /) -> float:
    """Return how much a picture is two others laid over one another, 0 to 1, all of one shape.

    It is 1 where it is the mean of both in every pixel, and 0 where it is one of them, or neither: where what it shows
    is in between, as blades are that move from one place to another.
    """
    apart, way = before - after, seen - after
    whole = float((apart * apart).sum())
    if whole <= FAINT * FAINT * apart.size:
        return 0.0
    share = min(max(float((way * apart).sum()) / whole, 0.0), 1.0)
    rest = float(((way - share * apart) ** 2).sum())
    return max(0.0, 4.0 * (share * (1.0 - share) - rest / whole))
