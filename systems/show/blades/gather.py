"""Gathering blades: those that are seen, laid out for the graphics card."""

import numpy as np
from numpy.typing import NDArray

from .draw import MOVED
from .pool import BladePool
from .shown import Standing


def gather_blades(
    pool: BladePool, shown: Standing, /, *, eye: tuple[float, float] | None = None
) -> tuple[NDArray[np.void], NDArray[np.void]]:
    """Return the blades that grow on the patches shown, records of `BLADE` and of `MOVED`, each of shape (n,).

    Seen from `eye` (x, z) [m] they come from far to near; without it, patch by patch as they were planted. An order by
    patches would turn over along a whole border between two of them when the viewer crosses its line.
    """
    present = pool.present[shown.slots]
    each = present.shape[1]
    which = (shown.slots[:, None] * each + np.arange(each))[present]
    patch = np.repeat(np.arange(len(present)), present.sum(axis=1))
    if eye is not None:
        order = far_first(pool.place.reshape(-1, 2)[which] - np.array(eye, np.float32))
        which, patch = which[order], patch[order]
    moved = np.empty(len(which), MOVED)
    moved["message"] = pool.message.reshape(-1, 2)[which]
    moved["fade"], moved["slide"] = shown.fade[patch], shown.slide[patch]
    # `take` copies records whole, many times as fast as an index does field by field.
    return pool.blade.reshape(-1).take(which), moved


def far_first(away: NDArray[np.float32], /) -> NDArray[np.intp]:
    """Return the order of places (n, 2), given from the eye, by falling distance; shape (n,).

    Distances are told apart by 1 / 65535 of the farthest: such small numbers are put in order faster than others.
    """
    distance = np.sqrt(np.einsum("ij,ij->i", away, away))
    nearness = (1.0 - distance / max(float(distance.max(initial=0.0)), 1e-6)) * 65535.0
    return np.argsort(nearness.astype(np.uint16), kind="stable")
