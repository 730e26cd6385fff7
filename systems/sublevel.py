"""Sub-levels: how fine each patch's blades and strips are, and which way its strips run."""

import numpy as np
from numpy.typing import NDArray

from ..components.quality import Representation
from .field import Field
from .lod import SLACK, farthest, move_on

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]
Levels = NDArray[np.int8]
Mask = NDArray[np.bool_]
Rows = NDArray[np.int64]

TIGHTER = 1.15
"""How much steeper than needed a patch must be seen for a finer ring to be kept: the slack of slopes."""


def blade_ring(distance: Ints, current: Levels, limits: Ints, /, *, slack: int = SLACK) -> Levels:
    """Return the ring of 3D patches (n,): by discrete distance; a finer one is kept for `slack` patches longer."""
    coarse, fine = np.searchsorted(limits, distance), np.searchsorted(limits, distance - slack)
    return np.where(current < 0, coarse, np.clip(current, fine, coarse)).astype(np.int8)


def strip_ring(
    distance: Ints,
    slope: Floats,
    current: Levels,
    limits: Ints,
    spacing: Floats,
    /,
    *,
    height: float,
    slack: int = SLACK,
) -> Levels:
    """Return the ring of each 2.5D patch (n,): by discrete distance, but finer where it is seen from above.

    A line of sight shall cross at least three strips on its way through grass of this `height` [m], or they show as
    rows on hillsides that face the viewer. `spacing` is the distance between each ring's strips [m]. A finer ring is
    kept for `slack` patches longer.
    """

    def ring(away: Ints, steep: Floats) -> NDArray[np.int64]:
        widest = height / (3.0 * np.maximum(steep, 1e-3))
        by_slope = np.searchsorted(spacing, widest, side="right") - 1
        return np.clip(np.minimum(np.searchsorted(limits, away), by_slope), 0, len(spacing) - 1)

    coarse = ring(distance, slope)
    fine = ring(distance - slack, slope * np.float32(TIGHTER if slack else 1.0))
    return np.where(current < 0, coarse, np.clip(current, fine, coarse)).astype(np.int8)


def strips_along(cell: Ints, centre: Ints, current: NDArray[np.integer], /) -> Levels:
    """Return the axis that each cell's strips run along, so that none is edge-on (paper, section 2.1): 0 is x.

    Near the diagonals, where either axis will do, the `current` one stays; -1 is none.
    """
    apart = np.abs(cell - centre)
    across, ahead = apart[..., 0], apart[..., 1]
    due = across > ahead
    either = 4 * np.maximum(across, ahead) <= 5 * np.minimum(across, ahead)
    return np.where(either & (current >= 0), current, due).astype(np.int8)


def viewing_slope(field: Field, rows: Rows, /) -> Floats:
    """Return the tangent of the angle between the line of sight and the ground on each patch, shape (n,)."""
    table, eye, patch = field.table, field.sight.eye, field.quality.patch
    away = (table.cell[rows] + np.float32(0.5)) * np.float32(patch) - np.array([eye[0], eye[2]], np.float32)
    reach = np.maximum(np.hypot(away[:, 0], away[:, 1]), np.float32(0.5 * patch))
    rise = np.einsum("ij,ij->i", table.slope[rows], away)
    slope: Floats = (np.float32(eye[1]) - table.height[rows] + rise) / reach
    return slope


def wanted_sublevels(field: Field, rows: Rows, held: Levels, /) -> Levels:
    """Return which sub-level of blades and of strips is due on patches (n,) that have those of `held`, both (2, n).

    That of blades is their ring; that of strips is twice their ring and the axis that they run along.
    """
    table, quality = field.table, field.quality
    slack = SLACK if field.transitions.hysteresis else 0
    limits = np.array([ring.to for ring in quality.blade_rings[:-1]], np.int32)
    distance = table.distance[rows]
    near = blade_ring(distance, held[0], limits, slack=slack)
    rings = quality.strip_rings
    limits = np.array([ring.to for ring in rings[:-1]], np.int32)
    spacing = np.array([quality.patch / ring.strips for ring in rings], np.float32)
    height = min(strips.height for strips in field.stock.strips[0])
    before = held[1] >> 1
    slope = viewing_slope(field, rows)
    ring = strip_ring(distance, slope, before, limits, spacing, height=height, slack=slack)
    along = strips_along(table.cell[rows], field.sight.centre, np.where((held[1] < 0) | (slack == 0), -1, held[1] & 1))
    return np.stack([near, 2 * ring + along]).astype(np.int8)


def refine(field: Field, was_visible: Mask, weight: Floats, /, *, part: float) -> None:
    """Advance changes of sub-levels by `part` and start those that are due; `weight` is (3, rows).

    Where a representation does not show, its sub-level is due at once; while a patch goes from blades to strips or
    back, none changes, so that each blade keeps its painted place. Patches too far away for either stay as they are.
    """
    table = field.table
    rows = np.flatnonzero(table.distance <= farthest(field.reach)[1])
    now, before, progress = (
        array[:, rows] for array in (table.sublevel, table.sublevel_before, table.sublevel_progress)
    )
    seen = (was_visible & table.visible)[rows] & (weight[: Representation.CARPET, rows] > 0.0) & (now >= 0)
    wanted = wanted_sublevels(field, rows, np.where(seen, now, np.int8(-1)))
    has, had = table.representation[rows], table.previous[rows]
    both = (table.progress[rows] < 1.0) & (weight[Representation.CARPET, rows] == 0.0) & (has != had)
    progress[:, both] = 1.0
    for level in (Representation.BLADES, Representation.STRIPS):
        shows = seen[level] & field.transitions.gradual
        due = np.where(both & shows, now[level], wanted[level])
        move_on(now[level], before[level], progress[level], due, shows, part=part)
    table.sublevel[:, rows], table.sublevel_before[:, rows], table.sublevel_progress[:, rows] = now, before, progress
