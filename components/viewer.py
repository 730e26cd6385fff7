"""Viewers: the views of a prairie."""

from dataclasses import dataclass, field
from math import pi

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Viewer:
    """A viewer of the prairie; an entity for each name that `Prairie.draw` was given.

    It is written whenever this viewer is drawn. If its entity is deleted, the viewer starts afresh when it is next
    drawn.
    """

    name: str = "main"

    eye: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Position of the eye (x, y, z) [m]."""

    cone: tuple[float, float] = (0.0, pi)
    """Azimuths of the view cone: middle and half width [rad]."""

    sides: NDArray[np.float64] = field(default_factory=lambda: np.zeros((4, 4)))
    """Planes of the frustum's four sides, (4, 4): a row times (x, y, z, 1) is a point's distance inside [m]."""

    centre: NDArray[np.int32] = field(default_factory=lambda: np.zeros(2, np.int32))
    """Cell (i, j) in which it stands, shape (2,)."""

    time: float = 0.0
    """Time that it sees [s]."""

    dt: float = 0.0
    """Time since its last look [s]."""

    idles: bool = False
    """Whether time stands still for it, or goes in slow motion: then transitions advance by the frame."""

    way: float = 0.0
    """Distance along the ground since its last look [m]."""

    jumped: bool = True
    """Whether it has moved too far to have walked there: then all transitions end at once."""
