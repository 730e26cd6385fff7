"""The sun: its azimuth and elevation, and the transmittance of the air for its light."""

from functools import lru_cache
from math import asin, atan2, cos, degrees, radians, sin

import numpy as np

from ...components.arrays import Doubles
from ...engine.declared.light import Light
from .air import EYE, sunlight


def sun_at(light: Light, /) -> tuple[float, float]:
    """Return azimuth and elevation of the sun [degrees]; below the horizon the elevation is negative.

    A light with an `hour` gets them from the hour in solar time, the day of the year and the latitude (declination by
    Cooper's formula). North is -z, a camera's yaw 0.
    """
    if light.hour is None:
        return light.azimuth, light.elevation
    declination = radians(23.44) * sin(radians(360.0 * (284 + light.day) / 365.0))
    hour_angle, latitude = radians(15.0 * (light.hour - 12.0)), radians(light.latitude)
    up = sin(latitude) * sin(declination) + cos(latitude) * cos(declination) * cos(hour_angle)
    east, ahead = (
        -cos(declination) * sin(hour_angle),
        cos(latitude) * sin(declination) - sin(latitude) * cos(declination) * cos(hour_angle),
    )
    return degrees(atan2(east, ahead)), degrees(asin(max(-1.0, min(1.0, up))))


def to_sun(light: Light, /) -> tuple[float, float, float]:
    """Return the direction to the sun, unit length (x, y, z)."""
    azimuth, elevation = map(radians, sun_at(light))
    return cos(elevation) * sin(azimuth), sin(elevation), -cos(elevation) * cos(azimuth)


def transmitted(elevation: float, turbidity: float, /) -> Doubles:
    """Return the transmittance of the air for a sun at an elevation [degrees], red, green and blue, shape (3,)."""
    left = sunlight(np.array([EYE]), np.array([sin(radians(elevation))]), turbidity)
    return np.asarray(left[0])


@lru_cache(maxsize=16)
def transmitted_from_zenith(turbidity: float, /) -> Doubles:
    """Return the transmittance of the air for light from overhead, (3,). The array is cached: do not write to it."""
    return transmitted(90.0, turbidity)
