"""Gathering blades: the numbers of those that are seen, in the order of drawing."""

import numpy as np
from numpy.typing import NDArray

from .pool import BladePool
from .shown import Standing

Numbers = NDArray[np.uint32]


def gather_blades(pool: BladePool, shown: Standing, /, *, eye: tuple[float, float]) -> Numbers:
    """Return the numbers of the blades that grow on the patches shown, far to near from `eye` (x, z) [m], shape (n,).

    A blade's number is its patch's place among all patches with blades, times the blades on a patch, plus its own. An
    order by patches would turn over along a whole border between two of them when the viewer crosses its line.
    """
    each = pool.present.shape[1]
    at = np.flatnonzero(pool.present.take(shown.slots, axis=0))
    patch, blade = np.divmod(at, each)
    place = pool.place.reshape(-1, 2).take(shown.slots.take(patch) * each + blade, axis=0)
    numbers = shown.places.take(patch) * each + blade
    return np.asarray(numbers.take(far_first(place - np.array(eye, np.float32))), np.uint32)


def far_first(away: NDArray[np.float32], /) -> NDArray[np.intp]:
    """Return the order of places (n, 2), given from the eye, by falling distance; shape (n,).

    Distances are told apart by 1 / 65535 of the farthest: such small numbers are put in order faster than others.
    """
    distance = np.sqrt(np.einsum("ij,ij->i", away, away))
    nearness = (1.0 - distance / max(float(distance.max(initial=0.0)), 1e-6)) * 65535.0
    return np.argsort(nearness.astype(np.uint16), kind="stable")
