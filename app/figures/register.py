"""All figures there are; a new group of them is one more module in this list."""

from . import bending, morph, patch, quality, scenery, tiling, walk, wind
from .figure import PaperFigure

GROUPS = (patch, tiling, bending, wind, scenery, morph, quality, walk)

FIGURES: tuple[PaperFigure, ...] = tuple(
    sorted((each for group in GROUPS for each in group.FIGURES), key=lambda each: each.number)
)
"""By their numbers in the paper."""
