"""What grows at a place, and how high it stands there now."""

from collections.abc import Callable

import numpy as np

from ..components.arrays import Floats
from ..components.grass_at import GrassAt
from ..engine.terrain.sample import density_at, natural_at
from .around.clearing import Clearings
from .grow.record import Postures
from .mow.mown import Mown
from .site import Site
from .space.ground import PRESENT
from .space.window import cell_of

Felt = Callable[[Floats, int], Floats]
"""Gives the messages (n, 2) that grass of a kind, by its number, feels now at ground positions (n, 2) [m]."""


def grass_at(site: Site, clearings: Clearings, mown: Mown, felt: Felt, place: Floats, /) -> GrassAt:
    """Return what grows at ground positions (n, 2) [m].

    It stands as high as nine of ten plants of its kind do at most, or as it is cut, and lower as its blades are bent.
    Where kinds grow together the tallest counts.
    """
    density = density_at(site.ground.density, place)
    grows = density >= PRESENT
    kind = np.where(grows.any(axis=0), density.argmax(axis=0), -1)
    taken = ~clearings.spare(cell_of(place, patch=site.ground.patch))
    left, height = mown.at(place), np.zeros(len(place), np.float32)
    for number, growth in enumerate(site.growths):
        here = np.flatnonzero(grows[number] & ~taken)
        if len(here):
            up = upright(growth.postures, np.hypot(*felt(place[here], number).T))
            height[here] = np.maximum(height[here], np.minimum(site.canopy[number], left[here]) * up)
    bare = np.flatnonzero(~grows.any(axis=0))
    taken[bare] |= (natural_at(site.ground.density, place[bare]) >= PRESENT).any(axis=0)
    names = [*site.scene.grass, ""]
    return GrassAt(kind, tuple(names[number] for number in kind), np.ascontiguousarray(density.T), height, taken)


def upright(postures: Postures, message: Floats, /) -> Floats:
    """Return how high blades stand that feel messages of these lengths (n,), of their height in calm air, (n,)."""
    highest = postures.shape[0, :, :, 1].max(axis=1)
    calm = np.interp(0.0, postures.index, highest)
    return np.asarray(
        np.interp(postures.bent_by(message.astype(np.float64)), postures.index, highest / calm), np.float32
    )
