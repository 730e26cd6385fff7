"""Colours: linear radiance inside, display colours at the door."""

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]

TOE = 0.02, 0.035
"""Radiance x is taken as x (x + a) / (x + b) by these two: what is dark becomes darker by up to a / b."""

BRIGHTEST = 0.985
"""The brightest display colour that has a finite radiance of its own."""


def decoded(color: NDArray[np.floating]) -> Doubles:
    """Return sRGB colours of [0, 1] as linear light in [0, 1], same shape."""
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def linear(color: str) -> Doubles:
    """Return an sRGB colour `#rrggbb` as linear light, shape (3,)."""
    return decoded(srgb(color))


def srgb(color: str) -> Doubles:
    """Return a colour `#rrggbb` as display values in [0, 1], shape (3,)."""
    return np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0


def display(radiance: NDArray[np.floating]) -> Doubles:
    """Return linear radiance, 0 and more, as display colours in [0, 1), same shape: the tone curve of `lib/light.glsl`.

    A toe deepens the shadows, middle tones are those of a display of gamma 2, and a shoulder ends in white.
    """
    light = np.maximum(radiance, 0.0)
    light = light * (light + TOE[0]) / (light + TOE[1])
    return np.asarray(np.sqrt(light / np.sqrt(1.0 + light * light)), np.float64)


def shown_as(color: NDArray[np.floating]) -> Doubles:
    """Return the linear radiance that the tone curve shows as a display colour in [0, 1], same shape.

    What is brighter than `BRIGHTEST` counts as that.
    """
    squared = np.clip(color, 0.0, BRIGHTEST) ** 2
    toed = squared / np.sqrt(1.0 - squared * squared)
    half = 0.5 * (toed - TOE[0])
    return np.asarray(half + np.sqrt(half * half + toed * TOE[1]), np.float64)


def luminance(light: NDArray[np.floating]) -> Doubles:
    """Return the relative luminance of linear colours (..., 3), shape (...)."""
    return np.asarray(light @ np.array([0.2126, 0.7152, 0.0722]), np.float64)
