"""How far what is seen of organs has the colour of their head's eye."""

import numpy as np

from ...components.arrays import Doubles
from .organs import DYED, eyed_along
from .raster import ribbon_triangles
from .record import Blades


def eyed(blades: Blades, triangles: Doubles, /, *, points: int, toward: tuple[float, float, float]) -> Doubles:
    """Return how far the triangles of blades have the colour of an eye at their corners, shape (triangles, 3).

    `triangles` (triangles, 3, 3) are those of ribbons of so many points each, and `toward` leads to who looks at them.
    Petals are blotched within alone: from outside none of that is seen.
    """
    organ = np.broadcast_to(blades.organ, blades.height.shape)
    ends = eyed_along(organ, np.linspace(0.0, 1.0, points))[:, :, None]
    within = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) @ np.asarray(toward) > 0.0
    blotched = np.repeat(DYED[organ, 1] < 1.0, 2 * (points - 1))
    return np.asarray(ribbon_triangles(ends, ends)[:, :, 0] * (within | ~blotched)[:, None])
