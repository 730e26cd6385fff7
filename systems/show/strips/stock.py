"""The strips of all patch models, ready to be stood on the terrain."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ...grow.record import Growth
from .grow import Strips, strips_of


@dataclass(frozen=True, slots=True, eq=False)
class StripStock:
    """The strips of all kinds' patch models, and where their layers are in each ring's textures."""

    strips: list[list[Strips]]
    """By ring and kind: strips whose planes hold for all the kind's models."""

    first_layer: list[list[int]]
    """By ring and kind: where the kind's layers start in the ring's texture array."""

    slices: NDArray[np.int32]
    """The plane that each blade is painted on, by ring, model and orientation, shape (rings, models, 2, n): the blades
    of all kinds one after another."""

    targets: Floats
    """Where each blade's points are painted, (u, v), shape (models, 2, n, points, 2): the same in all rings."""

    @property
    def margin(self) -> float:
        """How far strips reach beyond their patch [m]."""
        return max(strips.margin for ring in self.strips for strips in ring)


def stock_strips(growths: Sequence[Growth], /) -> StripStock:
    """Return the strips of all kinds' patch models."""
    models = range(len(growths[0].models))
    rings = range(len(strips_of(growths[0].models[0])))
    strips = [[strips_of(growth.models[0])[ring] for growth in growths] for ring in rings]
    layers = [[2 * len(models) * len(of_kind.plane) for of_kind in ring] for ring in strips]
    first = [[sum(counts[:kind]) for kind in range(len(counts))] for counts in layers]
    slices = [
        np.stack(
            [np.concatenate([strips_of(growth.models[model])[ring].slice for growth in growths], 1) for model in models]
        )
        for ring in rings
    ]
    targets = [
        np.concatenate([strips_of(growth.models[model])[0].targets for growth in growths], 1) for model in models
    ]
    return StripStock(strips=strips, first_layer=first, slices=np.stack(slices), targets=np.stack(targets))
