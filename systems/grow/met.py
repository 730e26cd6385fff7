"""What a line of sight meets of a canopy whose leaves hide one another by chance (Monsi and Saeki, 1953)."""

import numpy as np

from ...components.arrays import Doubles
from .bend import ribbon, tone
from .raster import ribbon_triangles
from .record import Blades, Postures
from .section import FLAT, Section

_POINTS = 9


def first_met(
    blades: Blades,
    postures: Postures,
    message: Doubles,
    /,
    *,
    heading: Doubles,
    slopes: Doubles,
    patch: float,
    taper: float,
    section: Section = FLAT,
) -> Doubles:
    """Return what lines of sight meet of a field of blades that a message bends, shape (slopes, 3).

    That is how many leaves each would meet on its way to the ground, and of those that stop it the mean place along
    the blade and the mean height [m]. They run along the unit vector `heading` (2,) over level ground and fall by each
    of `slopes` (slopes,) [m/m], or against it where that is below 0; `patch` is the side of the blades' patch [m].
    """
    side = (-float(heading[1]), 0.0, float(heading[0])) if section.is_round else None
    edges = ribbon(blades, postures, message, points=_POINTS, taper=taper, section=section, side=side)
    leaf = ribbon_triangles(*(edge.astype(np.float64) for edge in edges))
    ends = tone(blades, np.linspace(0.0, 1.0, _POINTS))[:, :, None]
    what = np.column_stack([ribbon_triangles(ends, ends)[:, :, 0].mean(axis=1), leaf[:, :, 1].mean(axis=1)])
    normal = 0.5 * np.cross(leaf[:, 1] - leaf[:, 0], leaf[:, 2] - leaf[:, 0])
    order = np.argsort(-what[:, 1])
    along, up = (normal[:, ::2] @ heading)[order], normal[order, 1]
    met = np.abs(along - slopes[:, None] * up) / (patch * patch * np.abs(slopes[:, None]))
    before = np.cumsum(met, axis=1) - 0.5 * met
    stopped = met * np.exp(-before)
    return np.column_stack([met.sum(axis=1), stopped @ what[order] / stopped.sum(axis=1, keepdims=True)])
