"""From pixels to places on the ground and back."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float32]
Doubles = NDArray[np.float64]
Heights = Callable[[Floats], Floats]
"""Heights [m], shape (n,), of ground positions (x, z) [m], shape (n, 2)."""

NEAREST, FARTHEST, STEPS = 0.2, 3000.0, 500
"""From where to where along a ray the ground is looked for [m], and at how many places."""

HALVINGS = 24
"""How often the last step is halved."""


def ray_through(pixel: tuple[float, float], size: tuple[int, int], view: Floats, projection: Floats, /) -> Doubles:
    """Return where a ray begins and its unit vector, shape (2, 3): the ray through a pixel, counted from the lower left.

    Both matrices are (4, 4), for column vectors.
    """
    x, y = 2.0 * pixel[0] / size[0] - 1.0, 2.0 * pixel[1] / size[1] - 1.0
    back = np.linalg.inv(projection.astype(np.float64) @ view.astype(np.float64))
    ends = back @ np.array([[x, y, -1.0, 1.0], [x, y, 0.0, 1.0]]).T
    near, far = (ends[:3] / ends[3]).T
    eye = np.linalg.inv(view.astype(np.float64))[:3, 3]
    return np.stack([eye, (far - near) / np.linalg.norm(far - near)])


def ground_on(ray: Doubles, height_at: Heights, /) -> tuple[float, float] | None:
    """Return where a ray (2, 3) first meets the ground, (x, z) [m]; None where it meets none."""
    away = np.geomspace(NEAREST, FARTHEST, STEPS)
    below = np.flatnonzero(_above(ray, away, height_at) <= 0.0)
    if not len(below):
        return None
    high = away[below[0]]
    low = away[below[0] - 1] if below[0] else 0.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if _above(ray, np.array([middle]), height_at)[0] <= 0.0 else (middle, high)
    x, _, z = (ray[0] + high * ray[1]).tolist()
    return x, z


def _above(ray: Doubles, away: Doubles, height_at: Heights) -> Doubles:
    places = ray[0] + away[:, None] * ray[1]
    return np.asarray(places[:, 1] - height_at(places[:, ::2].astype(np.float32)))


def pixels_of(points: ArrayLike, size: tuple[int, int], view: Floats, projection: Floats, /) -> Doubles:
    """Return where points (n, 3) [m] are seen, in pixels from the lower left, shape (n, 2); NaN behind the eye."""
    whole = np.concatenate([np.asarray(points, np.float64).reshape(-1, 3), np.ones((np.size(points) // 3, 1))], axis=1)
    clip = whole @ (projection.astype(np.float64) @ view.astype(np.float64)).T
    depth = np.where(clip[:, 3] > NEAREST, clip[:, 3], np.nan)
    return np.asarray((clip[:, :2] / depth[:, None] + 1.0) / 2.0 * np.array(size, np.float64))


def nearest(pixel: tuple[float, float], pixels: Doubles, within: float, /) -> int | None:
    """Return the number of the place (n, 2) that is nearest to a pixel, None where none is so near [pixels]."""
    if not len(pixels):
        return None
    away = np.where(np.isnan(pixels[:, 0]), np.inf, np.hypot(*(pixels - np.array(pixel)).T))
    found = int(np.argmin(away))
    return found if away[found] <= within else None
