"""The view frustum: which points, balls and blades the picture may show."""

import numpy as np

from ...components.arrays import Doubles, Floats
from ...engine.camera import View


def picture_sides(seen: View, /, *, ends: bool = False) -> Doubles:
    """Return the planes of the picture's left, right, lower and upper side, (4, 4).

    With `ends` the near and the far plane come after them, (6, 4). A row times (x, y, z, 1) is how far a point lies
    inside of one [m].
    """
    clip = seen.clip
    planes = clip[3] + np.stack([clip[0], -clip[0], clip[1], -clip[1], clip[2], -clip[2]][: 6 if ends else 4])
    return np.asarray(planes / np.maximum(np.linalg.norm(planes[:, :3], axis=1, keepdims=True), 1e-12))


def beyond(points: Doubles | Floats, planes: Doubles | Floats, /) -> Doubles | Floats:
    """Return how large balls around points (n, 3) have to be to touch what planes hold [m]: inside 0 or less, (n,)."""
    return np.asarray(-(points @ planes[:, :3].T + planes[:, 3]).min(axis=1))


def beyond_sides(x: Doubles, z: Doubles, heights: Floats, sides: Doubles, /) -> Floats:
    """Return how large balls have to be to touch what the picture holds [m]: inside it 0 or less, shape (n, m).

    Their middles are at (x, heights, z) [m], of shapes (m,), (n, m) and (n, 1).
    """
    beyond = np.full(heights.shape, -np.inf, np.float32)
    for across, up, along, far in sides:
        inside = (z * along + far).astype(np.float32) + (x * across).astype(np.float32)
        np.maximum(beyond, -(inside + heights * np.float32(up)), out=beyond)
    return beyond
