"""Differences of two pictures: their FLIP, and the mean colours of regions."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Mask
from ...systems.light.color import decoded
from ..studio.encode import Picture
from ..studio.errors import needed

MOMENT = 2.0
"""Instant of the pictures that are compared [s]."""


def flip(picture: Picture, reference: Picture) -> float:
    """Return the mean FLIP of a picture against a reference, both (height, width, 3) sRGB bytes."""
    return float(flip_map(picture, reference).mean())


def flip_map(picture: Picture, reference: Picture) -> Floats:
    """Return the FLIP of each pixel, shape (height, width)."""
    found, _, _ = evaluator().evaluate(
        reference.astype(np.float32) / 255.0, picture.astype(np.float32) / 255.0, "LDR", applyMagma=False
    )
    return np.asarray(found, np.float32).reshape(*reference.shape[:2], -1)[..., 0]


def evaluator() -> Any:
    """Return the module that computes FLIP; raises MachineError where it is not installed."""
    return needed("flip_evaluator", "pictures are compared by flip-evaluator", extra="bench")


def mean_light(picture: Picture, inside: Mask, /) -> NDArray[np.float64]:
    """Return the linear light (3,) of the mean colour in display space of the pixels in a mask."""
    return np.asarray(decoded(picture[inside].mean(axis=0) / 255.0))


def hue_between(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Return the angle between the hues of two linear colours (3,), in [0, 180] degrees."""
    angles = [np.degrees(np.arctan2(np.sqrt(3.0) * (g - bl), 2.0 * r - g - bl)) for r, g, bl in (a, b)]
    return float(abs((angles[0] - angles[1] + 180.0) % 360.0 - 180.0))
