"""The ground under the grass: terrain, densities and the side of patches."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Ints
from ...engine.terrain.record import Density, Terrain
from ...engine.terrain.sample import density_at

_COS = np.array([1, 0, -1, 0], np.float32)

_SIN = np.array([0, 1, 0, -1], np.float32)

PRESENT = 1.0 / 255.0
"""Density below which a kind counts as absent."""

EDGE_STEP, EDGE_WIDTH = 0.35, 1.0 / 3.0
"""Least change of a kind's density that is an edge in the grass, and its width as a part of a patch's side."""

GLSL = {"PRESENT": PRESENT}


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """Terrain, densities of the kinds of grass, and the side of patches."""

    terrain: Terrain
    density: Density
    patch: float
    """Side of a patch [m]."""


def quarter_turn(turn: int | Ints, /) -> tuple[Floats, Floats]:
    """Return cosine and sine of a number of quarter turns."""
    return _COS[turn], _SIN[turn]


def turned(place: Floats, turn: Ints, /, *, patch: float) -> Floats:
    """Return positions in a patch (..., 2) after quarter turns about its middle, +x towards +z."""
    c, s = quarter_turn(turn)
    x, z = place[..., 0] - patch / 2, place[..., 1] - patch / 2
    return np.stack([c * x - s * z + patch / 2, s * x + c * z + patch / 2], axis=-1).astype(np.float32)


def densest_kind(density: Density, place: Floats, /) -> NDArray[np.intp]:
    """Return the kind that grows most densely at ground positions (n, 2) [m], shape (n,)."""
    if len(density.maps) == 1:
        return np.zeros(len(place), np.intp)
    densest: NDArray[np.intp] = np.argmax(density_at(density, place), axis=0)
    return densest
