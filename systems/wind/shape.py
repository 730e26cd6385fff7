"""Soft edges of masks."""

import numpy as np

from ...components.arrays import Floats


def smooth(value: Floats, /) -> Floats:
    """Return the smoothstep of values, which are clamped to [0, 1], shape (n,)."""
    t = np.clip(value, np.float32(0.0), np.float32(1.0))
    return np.asarray(t * t * (np.float32(3.0) - np.float32(2.0) * t), np.float32)


def rim(value: Floats, least: float, most: float, soft: float, /) -> Floats:
    """Return 1 well between two bounds, falling smoothly to 0 on and outside them, shape (n,).

    It falls over `soft` [m], or over half the distance between the bounds if that is less.
    """
    inside = np.minimum(value - np.float32(least), np.float32(most) - value)
    return smooth(inside / np.float32(rim_width(least, most, soft)))


def rim_width(least: float, most: float, soft: float, /) -> float:
    """Return the width over which `rim` falls at each bound [m], never 0."""
    return max(min(soft, 0.5 * (most - least)), 1e-6)
