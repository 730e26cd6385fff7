"""Eyes of heads: how much of their colour organs show."""

import numpy as np

from ...components.arrays import Doubles
from .organs import DYED, eyed_along
from .raster import along_ribbons
from .record import Blades


def eyed(blades: Blades, triangles: Doubles, /, *, points: int, toward: tuple[float, float, float]) -> Doubles:
    """Return the fraction of the eye's colour at the corners of blades' triangles, shape (triangles, 3).

    `triangles` (triangles, 3, 3) are those of ribbons of `points` points each; `toward` points to the viewer. Petals
    are blotched on their inner side only.
    """
    organ = np.broadcast_to(blades.organ, blades.height.shape)
    ends = along_ribbons(eyed_along(organ, np.linspace(0.0, 1.0, points)))
    inner = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) @ np.asarray(toward) > 0.0
    blotched = np.repeat(DYED[organ, 1] < 1.0, 2 * (points - 1))
    return np.asarray(ends * (inner | ~blotched)[:, None])
