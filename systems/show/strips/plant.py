"""Planting strips: whose strips a slot of a pool holds, and how densely they grow there (paper, section 2.2)."""

from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints, Mask
from ....engine.terrain.plots import CELL
from ....engine.terrain.sample import density_on_lines, left_on_lines
from ...space.ground import EDGE_STEP, EDGE_WIDTH, PRESENT, Ground
from .pool import StripPool

MOST_PLACES = 13
"""Places along a side of a patch that are asked how densely grass grows there at most."""

SHADE = 1.5
"""Places that are so near to one another are about as shaded by trees [m]."""


class Growing(NamedTuple):
    """How densely grass grows on some patches."""

    present: Mask
    """Whether each kind grows there at all, shape (m, kinds)."""

    least: Floats
    """Density where it is thinnest, of the kinds that grow there at all, shape (m,)."""

    edged: Mask
    """Whether the density of any kind changes much there, shape (m,)."""

    def some(self, first: int, last: int, /) -> "Growing":
        """Return it of the patches from `first` to before `last`."""
        return Growing(self.present[first:last], self.least[first:last], self.edged[first:last])


def plant_strips(
    pool: StripPool, slots: NDArray[np.int64], cell: Ints, model: Ints, turn: Ints, along: Ints, growing: Growing, /
) -> None:
    """Stand the strips of each cell (m, 2), running along axis `along` (m,), in its slot of the pool."""
    pool.stamp[slots, :2], pool.stamp[slots, 2] = cell, along
    pool.stand[slots] = np.column_stack([model, turn])
    pool.present[slots], pool.least[slots], pool.edged[slots] = growing.present, growing.least, growing.edged


def growing_on(cell: Ints, ground: Ground, margin: float, /) -> Growing:
    """Return how densely grass grows on each cell (m, 2), and as far beyond as strips reach [m]."""
    line = _spread(ground, margin)
    x, z = (cell.T[:, :, None] * np.float32(ground.patch) + line).astype(np.float32)
    dense = density_on_lines(ground.density, x, z)
    least, most = _ends(dense)
    edged = _steps(dense, (most - least).max(axis=1), float(line[1] - line[0]), ground.patch)
    left = left_on_lines(ground.density, x, z)
    if left is not None:  # trees make no edges
        least, most = _ends(dense * left)
    grows = most > PRESENT
    return Growing(grows, np.where(grows, least, np.float32(1.0)).min(axis=1), edged)


def _ends(dense: Floats) -> tuple[Floats, Floats]:
    """Return the least and the greatest density (kinds, m, n, n) of each kind on each patch, (m, kinds) each."""
    all_over = dense.reshape(*dense.shape[:2], -1)
    return all_over.min(axis=2).T, all_over.max(axis=2).T


def _steps(dense: Floats, within: Floats, spacing: float, patch: float) -> Mask:
    """Return on which patches the density (kinds, m, n, n) of any kind, so far apart [m], has an edge, shape (m,).

    Told is how much that of any changes `within` each, (m,).
    """
    apart = min(max(int(patch * EDGE_WIDTH / spacing), 1), dense.shape[-1] - 1)
    step = EDGE_STEP * max(spacing / (patch * EDGE_WIDTH), 1.0)
    found, some = np.zeros(len(within), np.bool_), np.flatnonzero(within > step)
    if len(some):
        dense = dense[:, some]
        both = dense[:, :, apart:] - dense[:, :, :-apart], dense[..., apart:] - dense[..., :-apart]
        down, across = (np.abs(each, out=each).reshape(*each.shape[:2], -1).max(axis=2) for each in both)
        found[some] = np.maximum(down, across).max(axis=0) > step
    return found


def _spread(ground: Ground, margin: float) -> Floats:
    """Return places along a side of a patch, and as far beyond as strips reach, shape (n,) [m].

    They lie about as close as the samples of what is painted, or the cells of what is sown, so that no way across a
    patch is missed.
    """
    _, rows, columns = ground.density.maps.shape
    finest = min(ground.density.size[0] / columns, ground.density.size[1] / rows)
    if ground.density.sown.any:
        finest = min(finest, CELL)
    if len(ground.density.crowns.discs):
        finest = min(finest, SHADE)
    if ground.terrain.holes is not None:
        finest = min(finest, ground.terrain.cell)
    count = min(max(ceil((ground.patch + 2.0 * margin) / finest), 1), MOST_PLACES - 1) + 1
    return np.linspace(-margin, ground.patch + margin, count, dtype=np.float32)
