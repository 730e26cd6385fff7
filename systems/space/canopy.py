"""How high the grass stands over the ground."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...components.arrays import Floats
from ...engine.memo import while_it_lives
from ...engine.terrain.sample import density_at, height_at
from ..grow.record import Blades, Growth
from .ground import Ground

LODGED = 0.55
"""How much lower the canopy is where all grass lies, as a part of its height at rest."""

GLSL = {"LODGED": LODGED}


def lodged(index: float, /) -> float:
    """Return the height of a canopy that is bent by a posture index, as a part of its height at rest."""
    return 1.0 - LODGED * index * index


@while_it_lives
def canopy_height(growth: Growth, /) -> float:
    """Return the height of a kind's canopy [m]: what nearly all its plants stay below."""
    return float(np.quantile(np.concatenate([_tall(model.blades) for model in growth.models]), 0.9))


def _tall(blades: Blades, /) -> Floats:
    """Return how tall each plant is, by its tallest row [m], shape (plants,)."""
    row = np.maximum(blades.height, blades.stem * blades.part)
    first = np.flatnonzero(np.diff(blades.rank, prepend=np.float32(-1.0)))
    return np.asarray(np.maximum.reduceat(row, first), np.float32)


@dataclass(frozen=True, slots=True)
class Top:
    """The top of the grass over a ground that had been changed so often; two alike are equal."""

    ground: Ground
    canopy: tuple[float, ...]
    """Height of each kind's canopy [m]."""

    changes: tuple[int, int]
    """How often its heights had been changed, and what is sown on it."""

    def __call__(self, place: Floats, /) -> Floats:
        """Return how high the top of the grass is (y) at ground positions (n, 2) [m], shape (n,)."""
        return top_at(self.ground, self.canopy, place)


def top_over(ground: Ground, canopy: tuple[float, ...], /) -> Top:
    """Return the top of the grass over a ground as it is now."""
    return Top(ground, canopy, (ground.terrain.changes.count, ground.density.sown.count))


def top_at(ground: Ground, canopy: Sequence[float], place: Floats, /) -> Floats:
    """Return how high the top of the grass is (y) at ground positions (x, z), shape (n, 2), [m], shape (n,).

    `canopy` has the height of each kind's. Of kinds that grow together the tallest counts, lowered to the ground as it
    grows more thinly: the top has no steps where a kind ends. Blades are taken as they stand in calm air, and what a
    game has cleared counts as if it grew.
    """
    tall = np.asarray(canopy, np.float32)[:, None] * density_at(ground.density, place)
    return np.asarray(height_at(ground.terrain, place) + tall.max(axis=0), np.float32)
