"""Receiving: patches that are shown are planted, and their receivers hear the primitives."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .field import Field, densest_kind
from .show.blades.plant import heading_of, plant_blades
from .show.blades.pool import BladePool
from .show.seen import Shown
from .show.strips.plant import plant_strips
from .show.strips.pool import StripPool
from .wind.blow import Listeners
from .wind.grass import grass_of

Floats = NDArray[np.float32]
Rows = NDArray[np.int64]


def plant_shown_blades(field: Field, shown: Shown) -> Rows:
    """Plant the patches in `shown` whose slot holds another's blades; return the rows planted."""
    table, viewer = field.table, np.array([field.sight.eye[0], field.sight.eye[2]]) / field.quality.patch
    rows: Rows = shown.rows
    slots = shown.slots
    heading = heading_of(table.cell[rows], viewer)
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
    blades: Shown,
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
    pools: list[tuple[BladePool | StripPool, Rows, Rows]] = [(field.blades, blades.rows, blades.slots)]
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
