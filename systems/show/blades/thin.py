"""Thinning: of ribbons that look narrow a part is left out, and the others are as much wider.

A ribbon is drawn a pixel wider than it is, for its soft edges: narrow ones take as long as broad ones. The area of all
stays (Cook, Halstead, Planck and Ryu, Stochastic simplification of aggregate detail, 2007).
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ....engine.gl.emit import emitted
from ...around.lens import USUAL
from ...grow.organs import AT_TIPS

HALF_HEIGHT = 540
"""Half the height of the picture that widths are told for [pixels], at an angle of view of 45 degrees."""

NARROW, SMALL = 1.0 / 3.0, 2.0
"""Width below which ribbons are thinned out, as with its edges each is drawn four times as wide; length or width below
which organs on the tips of stems are, as others stand beside each [pixels]."""

NARROW_FROM = HALF_HEIGHT * USUAL / NARROW
"""Distance beyond which a ribbon is narrow, relative to its width."""

NARROW_AT_TIP = NARROW / SMALL
"""Width that counts of an organ on the tip of a stem, relative to its length or width."""

THINS_OVER = 0.25
"""Part of the distance beyond which a ribbon is left out, before and after which it grows narrower."""

GOLDEN_PART = 2654435769
"""Golden section in 32 bits: its successive multiples, modulo 1, are evenly spread."""

UNIT = 2.0**-32
"""Last of these bits."""

GLSL: Final = (
    emitted({"NARROW_FROM": NARROW_FROM, "NARROW_AT_TIP": NARROW_AT_TIP, "THINS_OVER": THINS_OVER, "UNIT": UNIT})
    + f"const uint IN_TURN = {GOLDEN_PART}u;\n"
)


def left_out_from(records: NDArray[np.void], /) -> Floats:
    """Return the distance from which on each of a stock's blades is left out [m], without a lens, shape (m, n).

    `records` (m, n) are of `BLADE` or `ORGAN`. In `blade.vert`, where a share `s` of the blades is left, the blades
    before and after that place in their order grow narrower: those at `s * (1 - THINS_OVER)` begin to, and those at
    `s * (1 + THINS_OVER)` are gone.
    """
    width, height = records["width"], records["height"]
    is_small = np.isin(records["organ"].astype(np.int32), AT_TIPS)
    width = np.where(is_small, NARROW_AT_TIP * np.minimum(width, height), width)
    place = np.arange(records.size, dtype=np.uint32).reshape(records.shape) * np.uint32(GOLDEN_PART)
    share = np.maximum(place, 1) * UNIT
    return np.asarray(width * (NARROW_FROM * (1.0 + THINS_OVER)) / share, np.float32)
