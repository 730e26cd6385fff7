"""FLIP: how different two pictures look."""

from typing import Any

import numpy as np

from ...components.arrays import Floats
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
