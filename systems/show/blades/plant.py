"""Planting blades: a patch model's blades stood on the terrain of one cell (paper, section 2.2)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints
from ....engine.terrain.sample import height_at, own_density_at
from ...grow.record import Blades, Growth
from ...space.ground import PRESENT, Ground, quarter_turn, turned
from .pool import BLADE, ORGAN, BladePool


@dataclass(frozen=True, eq=False)
class BladeStock:
    """The blades of all patch models, those of all kinds together, ready to be stood on the terrain."""

    records: NDArray[np.void]
    """Records at row model * 4 + quarter turns, shape (models * 4, n)."""

    rank: Floats
    """The blades' ranks, shape (models, n)."""

    @cached_property
    def place(self) -> Floats:
        """Where the roots are in a patch, (x, z) [m], shape (models * 4, n, 2)."""
        return np.ascontiguousarray(self.records["root"][..., ::2])

    @cached_property
    def reach(self) -> float:
        """How far any part of any blade may come from its root [m]."""
        records = self.records
        stem = records["stem"] if "stem" in (records.dtype.names or ()) else np.float32(0.0)
        return float((records["height"] + records["width"] + stem).max(initial=0.0))

    @cached_property
    def kinds(self) -> NDArray[np.intp]:
        """The kind of each blade, the same in all models, shape (n,)."""
        return np.asarray(self.records["kind"][0], np.intp)


def blade_records(
    blades: Blades, turn: int, /, *, patch: float, kind: int, variants: int, record: np.dtype[np.void] = BLADE
) -> NDArray[np.void]:
    """Return the records of a patch model's blades after quarter turns, roots relative to the patch, shape (n,).

    They are of `BLADE`, or of `ORGAN`, without which nothing may stand on a stem.
    """
    records = np.zeros(len(blades.height), record)
    spun = turned(blades.root, np.asarray(turn, np.int32), patch=patch)
    records["root"][:, 0], records["root"][:, 2] = spun[:, 0], spun[:, 1]
    records["height"], records["width"], records["kind"] = blades.height, blades.width, kind
    records["organ"] = blades.organ
    records["variant"] = kind * variants + blades.variant
    records["rest"] = _spun(blades.rest, turn)
    if record == ORGAN:
        records["stem"], records["part"], records["sways"] = blades.stem, blades.part, _spun(blades.stem_rest, turn)
    azimuth = blades.facing + turn * (np.pi / 2)
    records["facing"] = np.stack([np.cos(azimuth), np.sin(azimuth)], 1)
    return records


def _spun(lean: Floats, turn: int) -> Floats:
    """Return leans (n, 2) after quarter turns."""
    c, s = quarter_turn(turn)
    x, z = lean.T
    return np.stack([c * x - s * z, s * x + c * z], 1)


def record_of(growths: Sequence[Growth], /) -> np.dtype[np.void]:
    """Return what the graphics card has to be told of kinds: `BLADE`, unless there are other organs among them."""
    return ORGAN if any(model.blades.organ.any() for growth in growths for model in growth.models) else BLADE


def stock_blades(growths: Sequence[Growth], patch: float, /) -> BladeStock:
    """Return the blades of all kinds' patch models in all four turns; `patch` is a patch's side [m]."""
    models, record = range(len(growths[0].models)), record_of(growths)
    return BladeStock(
        records=np.stack([_turned(growths, model, turn, patch, record) for model in models for turn in range(4)]),
        rank=np.stack([np.concatenate([growth.models[model].blades.rank for growth in growths]) for model in models]),
    )


def _turned(
    growths: Sequence[Growth], model: int, turn: int, patch: float, record: np.dtype[np.void]
) -> NDArray[np.void]:
    return np.concatenate([
        blade_records(
            growth.models[model].blades, turn, patch=patch, kind=kind, variants=growth.postures.shape.shape[0],
            record=record,
        )
        for kind, growth in enumerate(growths)
    ])  # fmt: skip


def standing_blades(
    stock: BladeStock, cell: Ints, model: Ints, turn: Ints, ground: Ground, /
) -> tuple[NDArray[np.void], NDArray[np.bool_]]:
    """Return the blades of each cell (m, 2) where they stand, and which of them grow there, shape (m, n) each.

    They are the stock's records with their roots on the terrain.
    """
    chosen = stock.records[model * 4 + turn]
    corner = cell.astype(np.float32) * np.float32(ground.patch)
    chosen["root"][..., ::2] += corner[:, None, :]
    place = np.ascontiguousarray(chosen["root"][..., ::2])
    chosen["root"][..., 1] = height_at(ground.terrain, place.reshape(-1, 2)).reshape(chosen.shape)
    return chosen, _grown(stock, place, model, ground)


def plant_blades(
    pool: BladePool, slots: NDArray[np.int64], cell: Ints, model: Ints, turn: Ints, stock: BladeStock, ground: Ground, /
) -> None:
    """Stand the blades of each cell (m, 2) in its slot of the pool."""
    pool.stamp[slots] = cell
    corner = cell.astype(np.float32) * np.float32(ground.patch)
    place = stock.place[model * 4 + turn] + corner[:, None, :]
    pool.x[slots], pool.z[slots] = place[..., 0], place[..., 1]
    height = height_at(ground.terrain, place.reshape(-1, 2)).reshape(place.shape[:-1])
    pool.ground[slots] = np.stack([height.min(axis=1, initial=np.inf), height.max(axis=1, initial=-np.inf)], 1)
    pool.present[slots] = _grown(stock, place, model, ground)
    pool.sown[slots, 1] = pool.sown[slots, 0]


def sow_blades(pool: BladePool, slots: NDArray[np.int64], model: Ints, stock: BladeStock, ground: Ground, /) -> None:
    """Let blades stand in slots (m,) of the pool only where they grow by now."""
    pool.present[slots] = _grown(stock, pool.places(slots), model, ground)
    pool.sown[slots, 1] = pool.sown[slots, 0]


def _grown(stock: BladeStock, place: Floats, model: Ints, ground: Ground) -> NDArray[np.bool_]:
    """Return which blades grow at their places (m, n, 2), shape (m, n)."""
    kinds = np.tile(stock.kinds, len(place))
    own = own_density_at(ground.density, kinds, place.reshape(-1, 2)).reshape(place.shape[:-1])
    return np.asarray((stock.rank[model] < own) & (own > PRESENT))
