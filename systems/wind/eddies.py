"""Eddies: tables of turbulence with von Karman's spectrum, as the paper wishes for in section 3.3 (its [13, 14])."""

from functools import lru_cache
from math import gamma, pi, sqrt

import numpy as np

from ...components.arrays import Doubles, Floats
from ...engine.noise import ASLANT, PERIOD, power_left

WIDE, FINER = 24.0, 12.0
"""Period of the table of large eddies [length scales]; ratio of this period to that of small eddies."""

FINE = 256
"""Points along a side of the table of small eddies: enough for two decades of the spectrum's slope."""

BETWEEN, SMALLEST = 6.5, 370.0
"""Wave numbers where small eddies take over from large ones, and where they end [1 / length scale]."""

SOFT, SOFT_END = 0.8, 0.2
"""Widths of these two transitions, in the logarithm of the wave number."""

CORNER = 1.285
"""Factor on the length scale in the spectrum: 1.339 in one without end, less here, as it ends at `SMALLEST`."""


@lru_cache(maxsize=16)
def eddy_tables(seed: int, /) -> tuple[Floats, Floats]:
    """Return tables of large and of small eddies, shapes (PERIOD, PERIOD, 4) and (FINE, FINE, 4).

    They are a horizontal slice of isotropic turbulence, for a length scale of 1: velocity along the wind and to its
    right, and both again with their phases a quarter turn on. Points are WIDE / PERIOD apart, those of small eddies
    WIDE / FINER / FINE; the wind crosses them `ASLANT`. The sum of both tables, as `smooth_noise` reads them, has the
    variance 1 in each component, also where the two halves of a table are mixed by the cosine and sine of any angle.
    """
    random = np.random.default_rng((seed, 0x65646479))
    coarse, fine = _waves(WIDE, PERIOD), _waves(WIDE / FINER, FINE)
    powers = [_power(coarse, 0.0, BETWEEN), _power(fine, BETWEEN, SMALLEST)]
    felt = sum(float((power.sum(axis=0) * _power_left(len(power[0]))).sum()) / 2.0 for power in powers)
    made = [_velocity(waves, power / felt, random) for waves, power in zip((coarse, fine), powers, strict=True)]
    for table in made:
        table.setflags(write=False)
    return made[0], made[1]


def _waves(period: float, points: int) -> Doubles:
    """Return the wave numbers of a table, along the wind and to its right, shape (2, points, points)."""
    number = 2.0 * pi * np.fft.fftfreq(points, period / points)
    column, row = np.meshgrid(number, number)
    ahead, aside = ASLANT
    return np.stack([ahead * column - aside * row, aside * column + ahead * row])


def _power(waves: Doubles, least: float, most: float) -> Doubles:
    """Return the power of each wave's velocity, along it and across, shape (2, rows, columns).

    It is von Karman's isotropic spectrum, E(k) ~ k^4 / (k^2 + 1 / CORNER^2)^(17/6), between wave numbers `least` and
    `most`, integrated over the vertical wave number: waves that differ only there look the same in a horizontal plane.
    It is divided by the power that `smooth_noise` leaves between a table's points.
    """
    square = (waves * waves).sum(axis=0)
    low = 1.0 / CORNER**2

    def over(power: float) -> Doubles:
        """Return the integral of (square + low + h^2)^-power over the vertical wave number h."""
        return np.asarray(sqrt(pi) * gamma(power - 0.5) / gamma(power) * (square + low) ** (0.5 - power))

    across = over(11.0 / 6.0) - low * over(17.0 / 6.0)
    along = across - square * over(17.0 / 6.0)
    held = _low_pass(square, most, SOFT if least == 0.0 else SOFT_END)
    held -= 0.0 if least == 0.0 else _low_pass(square, least, SOFT)
    cell = (waves[0, 0, 1] ** 2 + waves[1, 0, 1] ** 2) * held / _power_left(len(square))
    return np.stack([along * cell, across * cell])


def _power_left(points: int) -> Doubles:
    """Return the part of each wave's power that interpolation between a table's points leaves, (points, points)."""
    axis = power_left(2.0 * pi * np.fft.fftfreq(points).astype(np.float64))
    return axis[:, None] * axis


def _low_pass(square: Doubles, most: float, soft: float) -> Doubles:
    """Return 1 for wave numbers well below `most` and 0 for those well above it, from their squares.

    The step is `soft` wide in the logarithm of the wave number.
    """
    ratio = np.log(np.maximum(square, 1e-30)) / 2.0 - np.log(most)
    return np.asarray(0.5 - 0.5 * np.sin(pi * np.clip(ratio / soft, -0.5, 0.5)))


def _velocity(waves: Doubles, power: Doubles, random: np.random.Generator) -> Floats:
    """Return the velocities of waves with these powers and random phases, shape (points, points, 4).

    Each wave's two components, and the table's two halves, are a quarter turn apart in phase, so that the variance does
    not depend on chance. A wave and its opposite are the same wave; the table has only one of them.
    """
    drawn = random.random(power.shape[1:])
    opposite = np.roll(drawn[::-1, ::-1], 1, (0, 1))
    height = np.select([drawn > opposite, drawn == opposite], [2.0, sqrt(2.0)])
    phase = np.exp(2j * pi * random.random(drawn.shape)) * height
    along, across = np.sqrt(power) * phase
    across = across * 1j * random.choice([-1.0, 1.0], drawn.shape)
    length = np.sqrt((waves * waves).sum(axis=0))
    x, z = np.divide(waves, length, out=np.full_like(waves, sqrt(0.5)), where=length > 0.0)
    velocity = np.fft.ifft2(np.stack([x * along - z * across, z * along + x * across]), norm="forward")
    return np.stack([*velocity.real, *velocity.imag], axis=2, dtype=np.float32, casting="same_kind")
