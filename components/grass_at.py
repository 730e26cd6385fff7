"""What grows at some places, as a game asks for it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .arrays import Floats, Mask


@dataclass(frozen=True, slots=True, eq=False)
class GrassAt:
    """What grows at some places and how high it stands there now; a row for each place."""

    kind: NDArray[np.intp]
    """Number of the kind that grows most densely, in the order of the scene; -1 where nothing grows, shape (n,)."""

    name: tuple[str, ...]
    """Its name; empty where nothing grows, n of them."""

    density: Floats
    """Density in [0, 1] of each kind, as the scene has it or as it was sown, shape (n, kinds)."""

    height: Floats
    """How high grass stands over the ground [m], cut, trodden and blown as it is; 0 where none does, shape (n,)."""

    cleared: Mask
    """Whether a game has taken all grass away that would grow there: by `clear`, or with the patch, shape (n,)."""
