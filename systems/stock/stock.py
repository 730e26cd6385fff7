"""Patch models made ready to be stood on the terrain."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..grow.record import Growth, Strips
from ..show.blades.plant import BladeStock, blade_records, far_to_near_blades

Floats = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Stock:
    """Patch models made ready to be stood on the terrain."""

    blades: BladeStock

    strips: list[list[Strips]]
    """By ring and kind: strips whose planes hold for all the kind's models."""

    first_layer: list[list[int]]
    """By ring and kind: where the kind's layers start in the ring's texture array."""

    slices: list[NDArray[np.int32]]
    """By ring: the plane that each blade is painted on, by model and orientation, shape (models, 2, n); blades in the
    order of `blades.rank`."""

    targets: Floats
    """Where each blade's points are painted, (u, v), shape (models, 2, n, points, 2): the same in all rings."""

    @property
    def margin(self) -> float:
        """How far strips reach beyond their patch [m]."""
        return max(strips.margin for ring in self.strips for strips in ring)


def stock_up(growths: list[Growth], patch: float) -> Stock:
    """Return the patch models' blades in all four turns, and where each strip's texture layer is."""
    models = range(len(growths[0].models))
    records = np.stack([_turned_records(growths, model, turn, patch) for model in models for turn in range(4)])
    blades = BladeStock(
        records=records,
        rank=np.stack([np.concatenate([growth.models[model].blades.rank for growth in growths]) for model in models]),
        order=np.stack([far_to_near_blades(row) for row in records]),
    )
    rings = range(len(growths[0].models[0].strips))
    strips = [[growth.models[0].strips[ring] for growth in growths] for ring in rings]
    layers = [
        [2 * len(growth.models) * len(growth.models[0].strips[ring].plane) for growth in growths] for ring in rings
    ]
    first = [[sum(counts[:kind]) for kind in range(len(counts))] for counts in layers]
    slices = [
        np.stack(
            [np.concatenate([growth.models[model].strips[ring].slice for growth in growths], 1) for model in models]
        )
        for ring in rings
    ]
    targets = [np.concatenate([growth.models[model].strips[0].targets for growth in growths], 1) for model in models]
    return Stock(blades=blades, strips=strips, first_layer=first, slices=slices, targets=np.stack(targets))


def _turned_records(growths: list[Growth], model: int, turn: int, patch: float) -> NDArray[np.void]:
    return np.concatenate([
        blade_records(
            growth.models[model].blades, turn, patch=patch, kind=kind, variants=growth.postures.shape.shape[0]
        )
        for kind, growth in enumerate(growths)
    ])  # fmt: skip
