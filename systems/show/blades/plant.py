"""Planting: a patch model's blades and strips stood on the terrain of one cell (paper, section 2.2)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....engine.terrain.sample import density_at, height_at
from ...ground import _COS, _SIN, PRESENT, Ground, turned
from ...grow.record import Blades
from .pool import BLADE, BladePool

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]

HEADINGS = 32
"""Azimuths that blades are put in order for."""


@dataclass(frozen=True, slots=True, eq=False)
class BladeStock:
    """The blades of all patch models, those of all kinds together, ready to be stood on the terrain."""

    records: NDArray[np.void]
    """Records at row model * 4 + quarter turns, shape (models * 4, n)."""

    rank: Floats
    """The blades' ranks, shape (models, n)."""

    order: NDArray[np.intp]
    """Far to near by heading, rows as the records', shape (models * 4, HEADINGS, n)."""


def blade_records(blades: Blades, turn: int, /, *, patch: float, kind: int, variants: int) -> NDArray[np.void]:
    """Return the records of a patch model's blades after quarter turns, roots relative to the patch, shape (n,)."""
    c, s = _COS[turn], _SIN[turn]
    records = np.zeros(len(blades.height), BLADE)
    spun = turned(blades.root, np.asarray(turn, np.int32), patch=patch)
    records["root"][:, 0], records["root"][:, 2] = spun[:, 0], spun[:, 1]
    records["height"], records["width"], records["kind"] = blades.height, blades.width, kind
    records["variant"] = kind * variants + blades.variant
    lean_x, lean_z = blades.rest.T
    records["rest"] = np.stack([c * lean_x - s * lean_z, s * lean_x + c * lean_z], 1)
    azimuth = blades.facing + turn * (np.pi / 2)
    records["facing"] = np.stack([np.cos(azimuth), np.sin(azimuth)], 1)
    return records


def far_to_near_blades(records: NDArray[np.void], /) -> NDArray[np.intp]:
    """Return the orders of blades (n,) from far to near, seen towards each of `HEADINGS` azimuths, (HEADINGS, n).

    They are found once, when a model is stocked; drawing sorts nothing (paper, section 2.2).
    """
    azimuth = np.arange(HEADINGS) * (2.0 * np.pi / HEADINGS)
    away = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1) @ records["root"][:, ::2].T
    return np.argsort(-away, axis=1, kind="stable")


def heading_of(cell: Ints, viewer: NDArray[np.float64], /) -> Ints:
    """Return which of `HEADINGS` azimuths the middle of each cell (m, 2) is seen towards, shape (m,).

    `viewer` is the place that it is seen from [patch sides], shape (2,).
    """
    away = cell + 0.5 - viewer
    turns = np.arctan2(away[:, 1], away[:, 0]) * (HEADINGS / (2.0 * np.pi))
    return np.mod(np.round(turns), HEADINGS).astype(np.int32)


def plant_blades(
    pool: BladePool,
    slots: NDArray[np.int64],
    cell: Ints,
    model: Ints,
    turn: Ints,
    heading: Ints,
    stock: BladeStock,
    ground: Ground,
    /,
) -> None:
    """Stand the blades of each cell (m, 2) in its slot of the pool, in the order that goes with its `heading` (m,)."""
    pool.stamp[slots, :2], pool.stamp[slots, 2] = cell, heading
    row = model * 4 + turn
    order = stock.order[row, heading]
    chosen = stock.records[row[:, None], order]
    corner = cell.astype(np.float32) * np.float32(ground.patch)
    chosen["root"][..., ::2] += corner[:, None, :]
    place = np.ascontiguousarray(chosen["root"][..., ::2])
    flat = place.reshape(-1, 2)
    chosen["root"][..., 1] = height_at(ground.terrain, flat).reshape(order.shape)
    kind = chosen["kind"].astype(np.intp).reshape(1, -1)
    dense = np.take_along_axis(density_at(ground.density, flat), kind, axis=0).reshape(order.shape)
    pool.blade[slots], pool.place[slots] = chosen, place
    pool.present[slots] = (stock.rank[model[:, None], order] < dense) & (dense > PRESENT)
