"""Shells of grass about the eye: trees of one are drawn together, and their soft edges after the grass beyond it."""

from math import ceil, inf, log

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles

SHELL = 0.75
"""Distance of a shell's near end, relative to its far end's."""

SHELLS = 7
"""Number of shells among the grass. The nearest goes to the eye: up to a quarter of its reach, grass is blades."""

RINGS = 4
"""Rings beyond the grass. Each but the last reaches twice as far as the one before, or as the grass."""


def shells_of(distance: Doubles, reach: float, /) -> NDArray[np.intp]:
    """Return the shells (n,) of trees at distances along the ground [m]; grass stands up to `reach` [m].

    Shell 0 lies beyond all grass, and the others count from far to near. Their ends are powers of `SHELL`, and so do
    not move with the reach: trees seldom change shells.
    """
    outmost = ceil(log(reach) / -log(SHELL)) if reach > 0.0 else 0
    ends = SHELL ** (np.arange(SHELLS)[::-1] - outmost)
    return np.where(distance < reach, SHELLS - ends.searchsorted(distance, "right"), 0)


def rings_of(distance: Doubles, reach: float, /) -> NDArray[np.intp]:
    """Return the rings (n,), from near to far, of trees at distances of at least `reach` along the ground [m]."""
    return np.log2(np.clip(distance / max(reach, 1.0), 1.0, 2.0 ** (RINGS - 1))).astype(np.intp)


def farthest_of(shell: int, distance: float, /) -> float:
    """Return the distance that a shell's trees count as [m]; the farthest is `distance` off along the ground [m].

    It is infinite for shell 0, beyond all grass, and 0 for single leaves, which are in front of it.
    """
    return inf if shell == 0 else 0.0 if shell > SHELLS else distance
