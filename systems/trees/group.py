"""The trees of one model as they stand, and which of them are in a picture."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ..space.frustum import beyond
from .model import MARGIN, Model
from .standing import WIDEST
from .wood import SWAYS

TOGETHER = 32
"""Trees, one after another, that are looked for as one before each is: those of a forest stand side by side."""


class Group:
    """All trees of a model, records of `STANDING`."""

    def __init__(self, rows: NDArray[np.void], model: Model) -> None:
        self.rows = rows
        self.scale: Doubles = rows["height"].astype(np.float64) / model.height
        """How much larger each is than its model, shape (n,)."""
        self.middle: Doubles = rows["root"].astype(np.float64)
        """The middle of each [m], shape (n, 3)."""
        self.middle[:, 1] += self.scale * model.middle
        beside, sways = np.where(rows["ring"] > 1, WIDEST, 0.0), (1.0 + SWAYS) * self.scale
        self._high, self._aside = (beside + sways * MARGIN * each for each in (model.middle, model.radius))
        """How far each reaches up and down from its middle, and aside [m], shape (n,)."""
        reach = np.hypot(self._high, self._aside)
        first = np.arange(0, len(rows), TOGETHER)
        if len(rows):
            low = np.minimum.reduceat(self.middle - reach[:, None], first)
            high = np.maximum.reduceat(self.middle + reach[:, None], first)
            self._balls = 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)

    def seen(self, sides: Doubles, /) -> NDArray[np.intp]:
        """Return the numbers of those that are within the sides of a picture."""
        if not len(self.rows):
            return np.zeros(0, np.intp)
        middle, radius = self._balls
        some = np.flatnonzero(np.repeat(beyond(middle, sides) <= radius, TOGETHER)[: len(self.rows)])
        inside = self.middle[some] @ sides[:, :3].T + sides[:, 3]
        reach = np.outer(self._high[some], np.abs(sides[:, 1])) + np.outer(
            self._aside[some], np.hypot(*sides[:, :3:2].T)
        )
        return np.asarray(some[(inside >= -reach).all(axis=1)])
