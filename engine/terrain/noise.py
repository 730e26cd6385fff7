"""Procedural landscapes from noise."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Doubles, Floats
from ..random import hash3, unit
from .resample import b_spline, resample


@dataclass(frozen=True, slots=True)
class Landscape:
    """Parameters of a named landscape: a sum of octaves of noise, each finer than the one before."""

    octaves: tuple[float, ...]
    """Amplitude of each octave; wavelengths fall by `LACUNARITY` from one to the next."""

    ridged: bool
    """Whether the first octave is folded along its zero line, which becomes a crest."""

    contrast: float
    """Factor of the sum before `tanh`: a larger one levels off hills and valleys sooner."""

    scale: float
    """Height between the lowest and the highest ground, where a scene gives none [m]."""

    feature: float
    """Distance between neighbouring hills, where a scene gives none [m]."""


LANDSCAPES = {
    "rolling": Landscape((1.0, 0.1), ridged=False, contrast=0.5, scale=7.0, feature=60.0),
    "hills": Landscape((1.0, 0.14, 0.02), ridged=False, contrast=0.5, scale=14.0, feature=90.0),
    "ridges": Landscape((1.0, 0.16, 0.02), ridged=True, contrast=0.8, scale=30.0, feature=160.0),
}
"""The landscapes by name; a flat one needs no noise."""

LACUNARITY = 2.17
"""Ratio of the wavelengths of successive octaves; not an integer, so that their lattices never line up."""

SPACING = 2.62
"""Mean distance between neighbouring hilltops of `spline_noise`, in lattice units (measured)."""

DEVIATION = np.float32(0.348)
"""Standard deviation of `spline_noise` (measured)."""

MIDDLE, ROUNDING = np.float32(0.8), np.float32(0.06)
"""Height of folded noise at its crests before rounding, and squared radius of the rounding, in standard deviations."""


def landscape(name: str, x: Doubles, z: Doubles, /, *, seed: int, feature: float) -> Floats:
    """Return a landscape on the grid of places `x` (columns,) and `z` (rows,) [m], in [0, 1], shape (rows, columns).

    It depends on place, `seed` and `feature` alone: a wider grid shows more of the same land, and a coarser one leaves
    out the octaves that it cannot resolve. Slope and curvature are continuous.
    """
    kind = LANDSCAPES[name]
    total = np.zeros((len(z), len(x)), np.float32)
    step = max(float(np.diff(axis).max(initial=0.0)) for axis in (x, z))
    for number, strength in enumerate(kind.octaves):
        lattice = feature / SPACING / LACUNARITY**number
        if lattice < step:
            break
        key, shift_x, shift_z = (int(drawn) for drawn in hash3(seed, number, np.arange(3)))
        octave = spline_noise(x / lattice + shift_x % 997 / 997, z / lattice + shift_z % 997 / 997, seed=key)
        octave /= DEVIATION
        if number == 0 and kind.ridged:
            octave = MIDDLE - np.sqrt(octave * octave + ROUNDING)
        total += np.float32(strength) * octave
    total *= np.float32(kind.contrast)
    np.tanh(total, out=total)
    total += np.float32(1.0)
    total *= np.float32(0.5)
    return total


def spline_noise(x: Doubles, z: Doubles, /, *, seed: int) -> Floats:
    """Return noise on the grid of `x` (columns,) by `z` (rows,), in lattice units, shape (rows, columns).

    A bicubic B-spline, whose coefficients are random numbers at the lattice points, less half of their neighbourhood's
    mean, so that no hill outgrows the others. Unlike in gradient noise no direction stands out. Slope and curvature are
    continuous. Values lie in [-1.5, 1.5] about 0.
    """
    i, j = (np.arange(np.floor(axis.min()) - 2, np.floor(axis.max()) + 4, dtype=np.int64) for axis in (x, z))
    drawn = unit(hash3(seed, i[None, :], j[:, None])) * np.float32(12**0.5) - np.float32(3**0.5)
    rows = drawn[:-2] + 2 * drawn[1:-1] + drawn[2:]
    around = (rows[:, :-2] + 2 * rows[:, 1:-1] + rows[:, 2:]) / np.float32(16.0)
    coefficients = drawn[1:-1, 1:-1] - np.float32(0.5) * around
    return resample(coefficients, z - j[1], x - i[1], kernel=b_spline)
