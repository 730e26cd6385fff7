"""Responses of the grass at receivers, as winds read them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...components.wind import Grass
from ..grow.record import Growth


def grass_of(growths: Sequence[Growth], kind: NDArray[np.intp], /) -> Grass:
    """Return the responses of these kinds of grass; `kind` (n,) has indices into `growths`."""
    grass = Grass(
        kind=kind.view(),
        step=np.array([growth.response.step for growth in growths], np.float32),
        rise=np.stack([growth.response.rise for growth in growths]),
        fall=np.stack([growth.response.fall for growth in growths]),
    )
    for shared in (grass.kind, grass.step, grass.rise, grass.fall):
        shared.flags.writeable = False  # no wind may change what the next one reads
    return grass
