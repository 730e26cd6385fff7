"""Shades: what shaders are told of them, and how far their shadows fall."""

from collections.abc import Sequence
from math import cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...components.shade import Shade

EDGE = 0.12
"""Half the width of the edge of a round shade's shadow, of its radius, where it is at the shade."""

CRISP = 0.01
"""The same of a box or a capsule [m]."""

SOFTER = 0.01
"""How much more that is for each metre that the shadow falls [m]: about the angle that the sun is wide."""

LOWEST_SUN = 0.03
"""Sine of the sun's elevation that counts at least, for how far shadows fall."""

GLSL = {"SHADOW_EDGE": EDGE, "SHADOW_CRISP": CRISP, "SHADOW_SOFTER": SOFTER}

BALL, CAPSULE = 0.0, -1.0
"""What stands in place of a box's half depth."""


def round_of(shade: Shade, /) -> tuple[Doubles, float, float]:
    """Return the axis of a round shade, a unit vector, its radius, and how much longer it had to be to be a ball."""
    radius = shade.radius or 0.0
    high = 2.0 * radius if shade.height is None else shade.height
    return np.divide(shade.up, hypot(*shade.up)), radius, 2.0 * radius / high - 1.0


def told_of(shades: Sequence[Shade], /) -> Floats:
    """Return what shaders are told of shades, shape (n, 3, 4).

    That is the middle [m], and half the depth of a box, or what else it is; an axis, and half the length along it, or
    of a ball how much longer it had to be; of a box another axis, and the radius, or half the length along that [m].
    """
    told = np.zeros((len(shades), 3, 4), np.float32)
    for row, shade in zip(told, shades, strict=True):
        row[0, :3] = shade.place
        if shade.size is not None:
            right, up = _axes(shade)
            row[0, 3], row[1, :3], row[1, 3], row[2, :3], row[2, 3] = _box(shade.size, right, up)
            continue
        row[1, :3], row[2, 3], row[1, 3] = round_of(shade)
        if shade.capsule:
            row[0, 3], row[1, 3] = CAPSULE, 0.5 * (shade.height or 0.0) - row[2, 3]
    return told


def _box(
    size: tuple[float, float, float], right: Doubles, up: Doubles, /
) -> tuple[float, Doubles, float, Doubles, float]:
    wide, high, deep = (0.5 * length for length in size)
    return deep, right, wide, up, high


def _axes(shade: Shade, /) -> tuple[Doubles, Doubles]:
    """Return a box's right and up, unit vectors: it heads for its yaw as far as it can, square to its up."""
    up = np.divide(shade.up, hypot(*shade.up))
    right = np.cross((sin(shade.yaw), 0.0, -cos(shade.yaw)), up)
    if np.hypot(*right[::2]) < 1e-6:  # it lies along its heading
        right = np.array((cos(shade.yaw), 0.0, sin(shade.yaw)))
    return right / np.sqrt(right @ right), up


def sizes(told: Floats, /) -> Doubles:
    """Return how far the ends of shades are from their middles (n,) [m]."""
    deep, along, thick = (
        told[:, 0, 3].astype(np.float64),
        told[:, 1, 3].astype(np.float64),
        told[:, 2, 3].astype(np.float64),
    )
    box, capsule = np.sqrt(deep**2 + along**2 + thick**2), along + thick
    return np.asarray(
        np.where(deep > 0.0, box, np.where(deep == CAPSULE, capsule, thick * np.maximum(1.0, 1.0 / (1.0 + along))))
    )


def fallen(told: Floats, sun: NDArray[np.floating], lowest: float, /) -> tuple[Doubles, Doubles]:
    """Return where the shadows of shades (n, 3, 4) fall, down to a height [m].

    They lie about a line from the middle (x, y, z) to an end, (n, 2, 3), as far off it as (n,) [m].
    """
    middle, size = told[:, 0, :3].astype(np.float64), sizes(told)
    deep = np.maximum(middle[:, 1] + size - lowest, 0.0) / max(float(sun[1]), LOWEST_SUN)
    ends = np.stack([middle, middle - deep[:, None] * np.asarray(sun, np.float64)], axis=1)
    return ends, size * (1.0 + EDGE) + CRISP + SOFTER * deep
