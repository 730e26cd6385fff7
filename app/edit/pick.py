"""From pixels to places on the ground and back."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan

import numpy as np
from numpy.typing import ArrayLike

from ...components.arrays import Doubles, Place
from ...engine.camera import View
from ...engine.terrain.pick import pick
from ...engine.terrain.record import Terrain
from ...engine.terrain.sample import height_at

NEAREST = 0.2
"""Depth of the near plane, behind which points have no pixel [m]."""

FARTHEST = 3000.0
"""Largest distance at which the ground is searched [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """The view of a terrain in one frame; pixels are counted from the lower left."""

    size: tuple[int, int]
    """Width and height of the window [pixels]."""

    seen: View
    terrain: Terrain

    def ground(self, pixel: tuple[float, float], /) -> Place | None:
        """Return the first intersection of the ray through a pixel with the ground, None without one."""
        eye, ray = np.array([self.seen.eye]), self.ray(pixel)[None]
        x, _, z = pick(self.terrain, eye, ray, farthest=FARTHEST)[0].tolist()
        return None if isnan(x) else (x, z)

    def ray(self, pixel: tuple[float, float], /) -> Doubles:
        """Return the unit vector from the eye through a pixel, shape (3,)."""
        x, y = 2.0 * pixel[0] / self.size[0] - 1.0, 2.0 * pixel[1] / self.size[1] - 1.0
        near, far = (
            ends[:3] / ends[3] for ends in np.array([[x, y, -1.0, 1.0], [x, y, 0.0, 1.0]]) @ self.seen.unclip.T
        )
        return np.asarray((far - near) / np.linalg.norm(far - near))

    def pixels(self, points: ArrayLike, /) -> Doubles:
        """Return the pixels of points (n, 3) [m], shape (n, 2); NaN behind the eye."""
        given = np.asarray(points, np.float64).reshape(-1, 3)
        clip = np.concatenate([given, np.ones((len(given), 1))], axis=1) @ self.seen.clip.T
        depth = np.where(clip[:, 3] > NEAREST, clip[:, 3], np.nan)
        return np.asarray((clip[:, :2] / depth[:, None] + 1.0) / 2.0 * np.array(self.size, np.float64))

    def pixels_on_ground(self, places: Sequence[Place], /) -> Doubles:
        """Return the pixels of ground positions (n, 2) [m], shape (n, 2); NaN behind the eye."""
        flat = np.array(places, np.float32).reshape(-1, 2)
        return self.pixels(np.insert(flat, 1, height_at(self.terrain, flat), axis=1))


def nearest(pixel: tuple[float, float], pixels: Doubles, within: float, /) -> int | None:
    """Return the index of the one of `pixels` (n, 2) nearest to a pixel, None if none is `within` [pixels]."""
    if not len(pixels):
        return None
    away = np.where(np.isnan(pixels[:, 0]), np.inf, np.hypot(*(pixels - np.array(pixel)).T))
    found = int(np.argmin(away))
    return found if away[found] <= within else None
