"""Smooth interpolation of maps, one axis after the other, and filling of voids in elevation models."""

from collections.abc import Callable
from math import ceil

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats

Kernel = Callable[[Doubles], Doubles]
"""Weight of a sample as a function of its distance, in samples; 0 from 2 on."""

_BLOCK = 64


def catmull_rom(distance: Doubles, /) -> Doubles:
    """Return the weights of the Catmull-Rom cubic, which passes through the samples."""
    d = np.abs(distance)
    near = (1.5 * d - 2.5) * d * d + 1.0
    far = ((-0.5 * d + 2.5) * d - 4.0) * d + 2.0
    return np.where(d < 1.0, near, np.where(d < 2.0, far, 0.0))


def b_spline(distance: Doubles, /) -> Doubles:
    """Return the weights of the cubic B-spline, which smooths the samples and has a continuous curvature."""
    d = np.abs(distance)
    near = (0.5 * d - 1.0) * d * d + 2.0 / 3.0
    far = np.maximum(2.0 - d, 0.0) ** 3 / 6.0
    return np.where(d < 1.0, near, far)


def resample(values: Floats, rows: Doubles, columns: Doubles, /, *, kernel: Kernel = catmull_rom) -> Floats:
    """Return the map `values` interpolated at fractional `rows` (r,) and `columns` (c,), in samples, shape (r, c).

    Planes are kept exactly and slopes are continuous; outside, the map goes on by point reflection. Where the places
    lie farther apart than the samples, the kernel widens by the same factor, against aliasing.
    """
    across = _along_rows(np.ascontiguousarray(values.T), columns, kernel)
    return _along_rows(np.ascontiguousarray(across.T), rows, kernel)


def _along_rows(values: Floats, places: Doubles, kernel: Kernel) -> Floats:
    taps, weights = _taps(places, kernel)
    margin = max(0, -int(taps.min()), int(taps.max()) - (len(values) - 1))
    padded = np.pad(values, ((margin, margin), (0, 0)), mode="reflect", reflect_type="odd") if margin else values
    result = np.zeros((len(places), values.shape[1]), np.float32)
    for start in range(0, len(places), _BLOCK):
        block = slice(start, start + _BLOCK)
        for k in range(taps.shape[1]):
            result[block] += weights[block, k, None] * padded[taps[block, k] + margin]
    return result


def _taps(places: Doubles, kernel: Kernel) -> tuple[NDArray[np.int64], Floats]:
    """Return the samples around each place and their weights, both of shape (places, taps)."""
    stretch = max(1.0, float(np.diff(places).max(initial=0.0)))
    reach = ceil(2.0 * stretch)
    taps = np.floor(places).astype(np.int64)[:, None] + np.arange(1 - reach, reach + 1)
    apart = taps - places[:, None]
    weights = kernel(apart / stretch)
    weights /= weights.sum(axis=1, keepdims=True)
    tilt = (weights * apart).sum(axis=1)  # without this, a widened kernel would make ripples on an even slope
    weights[:, reach - 1] += tilt
    weights[:, reach] -= tilt
    return taps, weights.astype(np.float32)


def fill_voids(heights: Floats, void: NDArray[np.bool_], /) -> Floats:
    """Return `heights` (rows, columns) with each `void` (rows, columns) filled smoothly from around it.

    Void cells take mean heights from the finest level of a pyramid that has known heights near by.
    """
    if not void.any():
        return heights
    known = ~void
    if not known.any():
        raise ValueError("there is no height to fill voids from")
    return _fill(np.where(known, heights, np.float32(0.0)), known.astype(np.float32))


def _fill(heights: Floats, known: Floats) -> Floats:
    """Return `heights` filled where `known` is 0; it is 1 at the other cells. Unknown heights must be 0."""
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
