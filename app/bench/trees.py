"""Trees in a picture beside its reference: how true their tiles are, and how rough their outlines."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Mask
from ...systems.light.color import luminance
from ...systems.reference import Truth
from ..studio.encode import Picture
from .contrast import luma, relative_contrast, tile_side, tiled
from .flip import flip_map, hue_between, mean_light

LEAST = 0.3
"""Part of a tile that trees cover at least, so that it is one of theirs."""

SMALL = 60
"""Pixels before the sky that trees must cover for their outline to be told of."""

COVERED = 90.0
"""Percentile of how far they change the sky where they cover pixels wholly; half of that is their outline."""


@dataclass(frozen=True, slots=True, eq=False)
class Behind:
    """What is behind trees in a picture."""

    picture: Picture
    """The same picture without them."""

    sky: Mask
    """Where that shows the sky, shape (height, width)."""

    hidden: Mask
    """Where they hide what is behind, shape (height, width)."""


def trees_told(picture: Picture, truth: Truth, behind: Behind, /) -> dict[str, object] | None:
    """Return how true trees are, or None where they cover no tile.

    Over their tiles it has FLIP, the mean colour and contrast as `bench picture` has them of grass, and how rough their
    outline is before the sky, of the reference's.
    """
    side = tile_side(len(picture))
    own = tiled(behind.hidden, side).mean(axis=-1) >= LEAST
    if not own.any():
        return None
    inside = np.zeros(behind.hidden.shape, bool)
    inside[: own.shape[0] * side, : own.shape[1] * side] = np.kron(own, np.ones((side, side), bool))
    drawn, true = (mean_light(each, inside) for each in (picture, truth.picture))
    grains = relative_contrast(picture, truth, inside)
    rough = [_roughness(each, behind) for each in (picture, truth.picture)]
    return {
        "tiles": int(own.sum()),
        "flip": round(float(flip_map(picture, truth.picture)[inside].mean()), 4),
        "luminance_ratio": round(float(luminance(drawn) / luminance(true)), 4),
        "hue_degrees": round(hue_between(drawn, true), 2),
        "contrast": round(float(np.median(grains)), 4) if grains.size else None,
        "roughness_ratio": round(rough[0] / rough[1], 4) if rough[0] is not None and rough[1] else None,
    }


def _roughness(picture: Picture, behind: Behind) -> float | None:
    """Return the length of outlines before the sky over the root of what they cover; None where that is little."""
    apart = np.abs(luma(picture) - luma(behind.picture)) * behind.sky
    if (apart > 0.0).sum() < SMALL:
        return None
    covers = apart > 0.5 * np.percentile(apart[apart > 0.0], COVERED)
    sides = sum((np.diff(covers.astype(np.int8), axis=axis) != 0).sum() for axis in (0, 1))
    return float(sides) / float(np.sqrt(max(covers.sum(), 1)))
