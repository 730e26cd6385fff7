"""Receivers to try a wind on: everywhere in its extent, on its border, around it, and very far away."""

import numpy as np

from ..components.arrays import Floats
from ..components.wind import Extent, Grass

FAR = 10000.0
"""How far away the farthest receivers are [m]."""

WIDE = 50.0
"""How far from a wind's middle receivers are tried where its extent says nothing [m]."""

_RESPONSES = ((2.0, 5.0), (5.0, 11.0))
"""Damping and angular frequency of two kinds, a tall soft one and a short stiff one [1/s]."""


def bounds(extent: Extent | None, /) -> tuple[float, float, float, float]:
    """Return the rectangle to look for a wind in: left, right, ahead, behind [m]."""
    if extent is None:
        return -WIDE, WIDE, -WIDE, WIDE
    left, right = np.clip((extent.left, extent.right), -FAR, FAR).tolist()
    ahead, behind = np.clip((extent.ahead, extent.behind), -FAR, FAR).tolist()
    return left, right, ahead, behind


def places_to_try(extent: Extent | None, /) -> Floats:
    """Return positions (x, z) in a wind's own frame [m], shape (n, 2), float32."""
    left, right, ahead, behind = bounds(extent)
    x, z = np.meshgrid(np.linspace(left, right, 33), np.linspace(ahead, behind, 33))
    inside = np.stack([x, z], -1).reshape(-1, 2)
    middle = np.array([[left + right, ahead + behind]]) / 2
    around = middle + (inside - middle) * 1.3 + 0.02
    near = np.random.default_rng(0).normal(0.0, 1.0, (200, 2))
    special = np.concatenate([middle, [[0.0, 0.0], [-0.0, 1e-6], [1e-20, 0.0], [0.0, -3.0], [3.0, 0.0]]])
    turn = np.linspace(0.0, 2.0 * np.pi, 9)[:-1]
    far = FAR * np.stack([np.cos(turn), np.sin(turn)], -1)
    return np.concatenate([inside, around, near, special, far]).astype(np.float32)


def crowd(extent: Extent | None, count: int, /) -> Floats:
    """Return `count` positions inside an extent [m], shape (count, 2)."""
    left, right, ahead, behind = bounds(extent)
    spread = np.random.default_rng(1).random((count, 2))
    place = np.array([left, ahead]) + spread * np.array([right - left, behind - ahead])
    return np.asarray(place, np.float32)


def grass_at(place: Floats, /) -> Grass:
    """Return grass of two kinds, mixed, at positions (n, 2)."""
    step, samples = np.array([0.02, 0.01], np.float32), 256
    time = step[:, None].astype(np.float64) * np.arange(samples)
    fading, swinging = np.array(_RESPONSES).T[..., None]
    fall = (np.exp(-fading * time) * np.cos(swinging * time)).astype(np.float32)
    kind = np.arange(len(place)) % len(step)
    return Grass(kind.astype(np.intp), step, np.float32(1.0) - fall, fall)
