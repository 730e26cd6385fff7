"""Gathering blades: the numbers of those in view, in drawing order."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Doubles, Floats, Rows
from .pool import BladePool
from .shown import Standing

Numbers = NDArray[np.uint32]


def gather_blades(
    pool: BladePool,
    shown: Standing,
    /,
    *,
    eye: tuple[float, float],
    stand: NDArray[np.bool_] | None = None,
    to: Floats | None = None,
) -> Numbers:
    """Return the numbers of the blades that grow on the patches shown, sorted far to near from `eye` (x, z) [m], (n,).

    The number is `places` of the patch times the blades of a patch, plus the blade's index on the patch. Sorting by
    patches instead would swap all blades along a border of two patches when the viewer crosses its line. `stand`,
    shape (m, blades), masks blades out; those farther than `to` [m], of the same shape, are left out, too.
    """
    away = distances(pool, shown.slots, eye)
    near = nearness(away).reshape(-1)
    index = np.arange(pool.present.shape[1], dtype=np.uint32)
    numbers = ((shown.places * len(index)).astype(np.uint32)[:, None] + index).reshape(-1)
    present = pool.present.take(shown.slots, axis=0)
    if stand is not None:
        present = present & stand
    if to is not None:
        present = present & (away < to)
    present = present.reshape(-1)
    if not present.all():
        grown = present.nonzero()[0]
        near, numbers = near.take(grown), numbers.take(grown)
    return numbers.take(np.argsort(near, kind="stable"))


def may_be_seen(pool: BladePool, slots: Rows, sides: Doubles, /, *, reach: float, patch: float) -> NDArray[np.bool_]:
    """Return a mask of the blades of some slots that may be in the picture, shape (m, n).

    `sides` are the frustum's planes from `picture_sides`. A blade's root lies in its slot's cell, `patch` [m] a side,
    and at a height within the slot's ground range; no part of it is farther than `reach` [m] from the root. Most cells
    are wholly inside or outside: blades are tested one by one only in cells that a plane cuts.
    """
    stamp = pool.stamp.take(slots, axis=0)
    square = np.stack([stamp, stamp + 1], axis=-1) * patch
    offset = (pool.ground.take(slots, axis=0)[:, None] * sides[:, 1, None]).max(axis=-1) + sides[:, 3] + reach
    level = square[:, None] * sides[:, ::2, None]
    enters = (level.max(axis=-1).sum(axis=-1) + offset >= 0.0).all(axis=1)
    cut = (level.min(axis=-1).sum(axis=-1) + offset < 0.0) & enters[:, None]
    seen = np.repeat(enters[:, None], pool.x.shape[1], axis=1)
    for row, (x, _, z, _) in enumerate(sides.astype(np.float32)):
        tested = cut[:, row].nonzero()[0]
        slot, least = slots.take(tested), -offset[tested, row].astype(np.float32)
        seen[tested] &= pool.x.take(slot, axis=0) * x + pool.z.take(slot, axis=0) * z >= least[:, None]
    return seen


def distances(pool: BladePool, slots: NDArray[np.int64], eye: tuple[float, float], /) -> Floats:
    """Return the horizontal distances of the blades of some slots from `eye` (x, z) [m], shape (m, n)."""
    x, z = (roots.take(slots, axis=0) - np.float32(origin) for roots, origin in zip((pool.x, pool.z), eye, strict=True))
    x *= x
    z *= z
    x += z
    return np.asarray(np.sqrt(x, out=x))


def nearness(away: Floats, /) -> NDArray[np.uint16]:
    """Return distances as 16-bit integers that fall with distance, from 65535 at 0 to 0 at the largest; same shape.

    Numpy sorts these faster than floats.
    """
    near = away * np.float32(-65535.0 / max(float(away.max(initial=0.0)), 1e-6))
    near += np.float32(65535.0)
    return near.astype(np.uint16)
