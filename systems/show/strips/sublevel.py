"""Sub-levels of strips: the ring that a patch is in, and which way its strips run."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints, Levels, Mask, Rows
from ...around.patches import PatchTable
from ...space.cone import cells_apart

TIGHTER = 1.15
"""How much steeper than needed a patch must be seen for a finer ring to be kept: the slack of slopes."""

ENOUGH = 3.6
"""How many strips a line of sight crosses, at least, where finer ones are to be had; and more the steeper it is."""

STEEPER = 1.3
"""How many times more of them that is for each unit of its slope: from above, blades hide less of the rows behind."""

CROSSED = 0.85
"""How many strips a line of sight must cross for them not to show as rows, where no finer ones are to be had."""

GLSL = {"CROSSED": CROSSED}

SINKING = 0.5
"""Strips begin to sink into the carpet at this part of the slope at which they would show as rows."""

APART = 4.0
"""Discrete distance from which on a line of sight must cross more strips, in proportion to the distance: there blades
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

    A line of sight shall cross `ENOUGH` strips and more on its way through grass of this `height` [m], or they show as
    rows on hillsides that face the viewer. `spacing` is the distance between each ring's strips [m]. A finer ring is
    kept for `slack` patches longer.
    """
    # Two lines: what is due on the way out, and what is due on the way back.
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
    """Return on which patches (n,) the finest strips would show as rows, seen at these slopes and distances.

    A line of sight crosses fewer than `CROSSED` strips, `spacing` [m] apart, on its way through grass of this `height`
    [m], one or that of each patch (n,). With `slack`, patches that have strips already, as `has` (n,) says, keep them
    a little longer.
    """
    steepest = _steepest(distance, height, spacing)
    return np.asarray(slope > np.where(has, steepest * TIGHTER, steepest) if slack else slope > steepest)


def left_of(slope: Floats, distance: Floats, /, *, height: Floats | float, spacing: float) -> Floats:
    """Return how much is left of strips on patches (n,) where they come near to showing as rows, from 1 to 0."""
    steepest = _steepest(distance, height, spacing)
    span = np.maximum((1.0 - SINKING) * steepest, 1e-6)
    return np.asarray(np.clip((steepest - slope) / span, 0.0, 1.0), np.float32)


def _steepest(distance: Ints | Floats, height: Floats | float, spacing: float) -> Floats:
    farther = np.maximum(distance.astype(np.float32), np.float32(APART))
    return np.asarray(height * np.float32(APART / (spacing * CROSSED)) / farther, np.float32)


def looked_down_on(slope: Floats, drop: Floats, distance: Ints | Floats, /) -> Floats:
    """Return as how steep patches (n,) count for the rows that strips show, seen at these slopes and distances.

    From above, rows lie in line all over a plain, and the last ones would be a line across it: the farther away a patch
    is that the eye looks down on, the steeper it counts, so that strips sink before they end. `drop` is the tangent of
    how far below the horizon it is seen: a hillside that faces an eye as high as itself counts as steep as it is.
    """
    farther = np.sqrt(np.maximum(distance.astype(np.float32), np.float32(APART)) / np.float32(APART))
    return np.asarray(np.maximum(slope, np.minimum(slope, drop) * farther), np.float32)


def strips_along(cell: Ints, centre: Ints, current: NDArray[np.integer], /) -> Levels:
    """Return the axis that each cell's strips run along, so that none is edge-on (paper, section 2.1): 0 is x.

    Near the diagonals, where either axis will do, the `current` one stays; -1 is none.
    """
    across, ahead = cells_apart(cell, centre)
    due = across > ahead
    either = 4 * np.maximum(across, ahead) <= 5 * np.minimum(across, ahead)
    along: Levels = np.where(either & (current >= 0), current, due).astype(np.int8)
    return along


def viewing_slope(
    patches: PatchTable, rows: Rows, /, *, eye: tuple[float, float, float], patch: float
) -> tuple[Floats, Floats]:
    """Return the tangents of the angles of sight to the ground on each patch, and to the horizon, shape (n,) each."""
    (x, z), (along_x, along_z) = patches.middle.T, patches.slope.T
    x, z = x[rows] - np.float32(eye[0]), z[rows] - np.float32(eye[2])
    rise = along_x[rows] * x + along_z[rows] * z
    reach = np.maximum(np.hypot(x, z), np.float32(0.5 * patch))
    above = np.float32(eye[1]) - patches.height[rows]
    return (above + rise) / reach, above / reach


def packed(ring: Levels, axis: Levels, /) -> Levels:
    """Return the sub-level that a ring and the axis that strips run along make together, shape (n,)."""
    return 2 * ring + axis


def ring_of(sublevel: Levels, /) -> NDArray[np.int64]:
    """Return the ring that sub-levels (n,) are of; -1 for none."""
    return sublevel.astype(np.int64) >> 1


def axis_of(sublevel: Levels, /) -> Ints:
    """Return the axis that strips of sub-levels (n,) run along: 0 is x, 1 is z."""
    return (sublevel & 1).astype(np.int32)
