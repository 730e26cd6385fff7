"""Lamps: lights in addition to sun and sky."""

from dataclasses import dataclass
from math import pi
from reprlib import repr as shortened

from .colour import hex_of, is_colour
from .footprint import is_between
from .immutable import immutable

FARTHEST = 1000.0
"""Greatest range of a lamp [m]."""

BRIGHTEST = 1e7
"""Greatest luminous intensity of a lamp, that of a lighthouse [cd]."""


@immutable
@dataclass(frozen=True, slots=True)
class Lamp:
    """A light that shines on grass and ground: the component of a game's own entity, whose `Pose` says where it is.

    It shines in all directions, or within a `cone` ahead of its pose. Its light falls off with the inverse square of
    the distance, and a little faster towards its `range`. If more than 256 are in view, the brightest count. Raises
    ValueError for an impossible lamp. An entity whose pose has no height `y` is left out, and the log says so.
    """

    colour: str = "#ffd9a6"
    """Colour (sRGB), such as `#ffd9a6` or `orange`; it does not change the brightness."""

    candela: float = 400.0
    """Luminous intensity along the axis, 0 to 1e7 [cd]: a street lamp has 400, a car's headlight 20 000."""

    range: float = 30.0
    """Distance at which it has faded away, above 0, at most 1000 [m]: the shorter, the cheaper."""

    cone: float | None = None
    """Half the angle of a spot light, above 0, below pi [rad]; it fades over the outer third. None: all directions."""

    pitch: float = 0.0
    """Elevation of a spot light's axis, positive up, within half a turn [rad]; the pose's `yaw` is its heading."""

    def __post_init__(self) -> None:
        """Raise ValueError for an impossible lamp."""
        object.__setattr__(self, "colour", hex_of(self.colour))  # the one way in a frozen record
        if not is_colour(self.colour):
            raise ValueError(f"a lamp's colour is one such as '#ffd9a6' or 'orange', not {shortened(self.colour)}")
        if not is_between(0.0, self.candela, BRIGHTEST):
            raise ValueError(f"a lamp's candela is from 0 to {BRIGHTEST:g}, not {shortened(self.candela)}")
        if not (is_between(0.0, self.range, FARTHEST) and self.range > 0.0):
            raise ValueError(f"a lamp's range is above 0 m, at most {FARTHEST:g} m, not {shortened(self.range)}")
        if self.cone is not None and not (is_between(0.0, self.cone, pi) and 0.0 < self.cone < pi):
            raise ValueError(f"a lamp's cone is half its angle, above 0 and below pi rad, not {shortened(self.cone)}")
        if not is_between(-pi, self.pitch, pi):
            raise ValueError(f"a lamp's pitch is from -pi to pi rad, not {shortened(self.pitch)}")
