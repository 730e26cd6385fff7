"""Height of the canopy over the ground."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...components.arrays import Floats
from ...engine.memo import while_it_lives
from ...engine.terrain.sample import density_at, height_at
from ..grow.record import Blades, Growth
from .ground import Ground

LODGED = 0.55
"""Loss of height of a canopy whose grass all lies flat, as a part of its height at rest."""

GLSL = {"LODGED": LODGED}


def lodged(index: float, /) -> float:
    """Return the height of a canopy that is bent by a posture index, as a part of its height at rest."""
    return 1.0 - LODGED * index * index


@while_it_lives
def canopy_height(growth: Growth, /) -> float:
    """Return the height of a kind's canopy [m]: nine tenths of its plants stay below it."""
    return float(np.quantile(np.concatenate([_tall(model.blades) for model in growth.models]), 0.9))


def _tall(blades: Blades, /) -> Floats:
    """Return the height of each plant [m], shape (plants,): its longest organ, or its highest place on a stem."""
    row = np.maximum(blades.height, blades.stem * blades.part)
    first = np.flatnonzero(np.diff(blades.rank, prepend=np.float32(-1.0)))
    return np.asarray(np.maximum.reduceat(row, first), np.float32)


@dataclass(frozen=True, slots=True)
class Top:
    """The top of the canopy over a ground in one state; tops of the same ground in the same state are equal."""

    ground: Ground
    canopy: tuple[float, ...]
    """Height of each kind's canopy [m]."""

    changes: tuple[int, int]
    """Number of changes of the ground's heights, and of what is sown on it."""

    def __call__(self, place: Floats, /) -> Floats:
        """Return the elevation y of the top of the canopy at ground positions (n, 2) [m], shape (n,)."""
        return top_at(self.ground, self.canopy, place)


def top_over(ground: Ground, canopy: tuple[float, ...], /) -> Top:
    """Return the top of the canopy over a ground in its present state."""
    return Top(ground, canopy, (ground.terrain.changes.count, ground.density.sown.count))


def top_at(ground: Ground, canopy: Sequence[float], place: Floats, /) -> Floats:
    """Return the elevation y of the top of the canopy at ground positions (x, z), shape (n, 2), [m], shape (n,).

    `canopy` has the height of each kind's canopy [m]. Each is multiplied by the kind's density, so that the top has
    no steps where a kind ends; where kinds grow together, the highest product counts. Blades stand as in calm air, and
    cleared grass counts as if it grew.
    """
    height = np.asarray(canopy, np.float32)[:, None] * density_at(ground.density, place)
    return np.asarray(height_at(ground.terrain, place) + height.max(axis=0), np.float32)
