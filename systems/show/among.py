"""Soft edges of what stands in the grass: each is drawn after the grass behind it, and before the grass in front."""

from math import floor, log

from ..frame.feature import Part
from .representation import RepresentationPainter

SHELL = 0.8
"""How near the near end of a shell of grass is, of its far end. Soft edges come before what is in the shell with them:
behind a tree 30 m off, grass of up to 7 m hides its edges, for an eye at 1.7 m those of its lowest third of a metre."""


def among(painter: RepresentationPainter, part: Part, /) -> int:
    """Draw what a part has left of soft edges, and before each the grass behind it; return the number of draw calls."""
    calls, left = 0, part.soft_left()
    while left is not None:
        far = far_end(left, painter.reach)
        calls += painter.draw_beyond(far) + part.draw_soft(min(SHELL * far, left))
        left = part.soft_left()
    return calls


def far_end(off: float, reach: float, /) -> float:
    """Return how far off the shell ends that is so far off [m], of those into which what reaches so far is cut."""
    if not 0.0 < off < reach:
        return reach
    return float(reach * SHELL ** floor(log(off / reach) / log(SHELL)))
