"""What every program knows of what casts shadows."""

from collections.abc import Sequence
from math import dist, hypot

import numpy as np
from numpy.typing import NDArray

from ...components.shade import Shade
from ..frame.block import SHADES


def nearest(shades: Sequence[Shade], eye: tuple[float, float, float], /) -> list[Shade]:
    """Return the shades that count, nearest to the eye first: at most `SHADES`."""
    return sorted(shades, key=lambda shade: dist(shade.place, eye))[:SHADES]


def cast(record: NDArray[np.void], shades: Sequence[Shade], /) -> None:
    """Write what casts shadows, at most `SHADES`."""
    row = record[0]
    row["shades"]["radius"] = 0.0
    for into, shade in zip(row["shades"], shades, strict=False):
        into["middle"], into["radius"] = shade.place, shade.radius
        length, high = hypot(*shade.up), 2.0 * shade.radius if shade.height is None else shade.height
        into["axis"], into["pressed"] = np.divide(shade.up, length), 2.0 * shade.radius / high - 1.0
