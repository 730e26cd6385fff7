"""Lamps, as a scene's file declares them."""

from math import radians

from pydantic import Field

from ...components.declaration import Color
from ...components.lamp import BRIGHTEST, FARTHEST, Lamp
from .way import Placed


class LampOnPath(Placed):
    """A lamp at a fixed place, or on its way along a path."""

    colour: Color = "#ffd9a6"
    """Colour; it does not change the brightness."""

    candela: float = Field(default=400.0, ge=0.0, le=BRIGHTEST)
    """Luminous intensity along the axis [cd]: a street lamp has 400, a car's headlight 20000."""

    range: float = Field(default=30.0, gt=0.0, le=FARTHEST)
    """Distance at which it has faded away [m]: the shorter, the cheaper."""

    cone: float | None = Field(default=None, gt=0.0, lt=180.0)
    """Half the angle of a spot light, fading over the outer third [degrees]; without it, it shines all around."""

    pitch: float = Field(default=0.0, ge=-180.0, le=180.0)
    """Elevation of a spot light's axis, positive up [degrees]."""

    height: float = Field(default=3.0, ge=-100.0, le=1000.0)
    """Height above the ground [m]."""

    def lamp(self) -> Lamp:
        """Return the component of the lamp."""
        cone = None if self.cone is None else radians(self.cone)
        return Lamp(self.colour, self.candela, self.range, cone, radians(self.pitch))
