"""Daylight: the light of a scene's sun and sky on grass, as exposed radiance."""

from dataclasses import dataclass, fields
from math import pi
from typing import Any

from ...components.arrays import Doubles
from ...engine.declared.light import Light
from .clouds import clouds_of
from .color import linear, luminance
from .sky import SUN, Sky, clear_air, sky_of
from .sun import sun_at, to_sun, transmitted

USUAL_LUMINANCE = 1.5
"""Luminance of a white leaf in usual daylight, sun and sky together."""

ADAPTATION = 0.55
"""Exponent of the exposure's adaptation to light: 0 is a fixed exposure, with 1 dusk looks as bright as noon."""

NIGHT_LAMPS = 0.86
"""Exponent by which lamps grow brighter as daylight fades, because twilight and night are too bright here.

From noon to night, light falls by a factor of 240 here. In the world it falls by 25 000 to the 5 lx at the end of civil
twilight (Seidelmann, Explanatory Supplement to the Astronomical Almanac, 1992)."""

NIGHT_LUMINANCE = 0.005
"""Smallest luminance of a white leaf for that factor: that of night."""

BOUNCED = 0.05
"""Fraction of sunlight that grass and air all around scatter into shadows."""

LEAF = 0.80
"""Mean irradiance of leaves of all directions, relative to a leaf that faces the sun."""

SOLAR_ILLUMINANCE = 133_300.0
"""Solar illuminance above the atmosphere (Darula, Kittler and Gueymard, 2005) [lx]."""

LUX = SUN / pi / SOLAR_ILLUMINANCE
"""Radiance of a white diffuse surface per lux, before exposure [1/lx]."""


@dataclass(frozen=True, slots=True, eq=False)
class Daylight:
    """The light of a scene in linear, exposed radiance; colours have shape (3,)."""

    direction: tuple[float, float, float]
    """Direction to the sun, unit length."""

    sun: Doubles
    """Radiance of a white leaf in full sun."""

    down: Doubles
    """Radiance of a white leaf under the whole sky."""

    clouds: Doubles
    """Radiance of a thin cloud in full shade."""

    sky: Sky
    """Map, horizon and irradiance of the sky."""

    exposure: float
    """Factor from the scene's radiance to the picture's."""

    lamplight: float
    """Factor from lamps' radiance to the picture's."""


def daylight(light: Light, /) -> Daylight:
    """Return the light that a scene declares, exposed."""
    return daylight_under(light, clear_air(sun_at(light)[1], light.turbidity))


def daylight_under(light: Light, clear: Doubles, /) -> Daylight:
    """Return the light that a scene declares, exposed; `clear` is the radiance that `clear_air` returns."""
    sun = SUN / pi * LEAF * light.strength * transmitted(sun_at(light)[1], light.turbidity) * linear(light.sun)
    sky = sky_of(light, clear, sun)
    exposure = exposure_of(light, sun * clouds_of(light.clouds).past, sky.down)
    shown = Sky(*(getattr(sky, each.name) * exposure for each in fields(Sky)))
    down = shown.down + BOUNCED * sun * exposure
    dark_factor = max(USUAL_LUMINANCE / max(_leaf_luminance(sun, sky.down), NIGHT_LUMINANCE), 1.0) ** NIGHT_LAMPS
    return Daylight(to_sun(light), sun * exposure, down, shown.clouds, shown, exposure, exposure * dark_factor)


def between(before: Daylight, after: Daylight, part: float, direction: tuple[float, float, float], /) -> Daylight:
    """Interpolate two lights, both exposed, and return one with another direction to the sun."""

    def interpolated(one: Any, other: Any) -> Any:
        return one * (1.0 - part) + other * part

    sky = Sky(*(interpolated(getattr(before.sky, each.name), getattr(after.sky, each.name)) for each in fields(Sky)))
    names = "sun", "down", "clouds", "exposure", "lamplight"
    values = {name: interpolated(getattr(before, name), getattr(after, name)) for name in names}
    return Daylight(direction, sky=sky, **values)


def exposure_of(light: Light, sun: Doubles, down: Doubles, /) -> float:
    """Return the exposure factor: it makes up for part of the lack of light, as eyes do.

    `sun` and `down` are the radiance of a white leaf in the sun and under the sky, unexposed.
    """
    return float(2.0**light.exposure * (USUAL_LUMINANCE / max(_leaf_luminance(sun, down), 1e-3)) ** ADAPTATION)


def _leaf_luminance(sun: Doubles, down: Doubles) -> float:
    """Return the luminance of a white leaf in sun and sky."""
    return float(luminance(sun + down))
