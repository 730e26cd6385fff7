"""Shells of grass about the eye: trees in one are drawn together, and their soft edges come after the same grass."""

from math import ceil, inf, log

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles

SHELL = 0.75
"""How near the near end of a shell is, of its far end."""

SHELLS = 7
"""Shells that have trees of their own. The nearest goes to the eye: up to a quarter of its way, grass is blades."""


def shells_of(off: Doubles, reach: float, /) -> NDArray[np.intp]:
    """Return the shells of trees so far off along the ground, shape (n,) [m]; grass stands up to `reach` [m].

    They are 0 beyond all grass that stands, and then from far to near. They end at powers of `SHELL`, and stay where
    they are while the grass ends elsewhere: trees change theirs seldom.
    """
    outmost = ceil(log(reach) / -log(SHELL)) if reach > 0.0 else 0
    ends = SHELL ** (np.arange(SHELLS) - outmost)
    return np.where(off < reach, (off[:, None] < ends).sum(axis=1), 0)


def farthest_of(shell: int, off: float, /) -> float:
    """Return how far off trees count as at most [m], which all stand in a shell, up to so far off along the ground [m].

    That is infinite beyond all grass, and 0 for single leaves, which are before it.
    """
    return {0: inf, SHELLS + 1: 0.0}.get(shell, off)
