"""Where the heads of plants are in the canopy: a line of sight along its top meets them before all else."""

from collections.abc import Sequence

import numpy as np

from ...around.canopy import canopy_height
from ...grow.bend import spine, widths
from ...grow.organs import HEADS
from ...grow.record import Growth

_POINTS = 9
_TAPER = 0.6
"""Of blades among the rows: near enough to share out the leaf area."""

NO_HEADS = (0.0, 0.0, 1.0)


def heads_of(growth: Growth, /) -> tuple[float, float, float]:
    """Return the share that heads have of a kind's leaf area, and from where to where they are in its canopy.

    Heights are parts of the canopy's; the heads are taken to lie evenly between them, with their own mean and variance.
    """
    blades = growth.models[0].blades
    organ = np.broadcast_to(blades.organ, blades.height.shape)
    bears = np.isin(organ, HEADS)
    if not bears.any():
        return NO_HEADS
    centre = spine(blades, growth.postures, (0.0, 0.0), points=_POINTS).astype(np.float64)
    along = (np.arange(_POINTS - 1) + 0.5) / (_POINTS - 1)
    area = widths(blades, along, _TAPER) * blades.height[:, None]
    height = 0.5 * (centre[bears, 1:, 1] + centre[bears, :-1, 1]) / canopy_height(growth)
    mean = np.average(height, weights=area[bears])
    half = np.sqrt(3.0 * np.average((height - mean) ** 2, weights=area[bears]))
    return float(area[bears].sum() / area.sum()), float(mean - half), float(mean + half)


def any_heads(growths: Sequence[Growth], /) -> bool:
    """Return whether any kind bears heads."""
    return any(np.isin(model.blades.organ, HEADS).any() for growth in growths for model in growth.models)
