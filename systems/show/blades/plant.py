"""Planting blades: a patch model's blades stood on the terrain of one cell (paper, section 2.2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints
from ....engine.terrain.sample import height_at, own_density_at
from ...around.patches import NOWHERE, PatchTable
from ...grow.record import NOTHING, Blades, Form, Growth, forms_of
from ...space.ground import PRESENT, Ground, quarter_turn, turned
from ...space.window import window_rows
from .pool import BLADE, ORGAN, BladePool
from .thin import left_out_from


@dataclass(frozen=True, eq=False)
class BladeStock:
    """The blades of all kinds' patch models in all turns, ready to be planted."""

    records: NDArray[np.void]
    """Records at row model * 4 + quarter turns, shape (models * 4, n)."""

    rank: Floats
    """The blades' ranks, shape (models, n)."""

    forms: tuple[Form, ...]
    """The forms that the blades belong to, in the order of their blades."""

    @cached_property
    def place(self) -> Floats:
        """Roots in the patch, (x, z) [m], shape (models * 4, n, 2)."""
        return np.ascontiguousarray(self.records["root"][..., ::2])

    @cached_property
    def rows(self) -> Mapping[int, slice]:
        """The columns of each form's blades, by its number."""
        counts = [len(form.growth.models[0].blades.height) for form in self.forms]
        ends = np.cumsum([0, *counts]).tolist()
        return {form.number: slice(*ends[index : index + 2]) for index, form in enumerate(self.forms)}

    @cached_property
    def reach(self) -> float:
        """Largest distance of any part of a blade from its root [m]."""
        records = self.records
        stem = records["stem"] if "stem" in (records.dtype.names or ()) else np.float32(0.0)
        return float((records["height"] + records["width"] + stem).max(initial=0.0))

    @cached_property
    def drawn_to(self) -> Floats:
        """Distance from which on each blade is left out [m], without a lens, shape (models * 4, n)."""
        return left_out_from(self.records)

    @cached_property
    def kinds(self) -> NDArray[np.intp]:
        """The kind of each blade, the same in all models, shape (n,)."""
        return np.asarray(self.records["kind"][0], np.intp)


def blade_records(
    blades: Blades, turn: int, /, *, patch: float, kind: int, variants: int, form: int, record: np.dtype[np.void]
) -> NDArray[np.void]:
    """Return the records of a patch model's blades after quarter turns, roots relative to the patch, shape (n,).

    `record` is `BLADE`, or `ORGAN` if some stand on stems. Postures are those of the `form`.
    """
    records = np.zeros(len(blades.height), record)
    root = turned(blades.root, np.asarray(turn, np.int32), patch=patch)
    records["root"][:, 0], records["root"][:, 2] = root[:, 0], root[:, 1]
    records["height"], records["width"], records["kind"] = blades.height, blades.width, kind
    records["organ"] = blades.organ
    records["variant"] = form * variants + blades.variant
    records["rest"] = _turned_leans(blades.rest, turn)
    if record == ORGAN:
        records["stem"], records["part"], records["sways"] = (
            blades.stem,
            blades.part,
            _turned_leans(blades.stem_rest, turn),
        )
    azimuth = blades.facing + turn * (np.pi / 2)
    records["facing"] = np.stack([np.cos(azimuth), np.sin(azimuth)], 1)
    return records


def _turned_leans(lean: Floats, turn: int) -> Floats:
    """Return leans (n, 2) after quarter turns."""
    c, s = quarter_turn(turn)
    x, z = lean.T
    return np.stack([c * x - s * z, s * x + c * z], 1)


def record_of(growths: Sequence[Growth], /) -> np.dtype[np.void]:
    """Return the record that holds the blades of all kinds: `ORGAN` if any has other organs, else `BLADE`."""
    return ORGAN if any(model.blades.organ.any() for growth in growths for model in growth.models) else BLADE


def stock_blades(growths: Sequence[Growth], patch: float, coming: Mapping[int, Growth] = NOTHING, /) -> BladeStock:
    """Return the blades of all kinds' patch models in all four turns, and after them those of the kinds `coming`.

    `patch` is a patch's side [m]. `coming` maps kinds to the growths that they are to become.
    """
    forms = forms_of(growths, coming)
    models, record = range(len(growths[0].models)), record_of([form.growth for form in forms])
    return BladeStock(
        records=np.stack([_turned_records(forms, model, turn, patch, record) for model in models for turn in range(4)]),
        rank=np.stack([np.concatenate([form.growth.models[model].blades.rank for form in forms]) for model in models]),
        forms=forms,
    )


def _turned_records(
    forms: Sequence[Form], model: int, turn: int, patch: float, record: np.dtype[np.void]
) -> NDArray[np.void]:
    """Return the records of one model of all forms after quarter turns."""
    return np.concatenate([
        blade_records(
            form.growth.models[model].blades, turn, patch=patch, kind=form.kind, form=form.number,
            variants=form.growth.postures.shape.shape[0], record=record,
        )
        for form in forms
    ])  # fmt: skip


def standing_blades(
    stock: BladeStock, cell: Ints, model: Ints, turn: Ints, ground: Ground, /
) -> tuple[NDArray[np.void], NDArray[np.bool_]]:
    """Return the stock's records of each cell (m, 2) with their roots on the terrain, and a mask of those that grow.

    Both have the shape (m, n).
    """
    records = stock.records[model * 4 + turn]
    records["root"][..., ::2] += _corners(cell, ground)
    place = np.ascontiguousarray(records["root"][..., ::2])
    records["root"][..., 1] = height_at(ground.terrain, place.reshape(-1, 2)).reshape(records.shape)
    return records, _grown(stock, place, model, ground)


def rank_bounds(stock: BladeStock, came: Sequence[float], /) -> tuple[Floats, Floats]:
    """Return the least rank and the bound above the largest of the blades that stand, shape (n,) each.

    `came` (kinds,) is the fraction of each kind that has become its next form: blades of lower ranks are of the next
    form, those of higher ranks still of the old one.
    """
    least, most = np.full(len(stock.kinds), -1.0, np.float32), np.full(len(stock.kinds), 2.0, np.float32)
    for form in stock.forms:
        if form.number != form.kind:
            most[stock.rows[form.number]] = least[stock.rows[form.kind]] = came[form.kind] if came else 0.0
    return least, most


def plant_blades(
    pool: BladePool, slots: NDArray[np.int64], cell: Ints, model: Ints, turn: Ints, stock: BladeStock, ground: Ground, /
) -> None:
    """Plant the blades of each cell (m, 2) in its slot of the pool (m,)."""
    pool.stamp[slots] = cell
    place = stock.place[model * 4 + turn] + _corners(cell, ground)
    pool.x[slots], pool.z[slots] = place[..., 0], place[..., 1]
    height = height_at(ground.terrain, place.reshape(-1, 2)).reshape(place.shape[:-1])
    pool.ground[slots] = np.stack([height.min(axis=1, initial=np.inf), height.max(axis=1, initial=-np.inf)], 1)
    pool.present[slots] = _grown(stock, place, model, ground)
    pool.sown[slots, 1] = pool.sown[slots, 0]


def sow_blades(pool: BladePool, slots: NDArray[np.int64], model: Ints, stock: BladeStock, ground: Ground, /) -> None:
    """Compute anew which blades grow in some slots of the pool (m,)."""
    pool.present[slots] = _grown(stock, pool.places(slots), model, ground)
    pool.sown[slots, 1] = pool.sown[slots, 0]


def _grown(stock: BladeStock, place: Floats, model: Ints, ground: Ground) -> NDArray[np.bool_]:
    """Return a mask of the blades that grow at their places (m, n, 2), shape (m, n)."""
    kinds = np.tile(stock.kinds, len(place))
    own = own_density_at(ground.density, kinds, place.reshape(-1, 2)).reshape(place.shape[:-1])
    return np.asarray((stock.rank[model] < own) & (own > PRESENT))


def carry_blades(
    pool: BladePool, stock: BladeStock, old: BladePool, before: BladeStock, patches: PatchTable, ground: Ground, /
) -> None:
    """Fill an empty pool with the blades of `stock` on the slots of `old`; copy what `before` has, plant the rest."""
    pool.stamp[:], pool.ground[:], pool.sown[:] = old.stamp, old.ground, old.sown
    rows = window_rows(pool.stamp, side=patches.side)
    slots = np.flatnonzero((patches.cell[rows] == pool.stamp).all(axis=1) & (pool.stamp[:, 0] != NOWHERE))
    pool.stamp[np.setdiff1d(np.arange(pool.slots), slots)] = NOWHERE
    model, turn = patches.model[rows[slots]], patches.turn[rows[slots]]
    for form in stock.forms:
        here = stock.rows[form.number]
        there = _same_blades(stock, here, before, form)
        if there is not None:
            for column in ("x", "z", "present"):
                getattr(pool, column)[:, here] = getattr(old, column)[:, there]
            continue
        place = stock.place[model * 4 + turn][:, here] + _corners(pool.stamp[slots], ground)
        pool.x[slots, here], pool.z[slots, here] = place[..., 0], place[..., 1]
        own = own_density_at(ground.density, np.full(place.shape[0] * place.shape[1], form.kind), place.reshape(-1, 2))
        own = own.reshape(place.shape[:-1])
        pool.present[slots, here] = (stock.rank[model][:, here] < own) & (own > PRESENT)


def _corners(cells: Ints, ground: Ground) -> Floats:
    """Return the corners of cells (m, 2) on the ground [m], shape (m, 1, 2)."""
    return np.asarray(cells.astype(np.float32)[:, None] * np.float32(ground.patch), np.float32)


def _same_blades(stock: BladeStock, here: slice, before: BladeStock, form: Form) -> slice | None:
    """Return the columns of `before` whose blades have the same roots and ranks as those of a form, None if none do."""
    for other in before.forms:
        there = before.rows[other.number]
        if other.kind != form.kind or there.stop - there.start != here.stop - here.start:
            continue
        same = other.growth is form.growth or (
            np.array_equal(stock.rank[:, here], before.rank[:, there])
            and np.array_equal(stock.place[:, here], before.place[:, there])
        )
        if same:
            return there
    return None
