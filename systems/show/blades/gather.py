"""Gathering blades: the numbers of those that are seen, in the order of drawing."""

import numpy as np
from numpy.typing import NDArray

from .pool import BladePool
from .shown import Standing

Floats = NDArray[np.float32]
Numbers = NDArray[np.uint32]


def gather_blades(
    pool: BladePool, shown: Standing, /, *, eye: tuple[float, float], stand: NDArray[np.bool_] | None = None
) -> Numbers:
    """Return the numbers of the blades that grow on the patches shown, far to near from `eye` (x, z) [m], shape (n,).

    A blade's number is its patch's place among all patches with blades, times the blades on a patch, plus its own. An
    order by patches would turn over along a whole border between two of them when the viewer crosses its line. With
    `stand`, shape (m, blades), only those stand there.
    """
    away = distances(pool, shown.slots, eye).reshape(-1)
    each = np.arange(pool.present.shape[1], dtype=np.uint32)
    numbers = ((shown.places * len(each)).astype(np.uint32)[:, None] + each).reshape(-1)
    present = pool.present.take(shown.slots, axis=0)
    present = (present if stand is None else present & stand).reshape(-1)
    if not present.all():
        grown = present.nonzero()[0]
        away, numbers = away.take(grown), numbers.take(grown)
    return numbers.take(far_first(away))


def distances(pool: BladePool, slots: NDArray[np.int64], eye: tuple[float, float], /) -> Floats:
    """Return how far the blades of some slots are from `eye` (x, z) [m], shape (m, n)."""
    x, z = (own.take(slots, axis=0) - np.float32(at) for own, at in zip((pool.x, pool.z), eye, strict=True))
    x *= x
    z *= z
    x += z
    return np.asarray(np.sqrt(x, out=x))


def far_first(away: Floats, /) -> NDArray[np.intp]:
    """Return the order of distances (n,) from the largest to the least, shape (n,).

    They are told apart by 1 / 65535 of the farthest: such small numbers are put in order faster than others.
    """
    return np.argsort(nearness(away), kind="stable")


def nearness(away: Floats, /) -> NDArray[np.uint16]:
    """Return distances as whole numbers that rise from 0 for the farthest to 65535, of the same shape."""
    near = away * np.float32(-65535.0 / max(float(away.max(initial=0.0)), 1e-6))
    near += np.float32(65535.0)
    return near.astype(np.uint16)
