"""FLIP: how different two pictures look."""

import importlib
from typing import Any

import numpy as np

from ...components.arrays import Floats
from ..studio.encode import Picture
from ..studio.errors import MachineError

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
    try:
        return importlib.import_module("flip_evaluator")
    except ImportError:
        raise MachineError("pictures are compared by flip-evaluator: pip install 'tallgrass[bench]'") from None
