"""Filling of the voids that elevation models have."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from .resample import resample


def fill_voids(heights: Floats, void: NDArray[np.bool_], /) -> Floats:
    """Return `heights` (rows, columns) with smooth ground where `void` (rows, columns), from what surrounds it.

    A void takes the mean of known heights from the finest of a pyramid of ever coarser maps that knows any nearby.
    """
    if not void.any():
        return heights
    known = ~void
    if not known.any():
        raise ValueError("there is no height to fill voids from")
    return _fill(np.where(known, heights, np.float32(0.0)), known.astype(np.float32))


def _fill(heights: Floats, known: Floats) -> Floats:
    """Return `heights`, with sense where `known` is 1 and zero where it is 0, filled."""
    if known.all():
        return heights
    weight = _halve(known)
    coarse = np.divide(_halve(heights * known), weight, out=np.zeros_like(weight), where=weight > 0)
    filled = _fill(coarse, (weight > 0.0).astype(np.float32))
    rows, columns = ((np.arange(n) - 0.5) / 2 for n in heights.shape)
    guess = resample(filled, rows, columns)
    return np.where(known > 0.0, heights, guess)


def _halve(values: Floats) -> Floats:
    """Return the means of 2 by 2 cells; edges are doubled where a side is odd."""
    rows, columns = values.shape
    even = np.pad(values, ((0, rows % 2), (0, columns % 2)), mode="edge")
    total: Floats = even[::2, ::2] + even[1::2, ::2] + even[::2, 1::2] + even[1::2, 1::2]
    return total * np.float32(0.25)
