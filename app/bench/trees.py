"""Trees in a picture against its reference: the fidelity of their tiles, and the roughness of their silhouettes."""

from dataclasses import dataclass

import numpy as np

from ...components.arrays import Mask
from ...systems.light.color import luminance
from ...systems.reference import Truth
from ..studio.encode import Picture
from .contrast import luma, relative_contrast, tile_side, tiled
from .flip import flip_map, hue_between, mean_light

LEAST = 0.3
"""Least fraction of a tile that trees cover for it to count as one of trees."""

SMALL = 60
"""Least number of pixels that trees cover before the sky for their silhouette to be measured."""

COVERED = 90.0
"""Percentile of the difference from the sky that stands for full coverage; the silhouette is at half of it."""


@dataclass(frozen=True, slots=True, eq=False)
class Behind:
    """The background of the trees in a picture."""

    picture: Picture
    """The same picture without trees."""

    sky: Mask
    """Pixels that show the sky without trees, shape (height, width)."""

    hidden: Mask
    """Pixels whose background trees hide, shape (height, width)."""


def tree_figures(picture: Picture, truth: Truth, behind: Behind, /) -> dict[str, object] | None:
    """Return the figures of trees, or None where they cover no tile.

    These are FLIP, mean colour and contrast of their tiles, as `bench picture` has them for grass, and the roughness
    of their silhouette before the sky, relative to the reference's.
    """
    side = tile_side(len(picture))
    covered = tiled(behind.hidden, side).mean(axis=-1) >= LEAST
    if not covered.any():
        return None
    inside = np.zeros(behind.hidden.shape, bool)
    inside[: covered.shape[0] * side, : covered.shape[1] * side] = np.kron(covered, np.ones((side, side), bool))
    drawn, true = (mean_light(each, inside) for each in (picture, truth.picture))
    grains = relative_contrast(picture, truth, inside)
    rough = [_roughness(each, behind) for each in (picture, truth.picture)]
    return {
        "tiles": int(covered.sum()),
        "flip": round(float(flip_map(picture, truth.picture)[inside].mean()), 4),
        "luminance_ratio": round(float(luminance(drawn) / luminance(true)), 4),
        "hue_degrees": round(hue_between(drawn, true), 2),
        "contrast": round(float(np.median(grains)), 4) if grains.size else None,
        "roughness_ratio": round(rough[0] / rough[1], 4) if rough[0] is not None and rough[1] else None,
    }


def _roughness(picture: Picture, behind: Behind) -> float | None:
    """Return the silhouette's length before the sky over the root of its area; None below `SMALL` pixels."""
    difference = np.abs(luma(picture) - luma(behind.picture)) * behind.sky
    if (difference > 0.0).sum() < SMALL:
        return None
    covers = difference > 0.5 * np.percentile(difference[difference > 0.0], COVERED)
    sides = sum((np.diff(covers.astype(np.int8), axis=axis) != 0).sum() for axis in (0, 1))
    return float(sides) / float(np.sqrt(max(covers.sum(), 1)))
