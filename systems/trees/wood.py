"""How thin wood is drawn: none narrower than a pixel, and less of what would cover less of one."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles

OPAQUE, FAINTEST = 0.8, 0.02
"""Coverage of a pixel from which on what is there is opaque, and below which it is left out."""

THINNEST = 0.5
"""Half the width that a stem has at least [pixels]."""

AWAY = 0.15
"""How far off a stem counts as at least [m]."""

THINS = 0.35, 0.65
"""Coverage at which a stem is left out among leaves, and from which on it is drawn in full."""

LEAFY = 0.95
"""Share of its leaves from which on those stems are left out of a tree: what is left is fainter than `FAINTEST`."""

GOES = 0.75
"""Share of its twigs left to what is drawn of it far off from which on its wood goes."""

SWAYS = 0.1
"""How much nearer or farther off the wind sways what is a tree's, of its reach."""

GLSL = {
    "OPAQUE": OPAQUE, "FAINTEST": FAINTEST, "THINNEST": THINNEST, "AWAY": AWAY, "THINS": THINS, "GOES": GOES,
}  # fmt: skip


class Parts(NamedTuple):
    """Which of the triangles of wood are drawn, of those of its distance, in their order."""

    solid: int
    """So many first ones may cover pixels wholly."""

    end: int
    """From this one on, they are left out; all before it cover some pixels in part, at their edges."""


def parts(radii: Doubles, wide: Doubles, rows: NDArray[np.void], /) -> Parts:
    """Return what is drawn of the wood of trees, records of `SHOWN`.

    `radii` are those of the model's triangles, as `Wood` has them; `wide` is the radius of one that is a pixel wide,
    where each tree is nearest, shape (n,) [m of the model].
    """

    def so_thick(radius: float) -> int:
        return len(radii) - int(np.searchsorted(radii, radius))

    nearest, leafy = float(wide.min()), float(rows["foliage"].min()) >= LEAFY
    return Parts(so_thick(OPAQUE * nearest), so_thick(THINS[0] * nearest) if leafy else len(radii))
