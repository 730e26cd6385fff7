"""Sun, sky and haze: what a scene declares of the light."""

from pydantic import Field

from ...components.declaration import Color, Declaration


class Light(Declaration):
    """The one light that all three representations, the ground and the sky are drawn in."""

    azimuth: float = Field(default=140.0, ge=-360.0, le=360.0)
    """Direction the sun stands in, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    elevation: float = Field(default=35.0, ge=0.0, le=90.0)
    """Height of the sun above the horizon [degrees]."""

    sun: Color = "#fff1d6"
    """Colour of the sunlight."""

    strength: float = Field(default=1.0, ge=0.0, le=10.0)
    """Strength of the sunlight; 1 is a clear day."""

    zenith: Color = "#4f86c6"
    """Colour of the sky overhead."""

    horizon: Color = "#cfdfe8"
    """Colour of the sky at the horizon, and of the haze."""

    ground: Color = "#4a3f2a"
    """Colour of bare ground."""

    haze: float = Field(default=900.0, ge=10.0, le=1e6)
    """Distance at which the haze hides 63 % of what is behind it [m]."""
