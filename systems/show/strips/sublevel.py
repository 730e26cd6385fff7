"""Sub-levels of strips: the ring that a patch is in, and the axis that its strips run along."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints, Levels, Mask, Rows
from ...around.patches import PatchTable
from ...space.cone import cells_apart

TIGHTER = 1.15
"""Factor on the slope of a line of sight while a finer ring is kept: the hysteresis of slopes."""

ENOUGH = 3.6
"""Number of strips that a level line of sight crosses at least, where finer rings are to be had."""

STEEPER = 1.3
"""Relative increase of that number for each unit of slope: from above, blades hide less of the rows behind."""

CROSSED = 0.85
"""Number of strips that a line of sight must cross, or the finest ring shows as rows."""

GLSL = {"CROSSED": CROSSED}

SINKING = 0.5
"""Slope at which strips begin to sink into the carpet, as a fraction of the slope at which they would show as rows."""

APART = 4.0
"""Discrete distance beyond which the number of strips to be crossed grows in proportion to the distance: there blades
are thinner than pixels, and would not hide the rows."""


def strip_ring(
    distance: Ints,
    slope: Floats,
    current: Levels,
    limits: Floats,
    spacing: Floats,
    /,
    *,
    height: float,
    slack: int,
) -> Levels:
    """Return the ring of each 2.5D patch (n,): by discrete distance, but finer where it is seen from above.

    Strips show as rows on hillsides that face the viewer, unless a line of sight crosses `ENOUGH` of them, and more the
    steeper it is, on its way through grass of this `height` [m]. `limits` are the distances at which rings end, and
    `spacing` the distances between each ring's strips [m]. A finer ring than is due is kept for `slack` patches.
    """
    # The first row has the limits on the way out, the second those on the way back.
    away = np.stack([distance, distance - slack])
    steep = np.stack([slope, slope * np.float32(TIGHTER if slack else 1.0)])
    widest = height / (ENOUGH * np.maximum(steep, 1e-3) * (1.0 + STEEPER * np.maximum(steep, 0.0)))
    by_slope = spacing.searchsorted(widest, side="right") - 1
    ring: Levels = np.maximum(np.minimum(limits.searchsorted(away), by_slope), 0).astype(np.int8)
    coarse, fine = ring
    kept: Levels = np.where(current < 0, coarse, np.minimum(np.maximum(current, fine), coarse))
    return kept


def shows_rows(
    slope: Floats, distance: Ints | Floats, has: Mask, /, *, height: Floats | float, spacing: float, slack: int
) -> Mask:
    """Return whether the finest strips would show as rows on each patch (n,), at these slopes and distances.

    They do where a line of sight crosses fewer than `CROSSED` strips, `spacing` [m] apart, on its way through grass of
    this `height` [m], one number or (n,). With `slack`, patches that `has` (n,) strips already keep them a little
    longer.
    """
    steepest = _steepest(distance, height, spacing)
    return np.asarray(slope > np.where(has, steepest * TIGHTER, steepest) if slack else slope > steepest)


def remaining(slope: Floats, distance: Floats, /, *, height: Floats | float, spacing: float) -> Floats:
    """Return the part of strips that shows on patches (n,): it falls from 1 to 0 before they would show as rows."""
    steepest = _steepest(distance, height, spacing)
    span = np.maximum((1.0 - SINKING) * steepest, 1e-6)
    return np.asarray(np.clip((steepest - slope) / span, 0.0, 1.0), np.float32)


def _steepest(distance: Ints | Floats, height: Floats | float, spacing: float) -> Floats:
    """Return the slopes of sight up to which strips do not show as rows, shape (n,)."""
    farther = np.maximum(distance.astype(np.float32), np.float32(APART))
    return np.asarray(height * np.float32(APART / (spacing * CROSSED)) / farther, np.float32)


def effective_slope(slope: Floats, drop: Floats, distance: Ints | Floats, /) -> Floats:
    """Return the slopes of sight to patches (n,), raised with distance where the eye looks down on a patch.

    From above, rows lie in line all over a plain, and the last ones would be a line across it. Raised slopes let strips
    sink before they end. `drop` (n,) is the tangent of a patch's angle below the horizon: a hillside that faces an eye
    at its own height keeps its slope.
    """
    farther = np.sqrt(np.maximum(distance.astype(np.float32), np.float32(APART)) / np.float32(APART))
    return np.asarray(np.maximum(slope, np.minimum(slope, drop) * farther), np.float32)


def strips_along(cell: Ints, centre: Ints, current: NDArray[np.integer], /) -> Levels:
    """Return the axis that each cell's strips run along, so that none is edge-on (paper, section 2.1): 0 is x, 1 is z.

    Near the diagonals, where either axis will do, the `current` axis is kept; -1 is none.
    """
    across, ahead = cells_apart(cell, centre)
    due = across > ahead
    either = 4 * np.maximum(across, ahead) <= 5 * np.minimum(across, ahead)
    along: Levels = np.where(either & (current >= 0), current, due).astype(np.int8)
    return along


def viewing_slope(
    patches: PatchTable, rows: Rows, /, *, eye: tuple[float, float, float], patch: float
) -> tuple[Floats, Floats]:
    """Return the tangents of two angles of the line of sight to each patch: to its ground, and to the horizon."""
    (x, z), (along_x, along_z) = patches.middle.T, patches.slope.T
    x, z = x[rows] - np.float32(eye[0]), z[rows] - np.float32(eye[2])
    rise = along_x[rows] * x + along_z[rows] * z
    reach = np.maximum(np.hypot(x, z), np.float32(0.5 * patch))
    above = np.float32(eye[1]) - patches.height[rows]
    return (above + rise) / reach, above / reach


def packed(ring: Levels, axis: Levels, /) -> Levels:
    """Return sub-levels (n,), each made of a ring and of the axis that strips run along."""
    return 2 * ring + axis


def ring_of(sublevel: Levels, /) -> NDArray[np.int64]:
    """Return the ring of each sub-level (n,); -1 for none."""
    return sublevel.astype(np.int64) >> 1


def axis_of(sublevel: Levels, /) -> Ints:
    """Return the axis that strips of each sub-level (n,) run along: 0 is x, 1 is z."""
    return (sublevel & 1).astype(np.int32)
