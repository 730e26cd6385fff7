"""Viewers: from where a prairie is looked at."""

from dataclasses import dataclass, field
from math import pi

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Viewer:
    """Somebody who looks at the prairie; an entity for each name that `Prairie.draw` was given.

    It is written whenever this viewer is drawn. If its entity is deleted, the viewer starts afresh when it is next
    drawn.
    """

    name: str = "main"

    eye: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where it looks from, (x, y, z) [m]."""

    cone: tuple[float, float] = (0.0, pi)
    """Azimuths of the view cone: middle and half width [rad]."""

    sides: NDArray[np.float64] = field(default_factory=lambda: np.zeros((4, 4)))
    """The planes of the picture's four sides: (x, y, z, 1) times a row says how far inside a point is [m], (4, 4)."""

    centre: NDArray[np.int32] = field(default_factory=lambda: np.zeros(2, np.int32))
    """The cell (i, j) it stands in, shape (2,)."""

    time: float = 0.0
    """The instant that it sees [s]."""

    dt: float = 0.0
    """Time since it looked before [s]."""

    idles: bool = False
    """Whether time stands still for it, or goes in slow motion: then changes go on by the frame."""

    way: float = 0.0
    """How far it has come since, along the ground [m]."""

    jumped: bool = True
    """Whether it has moved too far to have walked there: then every change is made at once."""
