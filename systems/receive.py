"""Receiving: patches that are shown are planted, and their receivers hear the primitives.

A `Shown` record names the patches drawn in one representation this frame; everything below works on all of them at
once, in a few numpy passes.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..components.quality import Representation
from ..components.receivers import BladePool, StripPool
from .cull import far_to_near
from .field import Field, densest_kind
from .lod import thinned_out, weights
from .plant import heading_of, plant_blades, plant_strips, strips_along
from .tile import window_rows
from .wind.blow import Listeners
from .wind.grass import grass_of

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]
Rows = NDArray[np.int64]


HASTE = np.array([2.0, 2.0, 1.0], np.float32)
"""How much sooner than its share in a change each representation shows."""


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """The patches drawn in one ring of one representation, far to near."""

    rows: Rows
    """Rows of the patch table, shape (m,)."""

    slots: Rows
    """Slots of the ring's pool, shape (m,)."""

    fade: Floats
    """How much of each shows, in (0, 1], shape (m,)."""

    along: Ints
    """Axis along which each patch's strips run, shape (m,)."""

    queue: Rows
    """Place of each in the far-to-near order of all rings' patches, shape (m,)."""


def shares(field: Field, /) -> Floats:
    """Return how much each representation shows on each patch of the table, shape (3, rows).

    While blades or strips fade the others are there already: no ground shows through a change.
    """
    table, eye, patch = field.table, field.sight.eye, np.float32(field.quality.patch)
    away = np.abs((table.cell + np.float32(0.5)) * patch - np.array([eye[0], eye[2]], np.float32)).max(axis=1)
    hasty = np.minimum(weights(table) * HASTE[:, None], np.float32(1.0))
    return thinned_out(hasty, away / patch, reach=field.reach[Representation.STRIPS])


def carpet_shares(field: Field, /) -> Floats:
    """Return how much the carpet shows on each patch of the table, shape (rows,); beyond the terrain's edge, whole."""
    return np.where(field.table.alive, shares(field)[Representation.CARPET], np.float32(1.0))


def viewing_slope(field: Field, rows: Rows, /) -> Floats:
    """Return the tangent of the angle between the line of sight and the ground on each patch, shape (n,)."""
    table, eye, patch = field.table, field.sight.eye, field.quality.patch
    away = (table.cell[rows] + np.float32(0.5)) * np.float32(patch) - np.array([eye[0], eye[2]], np.float32)
    reach = np.maximum(np.hypot(away[:, 0], away[:, 1]), np.float32(0.5 * patch))
    rise = np.einsum("ij,ij->i", table.slope[rows], away)
    slope: Floats = (np.float32(eye[1]) - table.height[rows] + rise) / reach
    return slope


def strip_ring(distance: Ints, slope: Floats, limits: Ints, spacing: Floats, /, *, height: float) -> NDArray[np.int64]:
    """Return the ring of each 2.5D patch (n,): by discrete distance, but finer where it is seen from above.

    A line of sight shall cross at least three strips on its way through grass of this `height` [m], or they show as
    rows on hillsides that face the viewer. `spacing` is the distance between each ring's strips [m].
    """
    by_distance = np.searchsorted(limits, distance)
    widest = height / (3.0 * np.maximum(slope, 1e-3))
    by_slope = np.searchsorted(spacing, widest, side="right") - 1
    return np.clip(np.minimum(by_distance, by_slope), 0, len(spacing) - 1)


def shown_blades(field: Field, /) -> list[Shown]:
    """Return the visible 3D patches by ring."""
    rows, share = _visible(field, Representation.BLADES)
    limits = np.array([ring.to for ring in field.quality.blade_rings[:-1]], np.int32)
    ring = np.searchsorted(limits, field.table.distance[rows])
    return _by_ring(field, rows, share, ring, field.blades.side, len(limits) + 1)


def shown_strips(field: Field, /) -> list[Shown]:
    """Return the visible 2.5D patches by ring."""
    rows, share = _visible(field, Representation.STRIPS)
    rings = field.quality.strip_rings
    limits = np.array([ring.to for ring in rings[:-1]], np.int32)
    spacing = np.array([field.quality.patch / ring.strips for ring in rings], np.float32)
    height = min(strips.height for strips in field.stock.strips[0])
    ring = strip_ring(field.table.distance[rows], viewing_slope(field, rows), limits, spacing, height=height)
    return _by_ring(field, rows, share, ring, field.strips[0].side, len(rings))


def _visible(field: Field, level: Representation) -> tuple[Rows, Floats]:
    table = field.table
    share = shares(field)[level]
    rows = np.flatnonzero(table.alive & table.visible & (share > 0.0))
    return rows[far_to_near(table.cell[rows], field.sight.centre)], share


def _by_ring(field: Field, rows: Rows, share: Floats, ring: NDArray[np.int64], side: int, rings: int) -> list[Shown]:
    table = field.table
    shown = []
    for number in range(rings):
        queue = np.flatnonzero(ring == number)
        chosen = rows[queue]
        cells = table.cell[chosen]
        slots = window_rows(cells, side=side)
        shown.append(Shown(chosen, slots, share[chosen], strips_along(cells, field.sight.centre), queue))
    return shown


def plant_shown_blades(field: Field, shown: list[Shown]) -> Rows:
    """Plant the patches in `shown` whose slot holds another's blades; return the rows planted."""
    table, centre = field.table, field.sight.centre
    rows: Rows = np.concatenate([ring.rows for ring in shown])
    slots = np.concatenate([ring.slots for ring in shown])
    heading = heading_of(table.cell[rows], centre)
    stale = (field.blades.stamp[slots] != np.column_stack([table.cell[rows], heading])).any(axis=1)
    rows, slots, heading = rows[stale], slots[stale], heading[stale]
    if rows.size:
        cell, model, turn = table.cell[rows], table.model[rows], table.turn[rows]
        plant_blades(field.blades, slots, cell, model, turn, heading, field.stock.blades, field.ground)
    return rows


def plant_shown_strips(field: Field, ring: int, shown: Shown) -> Rows:
    """Plant the patches in `shown` whose slot holds another's strips or the other orientation; return the rows."""
    pool, table, stock = field.strips[ring], field.table, field.stock
    wanted = np.column_stack([table.cell[shown.rows], shown.along])
    stale = (pool.stamp[shown.slots] != wanted).any(axis=1)
    rows: Rows = shown.rows[stale]
    if rows.size:
        plant_strips(
            pool, shown.slots[stale], table.cell[rows], table.model[rows], table.turn[rows], shown.along[stale],
            stock.strips[ring], stock.first_layer[ring], field.ground,
        )  # fmt: skip
    return rows


def blow(
    field: Field,
    blades: list[Shown],
    strips: list[Shown],
    hear: Callable[[Listeners], Floats],
    /,
    *,
    carpet: Rows | None = None,
) -> Floats:
    """Let every receiver that is seen hear the winds, in one pass over them all; return their messages, (n, 2).

    With them hear the patches in these rows of the table, for their carpet: what is felt in their middle, without the
    small oscillations.
    """
    rows = np.zeros(0, np.int64) if carpet is None else carpet
    near = np.concatenate([ring.rows for ring in blades]), np.concatenate([ring.slots for ring in blades])
    pools: list[tuple[BladePool | StripPool, Rows, Rows]] = [(field.blades, *near)]
    pools += [(pool, ring.rows, ring.slots) for pool, ring in zip(field.strips, strips, strict=True)]
    heard = hear(_listeners(field, pools, rows))
    start = 0
    for pool, _, slots in pools:
        shape = pool.message[slots].shape
        end = start + shape[0] * int(np.prod(shape[1:-1]))
        pool.message[slots] = heard[start:end].reshape(shape)
        start = end
    field.table.message[rows] = heard[start:]
    return heard[:start]


def _listeners(field: Field, pools: list[tuple[BladePool | StripPool, Rows, Rows]], carpet: Rows) -> Listeners:
    place = [pool.place[slots].reshape(-1, 2) for pool, _, slots in pools]
    rows = np.concatenate([*(rows for _, rows, _ in pools), carpet])
    each = [
        np.full(len(slots), len(one) // max(len(slots), 1)) for one, (_, _, slots) in zip(place, pools, strict=True)
    ]
    side = field.quality.patch
    middle = ((field.table.cell[rows] + 0.5) * side).astype(np.float32)
    far = middle[len(rows) - len(carpet) :]
    kind = np.concatenate([*(pool.kind(slots) for pool, _, slots in pools), densest_kind(field, far)])
    return Listeners(
        place=np.concatenate([*place, far]),
        grass=grass_of(field.growths, kind),
        patch=np.repeat(np.arange(len(rows)), np.concatenate([*each, np.ones(len(carpet), np.int64)])),
        middle=middle,
        radius=0.7072 * (side + 2.0 * field.stock.margin),
        still=len(carpet),
    )
