"""Colours in the scene's light: linear inside, display colours at the door."""

from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.grass import GrassKind
from ...engine.declared.light import Light

Floats = NDArray[np.float32]

SUN_SHARE, SKY_SHARE = 1.35, 0.6
"""How much of the sun's and of the sky's light an average leaf receives on a clear day."""


def decoded(color: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return sRGB colours of [0, 1] as linear light in [0, 1], same shape."""
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def linear(color: str) -> NDArray[np.float64]:
    """Return an sRGB colour `#rrggbb` as linear light, shape (3,)."""
    return decoded(np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0)


def display(light: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return linear light as display colours in [0, 1], with highlights rolled off above a half."""
    soft = np.where(light > 0.5, 0.5 + 0.5 * np.tanh((light - 0.5) / 0.5), light)
    return np.where(soft <= 0.0031308, soft * 12.92, 1.055 * np.maximum(soft, 1e-9) ** (1 / 2.4) - 0.055)


def to_sun(light: Light) -> tuple[float, float, float]:
    """Return the direction to the sun, unit length (x, y, z)."""
    azimuth, elevation = radians(light.azimuth), radians(light.elevation)
    return cos(elevation) * sin(azimuth), sin(elevation), -cos(elevation) * cos(azimuth)


def daylight(light: Light) -> NDArray[np.float64]:
    """Return the light that an average leaf or the ground receives, linear, shape (3,)."""
    high = 0.35 + 0.65 * sin(radians(light.elevation))
    sky = 0.5 * (linear(light.zenith) + linear(light.horizon))
    received: NDArray[np.float64] = (
        SUN_SHARE * light.strength * high * linear(light.sun) + SKY_SHARE * (0.3 + 0.7 * high) * sky
    )
    return received


def grain(kind: GrassKind, light: Light) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how a blade's colour changes with its face normal's x and z, as fractions, each of shape (3,).

    One part is the sun on its face, the other the kind's variety: blades that face one way are greener, another way
    paler. Both are linear in the normal, so that the mean of many blades has exactly the light of their mean normal.
    """
    x, _, z = to_sun(light)
    shine = 0.28 * light.strength / (1.0 + light.strength)
    warm, pale = np.array([1.0, 0.2, -0.6]), np.array([0.9, 1.0, 0.8])
    return 2 * shine * x + kind.variety * pale, 2 * shine * z + kind.variety * warm


def lit_kind(kind: GrassKind, light: Light) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the display colours of a kind's root and tip in this light, each of shape (3,)."""
    received = daylight(light)
    return display(linear(kind.root) * received), display(linear(kind.tip) * received)
