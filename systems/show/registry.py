"""The representations that there are."""

from .blades.representation import BladeRepresentation
from .carpet.representation import CarpetRepresentation
from .representation import Representation
from .strips.representation import StripRepresentation

REPRESENTATIONS: tuple[type[Representation], ...] = (BladeRepresentation, StripRepresentation, CarpetRepresentation)
"""From the finest to the coarsest."""

NAMES = tuple(each.name for each in REPRESENTATIONS)
"""What they are called, in the same order."""
