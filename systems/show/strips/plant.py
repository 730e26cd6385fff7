"""Planting strips: assigning slots of a pool to patches, with the density of grass there (paper, section 2.2)."""

from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints, Mask
from ....engine.terrain.plots import CELL
from ....engine.terrain.sample import density_on_lines, left_on_lines
from ...space.ground import EDGE_STEP, EDGE_WIDTH, PRESENT, Ground
from .pool import StripPool

MOST_SAMPLES = 13
"""Largest number of density samples along a side of a patch."""

SHADE = 1.5
"""Distance within which the shade of trees changes little [m]."""


class Growing(NamedTuple):
    """Density of grass on some patches."""

    present: Mask
    """Whether each kind grows on a patch at all, shape (m, kinds)."""

    least: Floats
    """Lowest density on a patch, of the kinds that grow there, shape (m,)."""

    edged: Mask
    """Whether the density of any kind changes abruptly on a patch, shape (m,)."""

    def some(self, first: int, last: int, /) -> "Growing":
        """Return the density on the patches from `first` to before `last`."""
        return Growing(self.present[first:last], self.least[first:last], self.edged[first:last])


def plant_strips(
    pool: StripPool, slots: NDArray[np.int64], cell: Ints, model: Ints, turn: Ints, along: Ints, growing: Growing, /
) -> None:
    """Plant strips on cells (m, 2), in slots (m,) of a pool; they run along the axes `along` (m,)."""
    pool.stamp[slots, :2], pool.stamp[slots, 2] = cell, along
    pool.model_and_turn[slots] = np.column_stack([model, turn])
    pool.present[slots], pool.least[slots], pool.edged[slots] = growing.present, growing.least, growing.edged


def growing_on(cell: Ints, ground: Ground, margin: float, /) -> Growing:
    """Return the density of grass on each cell (m, 2), and up to `margin` [m] beyond it, where strips reach."""
    samples = _samples(ground, margin)
    x, z = (cell.T[:, :, None] * np.float32(ground.patch) + samples).astype(np.float32)
    dense = density_on_lines(ground.density, x, z)
    least, most = _range(dense)
    edged = _edged(dense, (most - least).max(axis=1), float(samples[1] - samples[0]), ground.patch)
    left = left_on_lines(ground.density, x, z)
    if left is not None:  # trees make no edges
        least, most = _range(dense * left)
    grows = most > PRESENT
    return Growing(grows, np.where(grows, least, np.float32(1.0)).min(axis=1), edged)


def _range(dense: Floats) -> tuple[Floats, Floats]:
    """Return the lowest and the highest density (kinds, m, n, n) of each kind on each patch, (m, kinds) each."""
    samples = dense.reshape(*dense.shape[:2], -1)
    return samples.min(axis=2).T, samples.max(axis=2).T


def _edged(dense: Floats, contrast: Floats, spacing: float, patch: float) -> Mask:
    """Return whether the density (kinds, m, n, n) of any kind changes abruptly on each patch, shape (m,).

    `spacing` is the distance between samples [m]. `contrast` (m,) is the largest difference of density on each patch,
    over all kinds; most patches are excluded by it.
    """
    apart = min(max(int(patch * EDGE_WIDTH / spacing), 1), dense.shape[-1] - 1)
    step = EDGE_STEP * max(spacing / (patch * EDGE_WIDTH), 1.0)
    edged, candidates = np.zeros(len(contrast), np.bool_), np.flatnonzero(contrast > step)
    if len(candidates):
        dense = dense[:, candidates]
        differences = dense[:, :, apart:] - dense[:, :, :-apart], dense[..., apart:] - dense[..., :-apart]
        down, across = (np.abs(each, out=each).reshape(*each.shape[:2], -1).max(axis=2) for each in differences)
        edged[candidates] = np.maximum(down, across).max(axis=0) > step
    return edged


def _samples(ground: Ground, margin: float) -> Floats:
    """Return sample positions along a side of a patch, from `margin` before it to `margin` beyond it, shape (n,) [m].

    They lie about as close as the samples of painted maps and the cells of what is sown, so that no path across a
    patch is missed.
    """
    _, rows, columns = ground.density.maps.shape
    finest = min(ground.density.size[0] / columns, ground.density.size[1] / rows)
    if ground.density.sown.any:
        finest = min(finest, CELL)
    if len(ground.density.crowns):
        finest = min(finest, SHADE)
    if ground.terrain.holes is not None:
        finest = min(finest, ground.terrain.cell)
    count = min(max(ceil((ground.patch + 2.0 * margin) / finest), 1), MOST_SAMPLES - 1) + 1
    return np.linspace(-margin, ground.patch + margin, count, dtype=np.float32)
