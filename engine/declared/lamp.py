"""Lamps, as a scene's file declares them."""

from math import radians

from pydantic import Field

from ...components.declaration import Color
from ...components.lamp import BRIGHTEST, FARTHEST, Lamp
from .way import Placed


class LampOnPath(Placed):
    """A lamp at a fixed place, or on its way along a path."""

    colour: Color = "#ffd9a6"
    """Its colour; how bright it is, `candela` alone says."""

    candela: float = Field(default=400.0, ge=0.0, le=BRIGHTEST)
    """How brightly it shines in the middle of its light [cd]: a street lamp 400, a car's headlight 20000."""

    range: float = Field(default=30.0, gt=0.0, le=FARTHEST)
    """Distance at which it has faded away [m]: the shorter, the cheaper."""

    cone: float | None = Field(default=None, gt=0.0, lt=180.0)
    """Half the angle of a spot light, which fades over the outer third; without it, it shines all ways [degrees]."""

    pitch: float = Field(default=0.0, ge=-180.0, le=180.0)
    """Elevation that a spot light points to, positive up [degrees]."""

    height: float = Field(default=3.0, ge=-100.0, le=1000.0)
    """Height above the ground [m]."""

    def lamp(self) -> Lamp:
        """Return what shines."""
        cone = None if self.cone is None else radians(self.cone)
        return Lamp(self.colour, self.candela, self.range, cone, radians(self.pitch))
