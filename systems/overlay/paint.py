"""The overlay's colours, in display space."""

from colorsys import hsv_to_rgb
from typing import TypeGuard
from zlib import crc32

import numpy as np

from ...components.arrays import Floats
from ...components.wind import WindPrimitive

Color = tuple[float, float, float]

PALEST = 0.4
"""Part of white in the colour of a representation's farthest ring."""

INDEX = np.array(
    [(0.20, 0.35, 0.95), (0.10, 0.80, 0.95), (0.97, 0.95, 0.45), (1.00, 0.55, 0.10), (0.90, 0.05, 0.20)], np.float32
)
"""Colour ramp of posture indices from 0 to 1, in even steps."""

DARK = (0.05, 0.07, 0.04)
BRIGHT = (1.0, 1.0, 1.0)


def wind_color(wind: WindPrimitive, /) -> Color:
    """Return the colour of a wind: its class's own, or else a hue from a hash of its kind's name."""
    own: object = type(wind).color  # a field of a plugin may have the same name
    return own if is_color(own) else hsv_to_rgb(crc32(wind.kind.encode()) / 2**32, 0.65, 1.0)


def is_color(given: object, /) -> TypeGuard[Color]:
    """Return whether an object is a display colour: three numbers in [0, 1]."""
    if not isinstance(given, tuple) or len(given) != 3:
        return False
    numbers = float | int | np.floating | np.integer
    return all(isinstance(channel, numbers) and 0.0 <= channel <= 1.0 for channel in given)


def index_color(index: Floats, /) -> Floats:
    """Return the colours of posture indices (n,) in [0, 1], shape (n, 3)."""
    at = np.linspace(0.0, 1.0, len(INDEX))
    return np.stack([np.interp(index, at, channel) for channel in INDEX.T], axis=1).astype(np.float32)


def ring_shades(color: Color, rings: int = 1, /) -> Floats:
    """Return the colours of a representation's rings from the nearest to the farthest, shape (rings, 3)."""
    pale = np.linspace(0.0, PALEST if rings > 1 else 0.0, rings)[:, None]
    return np.asarray(np.array(color) * (1.0 - pale) + pale, np.float32)
