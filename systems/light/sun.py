"""The sun: where it stands, and what the air leaves of its light."""

from math import asin, atan2, cos, degrees, radians, sin

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.light import Light
from .air import EYE, sunlight


def sun_at(light: Light, /) -> tuple[float, float]:
    """Return azimuth and elevation of the sun [degrees]; below the horizon the elevation is negative.

    With an `hour` they follow from it, the day of the year and the latitude (declination by Cooper's formula, solar
    time); a camera's yaw 0, which is -z, is north.
    """
    if light.hour is None:
        return light.azimuth, light.elevation
    tilt = radians(23.44) * sin(radians(360.0 * (284 + light.day) / 365.0))
    turn, north = radians(15.0 * (light.hour - 12.0)), radians(light.latitude)
    up = sin(north) * sin(tilt) + cos(north) * cos(tilt) * cos(turn)
    east, ahead = -cos(tilt) * sin(turn), cos(north) * sin(tilt) - sin(north) * cos(tilt) * cos(turn)
    return degrees(atan2(east, ahead)), degrees(asin(max(-1.0, min(1.0, up))))


def to_sun(light: Light, /) -> tuple[float, float, float]:
    """Return the direction to the sun, unit length (x, y, z)."""
    azimuth, elevation = map(radians, sun_at(light))
    return cos(elevation) * sin(azimuth), sin(elevation), -cos(elevation) * cos(azimuth)


def transmitted(elevation: float, turbidity: float, /) -> Doubles:
    """Return the part of the sun's light that comes through the air, red, green and blue, shape (3,)."""
    left = sunlight(np.array([EYE]), np.array([sin(radians(elevation))]), turbidity)
    return np.asarray(left[0])
