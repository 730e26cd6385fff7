"""Gathering blades: the numbers of those that are seen, in the order of drawing."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Rows
from .pool import BladePool
from .shown import Standing

Numbers = NDArray[np.uint32]


def gather_blades(
    pool: BladePool, shown: Standing, /, *, eye: tuple[float, float], stand: NDArray[np.bool_] | None = None
) -> Numbers:
    """Return the numbers of the blades that grow on the patches shown, far to near from `eye` (x, z) [m], shape (n,).

    A blade's number is its patch's place among all patches with blades, times the blades on a patch, plus its own. An
    order by patches would turn over along a whole border between two of them when the viewer crosses its line. With
    `stand`, shape (m, blades), only those stand there.
    """
    near = nearness(distances(pool, shown.slots, eye)).reshape(-1)
    each = np.arange(pool.present.shape[1], dtype=np.uint32)
    numbers = ((shown.places * len(each)).astype(np.uint32)[:, None] + each).reshape(-1)
    present = pool.present.take(shown.slots, axis=0)
    present = (present if stand is None else present & stand).reshape(-1)
    if not present.all():
        grown = present.nonzero()[0]
        near, numbers = near.take(grown), numbers.take(grown)
    return numbers.take(np.argsort(near, kind="stable"))


def may_be_seen(pool: BladePool, slots: Rows, sides: Doubles, /, *, reach: float, patch: float) -> NDArray[np.bool_]:
    """Return which blades of some slots may be seen in the picture, shape (m, n).

    `sides` are the planes of the picture as `picture_sides` gives them. A blade may stand as low and as high as any of
    its slot, and no part of it comes farther than `reach` [m] from its root, which is in its cell, `patch` [m] a side.
    Most cells are in the picture or out of it as a whole: only where a plane parts one, its blades are asked.
    """
    stamp = pool.stamp.take(slots, axis=0)
    square = np.stack([stamp, stamp + 1], axis=-1) * patch
    most = (pool.ground.take(slots, axis=0)[:, None] * sides[:, 1, None]).max(axis=-1) + sides[:, 3] + reach
    across = square[:, None] * sides[:, ::2, None]
    enters = (across.max(axis=-1).sum(axis=-1) + most >= 0.0).all(axis=1)
    parted = (across.min(axis=-1).sum(axis=-1) + most < 0.0) & enters[:, None]
    seen = np.repeat(enters[:, None], pool.x.shape[1], axis=1)
    for row, (x, _, z, _) in enumerate(sides.astype(np.float32)):
        asked = parted[:, row].nonzero()[0]
        own, far = slots.take(asked), -most[asked, row].astype(np.float32)
        seen[asked] &= pool.x.take(own, axis=0) * x + pool.z.take(own, axis=0) * z >= far[:, None]
    return seen


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
