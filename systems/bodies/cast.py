"""What every program knows of the shadows of what flies."""

from collections.abc import Sequence
from math import dist

import numpy as np
from numpy.typing import NDArray

from ...components.shade import Shade
from ..frame.block import BODIES
from ..shadows.shades import round_of


def nearest(shades: Sequence[Shade], eye: tuple[float, float, float], /) -> list[Shade]:
    """Return the shades that count, nearest to the eye first: at most `BODIES`."""
    return sorted(shades, key=lambda shade: dist(shade.place, eye))[:BODIES]


def cast(record: NDArray[np.void], shades: Sequence[Shade], /) -> None:
    """Write what casts shadows, at most `BODIES`."""
    row = record[0]
    row["bodies"]["radius"] = 0.0
    for into, shade in zip(row["bodies"], shades, strict=False):
        into["middle"], into["axis"], into["radius"], into["pressed"] = shade.place, *round_of(shade)
