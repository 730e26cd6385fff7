"""Soft edges of what stands in the grass: each is drawn after the grass behind it, and before the grass in front."""

from ..frame.feature import Part
from .representation import RepresentationPainter


def among(painter: RepresentationPainter, part: Part, /) -> int:
    """Draw what a part has left of soft edges, and before each the grass behind it; return the number of draw calls."""
    calls, left = 0, part.soft_left()
    while left is not None:
        calls += painter.draw_beyond(left) + part.draw_soft(left)
        left = part.soft_left()
    return calls
