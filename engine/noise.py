"""Smooth value noise on the ground, from periodic tables of random numbers."""

from functools import lru_cache
from math import atan, cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Floats

PERIOD = 128
"""Number of lattice points along a side of a table, after which the noise repeats; a power of two."""


ASLANT = cos(atan((sqrt(5.0) - 1.0) / 2.0)), sin(atan((sqrt(5.0) - 1.0) / 2.0))
"""Direction on the lattice whose slope is the golden ratio, so that a line along it is late to come near its start."""


@lru_cache(maxsize=64)
def noise_table(seed: int, stream: int) -> Floats:
    """Return four independent channels of uniform random numbers in [-1, 1], shape (PERIOD, PERIOD, 4)."""
    table = np.random.default_rng((seed, stream)).uniform(-1.0, 1.0, (PERIOD, PERIOD, 4)).astype(np.float32)
    table.setflags(write=False)
    return table


def smooth_noise(table: Floats, place: Floats, /, *, shift: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Return four channels of noise in [-1, 1] at `place` + `shift` in lattice units, shape (n, 4).

    `place` has shape (n, 2). The noise has a continuous slope. Its period is the table's side, a power of two;
    the shift is reduced by it first, so that hours of travel cost no precision.
    """
    side = len(table)
    moved = place + np.mod(shift, side).astype(np.float32)
    low = np.floor(moved)
    fraction = moved - low
    weight = fraction * fraction * (np.float32(3.0) - np.float32(2.0) * fraction)
    corner = low.astype(np.int32) & (side - 1)
    x, z = corner[:, 0], corner[:, 1]
    right, below = (x + 1) & (side - 1), ((z + 1) & (side - 1)) * side
    z = z * side
    flat = table.reshape(-1, 4)
    s, t = weight[:, :1], weight[:, 1:]
    far: Floats = flat.take(z + x, axis=0)
    far += s * (flat.take(z + right, axis=0) - far)
    near = flat.take(below + x, axis=0)
    near += s * (flat.take(below + right, axis=0) - near)
    far += t * (near - far)
    return far


def _eased(fraction: float) -> float:
    return fraction * fraction * (3.0 - 2.0 * fraction)


@lru_cache(maxsize=64)
def wander(seed: int, stream: int, steps: float, /) -> tuple[float, float, float, float]:
    """Return four independent numbers in [-1, 1] that vary smoothly with `steps`, uncorrelated after a step or two.

    They are a table's noise along the line `ASLANT`, which is 7000 steps long before it comes within a lattice point
    of itself.
    """
    x, z = (steps * part % PERIOD for part in ASLANT)
    column, row, s, t = int(x), int(z), _eased(x % 1.0), _eased(z % 1.0)
    table, below, right = noise_table(seed, stream), (row + 1) % PERIOD, (column + 1) % PERIOD
    # Python numbers, because arrays take many times as long for a single place.
    corners = (row, column), (row, right), (below, column), (below, right)
    a, b, c, d = [table[corner].tolist() for corner in corners]
    first, second, third, fourth = [
        (e + s * (f - e)) + t * ((g + s * (h - g)) - (e + s * (f - e))) for e, f, g, h in zip(a, b, c, d, strict=True)
    ]
    return first, second, third, fourth


def power_left(turn: NDArray[np.float64], /) -> NDArray[np.float64]:
    """Return the mean fraction of a wave's power that is left by interpolating it between lattice points, same shape.

    `turn` is the wave's change of phase from point to point along one axis [rad]. An oblique wave keeps the product of
    the fractions of both axes.
    """
    return 1.0 - 9.0 / 35.0 * (1.0 - np.cos(turn))  # the integral of (1-w)^2 + w^2 + 2 w (1-w) cos(turn), w = 3t^2-2t^3


def noise_grid(table: Floats, x: Floats, z: Floats, /) -> Floats:
    """Return `smooth_noise` on a grid of `x` (columns,) by `z` (rows,), shape (rows, columns, channels).

    `table` may have fewer channels. The result is the same bit by bit, in a fraction of the time: it interpolates along
    x on the table's own lines, then along z.
    """
    left, right, s = _between(x)
    far, near, t = _between(z)
    lines = table[:, left]
    lines += s[:, None] * (table[:, right] - lines)
    grid: Floats = lines[far]
    grid += t[:, None, None] * (lines[near] - grid)
    return grid


def _between(place: Floats) -> tuple[NDArray[np.int32], NDArray[np.int32], Floats]:
    """Return the lattice points before and after places on an axis, and the weights of those after, shape (n,) each."""
    low = np.floor(place)
    fraction = place - low
    before = low.astype(np.int32) & (PERIOD - 1)
    weight = fraction * fraction * (np.float32(3.0) - np.float32(2.0) * fraction)
    return before, (before + 1) & (PERIOD - 1), weight
