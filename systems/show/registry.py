"""The list of all representations."""

from ..around.appearance import Three
from .blades.representation import BladeRepresentation
from .carpet.representation import CarpetRepresentation
from .representation import Representation
from .strips.representation import StripRepresentation

REPRESENTATIONS: tuple[type[Representation], ...] = (BladeRepresentation, StripRepresentation, CarpetRepresentation)
"""All representations, from the finest to the coarsest."""

NAMES = tuple(each.name for each in REPRESENTATIONS)
"""Names of the representations, in the same order."""


def _three() -> Three:
    finest = next(number for number, each in enumerate(REPRESENTATIONS) if each.morphs_into)
    middle = NAMES.index(str(REPRESENTATIONS[finest].morphs_into))
    return finest, middle, NAMES.index(str(REPRESENTATIONS[middle].grows_out_of))


THREE = _three()
"""Numbers of the representations whose transitions are more than a cross-fade: blades, which morph into strips, and the
carpet, out of which strips grow."""
