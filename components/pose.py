"""The pose of a thing on the prairie: position and heading."""

from dataclasses import dataclass

import numpy as np

from .arrays import Floats
from .immutable import immutable


@immutable
@dataclass(frozen=True, slots=True)
class Pose:
    """A frame of reference on the ground: its own x points to the right, and its own -z ahead.

    As a component of a wind's entity it replaces the wind's own pose. An entity is left out while its pose is not
    finite, and the log says so.
    """

    x: float = 0.0
    """Ground position along x [m]."""

    z: float = 0.0
    """Ground position along z [m]."""

    yaw: float = 0.0
    """Heading: 0 is -z, positive turns right [rad]."""

    y: float | None = None
    """Height [m]; a lamp needs one, all else ignores it."""

    def inside(self, place: Floats, /) -> Floats:
        """Return ground positions (n, 2) in this frame [m], shape (n, 2)."""
        return _turned(place - np.array([self.x, self.z], np.float32), -self.yaw)

    def outside(self, vector: Floats, /) -> Floats:
        """Return vectors (n, 2) of this frame as the world's, shape (n, 2)."""
        return _turned(vector, self.yaw)


HERE = Pose()
"""The world's own frame."""


def _turned(vector: Floats, yaw: float) -> Floats:
    if yaw == 0.0:
        return vector
    sine, cosine = np.float32(np.sin(yaw)), np.float32(np.cos(yaw))
    x, z = vector[:, 0], vector[:, 1]
    return np.stack([cosine * x - sine * z, sine * x + cosine * z], axis=1)
