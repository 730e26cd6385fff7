"""Local winds: at a fixed place, or travelling along a path (paper, section 3.3)."""

from pydantic import Field

from ...components.wind import WindPrimitive
from ...engine.declared.way import Placed


class PlacedWind(Placed, WindPrimitive):
    """A wind with a place of its own, that may travel and turn; its mask and action are asked in its own frame."""

    ease: float = Field(default=0.6, ge=0.0, le=60.0)
    """Time to set in and to die down [s]; a wind that starts at 0 is there from the beginning."""
