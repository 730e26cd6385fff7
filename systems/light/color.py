"""Colours: conversion between linear radiance, used inside, and display colours, used in scenes and pictures."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles

CURVE = 0.78, 0.349, -0.287
"""Tone curve: coefficients of the root of radiance, its square and its cube. It has a toe and a shoulder."""

WHITE = 1.44
"""Root of the radiance at which the tone curve reaches its maximum."""

GLSL = {"CURVE": CURVE, "WHITE": WHITE}


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
    """Return linear radiance (>= 0) as display colours in [0, 1), same shape: the tone curve of `lib/tone.glsl`."""
    root = np.minimum(np.sqrt(np.maximum(radiance, 0.0)), WHITE)
    return np.asarray(root * (CURVE[0] + root * (CURVE[1] + root * CURVE[2])), np.float64)


def shown_as(color: NDArray[np.floating]) -> Doubles:
    """Return the linear radiance of display colours in [0, 1], same shape: the inverse of `display`."""
    root = np.linspace(0.0, WHITE, 4096)
    return np.asarray(np.interp(color, display(root * root), root) ** 2, np.float64)


def luminance(light: NDArray[np.floating]) -> Doubles:
    """Return the relative luminance of linear colours (..., 3), shape (...)."""
    return np.asarray(light @ np.array([0.2126, 0.7152, 0.0722]), np.float64)
