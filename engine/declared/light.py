"""Sun, sky and haze of a scene."""

from pydantic import Field

from ...components.declaration import Color, Declaration


class Light(Declaration):
    """Sun, sky, clouds and haze, which light grass and ground."""

    azimuth: float = Field(default=140.0, ge=-360.0, le=360.0)
    """Azimuth of the sun without an `hour`, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    elevation: float = Field(default=35.0, ge=0.0, le=90.0)
    """Height of the sun above the horizon without an `hour` [degrees]; dusk and night, below it, need an `hour`."""

    hour: float | None = Field(default=None, ge=0.0, le=24.0)
    """Solar time of day [h], 12 is noon: it gives azimuth and elevation, with the day and the latitude; -z is north.

    By default the sun stands 17 degrees high at 6 and 18, 8 degrees at 5 and 19, and sets at 19:55.

    Where there is an hour, an own azimuth or elevation has no effect."""

    hours_per_minute: float = Field(default=0.0, ge=0.0, le=1440.0)
    """Speed of the day, from its `hour` on [h/min]: 0 stands still, 2 is a day in twelve minutes."""

    day: int = Field(default=172, ge=1, le=366)
    """Day of the year, for `hour`; 172 is midsummer in the north."""

    latitude: float = Field(default=48.0, ge=-90.0, le=90.0)
    """Degrees north of the equator, for `hour`; negative is south."""

    sun: Color = "#ffffff"
    """Colour of the sun outside of the air, which makes it warmer the lower it stands."""

    strength: float = Field(default=1.0, ge=0.0, le=10.0)
    """Strength of the sunlight; 1 is a clear day."""

    turbidity: float = Field(default=2.6, ge=1.8, le=10.0)
    """Turbidity of the air: 2 is very clear, 3 clear, 6 hazy. The sky's colours follow from it and the sun's height."""

    zenith: Color | None = None
    """Colour of the sky overhead; without it, that of a clear sky."""

    horizon: Color | None = None
    """Colour of the sky at the horizon, and of the haze; without it, that of a clear sky."""

    clouds: float = Field(default=0.0, ge=0.0, le=1.0)
    """Fraction of the sky with clouds, 1 is overcast; their shadows drift over the grass with the first breeze."""

    exposure: float = Field(default=0.0, ge=-8.0, le=8.0)
    """Exposure in addition to the automatic one, in stops: 1 is twice as bright."""

    ground: Color = "#4a3f2a"
    """Colour of bare ground."""

    haze: float = Field(default=1800.0, ge=10.0, le=1e6)
    """Distance at which the haze hides 63 % of what is behind it [m]."""
