"""Ages of the trees that sow themselves: grown ones, and younger ones below and between them."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles

FALLS = 1.5
"""How many times e fewer grown trunks there are than the thinnest: their number falls by the same factor from each
class of diameters to the next (de Liocourt, De l'amenagement des sapinieres, 1898), here by 1.35 in each of five."""

SOON = 1.6
"""How soon a trunk's height comes to a grown one's, by its diameter d: as 1 - exp(-SOON d) (Meyer, A Mathematical
Expression for Height Curves, 1940)."""

SEEDLING = 0.1
"""Height of the youngest that are shown, of grown ones."""


def grown_to(young: float, chance: NDArray[np.floating], /) -> Doubles:
    """Return how high trees stand, of what they grow to, shape (n,): a part of them is young.

    `chance` is a random number of each in [0, 1), shape (n,).
    """
    grows = chance < young
    order = np.where(grows, chance, 0.0) / max(young, float(np.finfo(np.float32).tiny))
    diameter = -np.log1p(-order * (1.0 - np.exp(-FALLS))) / FALLS
    height = -np.expm1(-SOON * diameter) / -np.expm1(-SOON)
    return np.where(grows, SEEDLING + (1.0 - SEEDLING) * height, 1.0)
