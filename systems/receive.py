"""Receiving: patches that feel wind are planted, their receivers hear the primitives, and what is seen is gathered.

A `Shown` record names the patches drawn in one representation this frame; everything below works on all of them at
once, in a few numpy passes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..components.quality import Representation
from ..components.receivers import BladePool, StripPool
from ..components.wind import WindSource
from .cull import far_to_near
from .field import Field
from .lod import weights
from .plant import heading_of, plant_blades, plant_strips, strips_along
from .tile import window_rows
from .wind.blow import messages

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]
Rows = NDArray[np.int64]


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


def shown_patches(field: Field, level: Representation, limits: Ints, side: int) -> list[Shown]:
    """Return the visible patches of a representation by ring: `limits` are the rings' reaches but the last's."""
    table = field.table
    share = weights(table)[level]
    rows = np.flatnonzero(table.alive & table.visible & (share > 0.0))
    rows = rows[far_to_near(table.cell[rows], field.sight.centre)]
    ring = np.searchsorted(limits, table.distance[rows])
    shown = []
    for number in range(len(limits) + 1):
        chosen = rows[ring == number]
        cells = table.cell[chosen]
        slots = window_rows(cells, side=side)
        shown.append(Shown(chosen, slots, share[chosen], strips_along(cells, field.sight.centre)))
    return shown


def plant_shown_blades(field: Field, shown: list[Shown]) -> Rows:
    """Plant the patches in `shown` whose slot holds another's blades; return the rows planted."""
    table, centre = field.table, field.sight.centre
    rows = np.concatenate([ring.rows for ring in shown])
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
    rows = shown.rows[stale]
    if rows.size:
        plant_strips(
            pool, shown.slots[stale], table.cell[rows], table.model[rows], table.turn[rows], shown.along[stale],
            stock.strips[ring], stock.first_layer[ring], field.ground,
        )  # fmt: skip
    return rows


def blow(
    field: Field, blades: list[Shown], strips: list[Shown], sources: list[WindSource], /, *, time: float
) -> int:
    """Let every receiver that is seen hear the wind, in one pass over them all; return how many there are."""
    pools: list[tuple[BladePool | StripPool, Rows]] = [(field.blades, np.concatenate([ring.slots for ring in blades]))]
    pools += [(pool, ring.slots) for pool, ring in zip(field.strips, strips, strict=True)]
    places = [pool.place[slots].reshape(-1, 2) for pool, slots in pools]
    heard = messages(sources, np.concatenate(places), time=time, seed=field.scene.seed)
    start = 0
    for (pool, slots), place in zip(pools, places, strict=True):
        pool.message[slots] = heard[start : start + len(place)].reshape(len(slots), *pool.message.shape[1:])
        start += len(place)
    return start
