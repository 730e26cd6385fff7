"""The list of all figures; a new group of figures is a module in this list."""

from . import bending, morph, patch, quality, scenery, tiling, walk, wind
from .figure import PaperFigure

GROUPS = (patch, tiling, bending, wind, scenery, morph, quality, walk)

FIGURES: tuple[PaperFigure, ...] = tuple(
    sorted((each for group in GROUPS for each in group.FIGURES), key=lambda each: each.number)
)
"""All figures, by their numbers in the paper."""
