"""Sub-levels: how fine each patch's blades and strips are, and which way its strips run."""

import numpy as np
from numpy.typing import NDArray

from ..engine.declared.quality import Representation
from .field import Field
from .lod import SLACK, farthest, move_on
from .show.blades.sublevel import blade_ring
from .show.strips.sublevel import strip_ring, strips_along, viewing_slope

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]
Levels = NDArray[np.int8]
Mask = NDArray[np.bool_]
Rows = NDArray[np.int64]


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
