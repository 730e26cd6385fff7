"""Terrain and density as arrays over the ground."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Terrain:
    """An elevation map whose samples stand at cell corners; between them heights are bilinear.

    It has at least 2 by 2 samples and is centred on the origin.
    """

    heights: NDArray[np.float32]
    """Heights [m], row 0 at the far edge (-z), shape (rows, columns)."""

    cell: float
    """Metres per cell."""

    span: tuple[float, float] = field(init=False)
    """The lowest and the highest of the heights [m]."""

    def __post_init__(self) -> None:
        """Look through the heights once."""
        object.__setattr__(self, "span", (float(self.heights.min()), float(self.heights.max())))

    @property
    def size(self) -> tuple[float, float]:
        """Width (x) and depth (z) [m]."""
        rows, columns = self.heights.shape
        return (columns - 1) * self.cell, (rows - 1) * self.cell

    @property
    def origin(self) -> tuple[float, float]:
        """Ground position (x, z) of sample [0, 0] [m]."""
        width, depth = self.size
        return -width / 2, -depth / 2


@dataclass(frozen=True, slots=True, eq=False)
class Density:
    """How densely each kind grows, sampled over the whole terrain."""

    maps: NDArray[np.float32]
    """Density in [0, 1] of each kind, row 0 at the far edge (-z), shape (kinds, rows, columns), at least 2 by 2.

    A pixel's density stands in its middle, as in a texture laid over the terrain."""

    size: tuple[float, float]
    """Width (x) and depth (z) of the terrain that the maps are laid over, centred on the origin [m]."""
