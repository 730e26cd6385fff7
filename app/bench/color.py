"""Mean colours of parts of pictures, and how far they are from one another."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Mask
from ...systems.light.color import decoded
from ..studio.encode import Picture


def mean_light(picture: Picture, inside: Mask, /) -> NDArray[np.float64]:
    """Return the linear light (3,) of the mean colour in display space of those pixels."""
    return np.asarray(decoded(picture[inside].mean(axis=0) / 255.0))


def luminance(light: NDArray[np.float64]) -> float:
    """Return the relative luminance of linear light (3,)."""
    return float(light @ np.array([0.2126, 0.7152, 0.0722]))


def hue_between(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Return the angle between the hues of two linear colours (3,), in [0, 180] degrees."""
    angles = [np.degrees(np.arctan2(np.sqrt(3.0) * (g - bl), 2.0 * r - g - bl)) for r, g, bl in (a, b)]
    return float(abs((angles[0] - angles[1] + 180.0) % 360.0 - 180.0))
