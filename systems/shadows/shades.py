"""Shades: their texels for shaders, and the extent of their shadows."""

from collections.abc import Sequence
from math import cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...components.shade import Shade

EDGE = 0.12
"""Half the width of the soft edge of a round shade's shadow, at the shade, relative to its radius."""

CRISP = 0.01
"""Half the width of the soft edge of a box's or capsule's shadow, at the shade [m]."""

SOFTER = 0.01
"""Increase of that half width per metre of the shadow's length: about the sun's angular diameter."""

LOWEST_SUN = 0.03
"""Smallest sine of the sun's elevation, for the length of shadows."""

GLSL = {"SHADOW_EDGE": EDGE, "SHADOW_CRISP": CRISP, "SHADOW_SOFTER": SOFTER}

BALL, CAPSULE = 0.0, -1.0
"""Markers in place of a box's half depth."""


def round_shade(shade: Shade, /) -> tuple[Doubles, float, float]:
    """Return a round shade's axis, a unit vector, its radius [m], and its flatness: diameter over height, minus 1."""
    radius = shade.radius or 0.0
    height = 2.0 * radius if shade.height is None else shade.height
    return np.divide(shade.up, hypot(*shade.up)), radius, 2.0 * radius / height - 1.0


def shade_texels(shades: Sequence[Shade], /) -> Floats:
    """Return three texels for each shade, shape (n, 3, 4).

    A box has middle and half depth; right and half width; up and half height [m]. Others have middle and `BALL` or
    `CAPSULE`; the axis, and a ball's flatness or half the length of a capsule's cylinder; nothing, and the radius [m].
    """
    texels = np.zeros((len(shades), 3, 4), np.float32)
    for row, shade in zip(texels, shades, strict=True):
        row[0, :3] = shade.place
        if shade.size is not None:
            right, up = _axes(shade)
            row[0, 3], row[1, :3], row[1, 3], row[2, :3], row[2, 3] = _box(shade.size, right, up)
            continue
        row[1, :3], row[2, 3], row[1, 3] = round_shade(shade)
        if shade.capsule:
            row[0, 3], row[1, 3] = CAPSULE, 0.5 * (shade.height or 0.0) - row[2, 3]
    return texels


def _box(
    size: tuple[float, float, float], right: Doubles, up: Doubles, /
) -> tuple[float, Doubles, float, Doubles, float]:
    """Return a box's numbers in the order of its texels: half depth, right, half width, up, half height."""
    wide, high, deep = (0.5 * length for length in size)
    return deep, right, wide, up, high


def _axes(shade: Shade, /) -> tuple[Doubles, Doubles]:
    """Return a box's right and up, unit vectors: its front faces its yaw as nearly as its up allows."""
    up = np.divide(shade.up, hypot(*shade.up))
    right = np.cross((sin(shade.yaw), 0.0, -cos(shade.yaw)), up)
    if np.hypot(*right[::2]) < 1e-6:  # it lies along its heading
        right = np.array((cos(shade.yaw), 0.0, sin(shade.yaw)))
    return right / np.sqrt(right @ right), up


def bounding_radii(texels: Floats, /) -> Doubles:
    """Return the radii of shades' bounding spheres (n,) [m], by their texels."""
    deep, along, thick = (
        texels[:, 0, 3].astype(np.float64),
        texels[:, 1, 3].astype(np.float64),
        texels[:, 2, 3].astype(np.float64),
    )
    box, capsule = np.sqrt(deep**2 + along**2 + thick**2), along + thick
    return np.asarray(
        np.where(deep > 0.0, box, np.where(deep == CAPSULE, capsule, thick * np.maximum(1.0, 1.0 / (1.0 + along))))
    )


def shadow_capsules(texels: Floats, sun: NDArray[np.floating], lowest: float, /) -> tuple[Doubles, Doubles]:
    """Return capsules that bound the shadows of shades, by their texels (n, 3, 4), down to a height [m].

    These are the ends of the capsules' axes, from a shade's middle along the light, (n, 2, 3), and their radii (n,)
    [m].
    """
    middle, radius = texels[:, 0, :3].astype(np.float64), bounding_radii(texels)
    length = np.maximum(middle[:, 1] + radius - lowest, 0.0) / max(float(sun[1]), LOWEST_SUN)
    ends = np.stack([middle, middle - length[:, None] * np.asarray(sun, np.float64)], axis=1)
    return ends, radius * (1.0 + EDGE) + CRISP + SOFTER * length
