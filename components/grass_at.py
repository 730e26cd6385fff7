"""The grass at given places, as a game queries it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .arrays import Floats, Mask


@dataclass(frozen=True, slots=True, eq=False)
class GrassAt:
    """The grass at some places, and its present height; a row for each place."""

    kind: NDArray[np.intp]
    """Number of the kind that grows most densely, in the order of the scene; -1 where nothing grows, shape (n,)."""

    name: tuple[str, ...]
    """Name of that kind; empty where nothing grows, n names."""

    density: Floats
    """Density in [0, 1] of each kind, as the scene has it or as it was sown, shape (n, kinds)."""

    height: Floats
    """Height of the grass over the ground, cut, trodden and blown as it is [m]; 0 where none grows, shape (n,)."""

    cleared: Mask
    """Whether a game has removed all grass there, by `clear` or with the patch, shape (n,)."""
