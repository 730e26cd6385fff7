"""Rays: where one meets the ground."""

import numpy as np
from numpy.typing import ArrayLike

from ..components.arrays import Doubles
from ..engine.camera import Heights

NEAREST, STEPS = 0.2, 500
"""From where on along a ray the ground is looked for [m], and at how many places."""

HALVINGS = 24
"""How often the last step is halved."""


def met_by(eye: ArrayLike, ray: ArrayLike, height_at: Heights, /, *, farthest: float) -> tuple[float, float] | None:
    """Return where (x, z) [m] a ray first meets the ground, None where it meets none up to `farthest` [m].

    `eye` is where it begins, and `ray` a unit vector, both (3,).
    """
    start, along = np.asarray(eye, np.float64), np.asarray(ray, np.float64)

    def above(away: Doubles) -> Doubles:
        places = start + away[:, None] * along
        return np.asarray(places[:, 1] - height_at(places[:, ::2].astype(np.float32)))

    away = np.geomspace(NEAREST, farthest, STEPS)
    below = np.flatnonzero(above(away) <= 0.0)
    if not len(below):
        return None
    low, high = (away[below[0] - 1] if below[0] else 0.0), away[below[0]]
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if above(np.array([middle]))[0] <= 0.0 else (middle, high)
    x, _, z = (start + high * along).tolist()
    return x, z
