"""Daylight: what a scene's sun and sky send to the grass, in radiance as the picture is exposed."""

from dataclasses import dataclass, fields
from math import pi
from typing import Any

from ...components.arrays import Doubles
from ...engine.declared.light import Light
from .clouds import clouds_of
from .color import linear, luminance
from .sky import SUN, Sky, clear_air, sky_of
from .sun import sun_at, to_sun, transmitted

USUAL = 1.5
"""Luminance of a white leaf in usual daylight, sun and sky together."""

ADAPTS = 0.55
"""Exponent by which the exposure follows the light: 0 is a camera that is never set anew, 1 knows no dusk."""

LIT_NIGHT = 0.86
"""Exponent by which lamps shine brighter the less daylight there is, for what twilight and night are here too bright.

From noon to night light goes down by a factor of 240 here; in the world, down to 5 lx as at the end of civil
twilight, by one of 25 000 (Seidelmann, Explanatory Supplement to the Astronomical Almanac, 1992)."""

DARKEST = 0.005
"""The least luminance of a white leaf that counts for that: it is that of night."""

BOUNCED = 0.05
"""What grass and air all around send back of the sun's light into its shadows."""

LEAF = 0.80
"""What a leaf gets of the sun's light, on the mean over all that face it or not, of one square to it."""

SUNLIT = 133_300.0
"""Illuminance that the sun gives before the air (Darula, Kittler and Gueymard, 2005) [lx]."""

LUX = SUN / pi / SUNLIT
"""Radiance of a white, dull face for each lux, before the picture is exposed [1/lx]."""


@dataclass(frozen=True, slots=True, eq=False)
class Daylight:
    """The light of a scene, linear radiance, each colour of shape (3,)."""

    direction: tuple[float, float, float]
    """To the sun, unit length."""

    sun: Doubles
    """Radiance of a white leaf in full sun."""

    down: Doubles
    """Radiance of a white leaf under the whole sky."""

    clouds: Doubles
    """Radiance of a cloud's underside in full shade."""

    sky: Sky
    """The colours of the sky."""

    exposure: float
    """Radiance in the picture, of that in the scene."""

    lamplight: float
    """The same of what lamps send."""


def daylight(light: Light, /) -> Daylight:
    """Return the light that a scene declares, as bright as the picture is exposed."""
    return daylight_under(light, clear_air(sun_at(light)[1], light.turbidity))


def daylight_under(light: Light, clear: Doubles, /) -> Daylight:
    """Return the light that a scene declares under the clear air that `clear_air` returns, exposed for it."""
    sun = SUN / pi * LEAF * light.strength * transmitted(sun_at(light)[1], light.turbidity) * linear(light.sun)
    sky = sky_of(light, clear, sun)
    exposure = exposure_of(light, sun * clouds_of(light.clouds).past, sky.down)
    shown = Sky(sky.map * exposure, sky.horizon * exposure, sky.down * exposure, sky.clouds * exposure)
    down = shown.down + BOUNCED * sun * exposure
    night = max(USUAL / max(_level(sun, sky.down), DARKEST), 1.0) ** LIT_NIGHT
    return Daylight(to_sun(light), sun * exposure, down, shown.clouds, shown, exposure, exposure * night)


def between(before: Daylight, after: Daylight, part: float, direction: tuple[float, float, float], /) -> Daylight:
    """Return what a picture passes through from one light to another: radiance as each of both is exposed."""

    def mixed(one: Any, other: Any) -> Any:
        return one * (1.0 - part) + other * part

    sky = Sky(*(mixed(getattr(before.sky, each.name), getattr(after.sky, each.name)) for each in fields(Sky)))
    names = "sun", "down", "clouds", "exposure", "lamplight"
    values = {name: mixed(getattr(before, name), getattr(after, name)) for name in names}
    return Daylight(direction, sky=sky, **values)


def exposure_of(light: Light, sun: Doubles, down: Doubles, /) -> float:
    """Return the factor by which a picture is exposed: in part it makes up for little light, as eyes and films do."""
    return float(2.0**light.exposure * (USUAL / max(_level(sun, down), 1e-3)) ** ADAPTS)


def _level(sun: Doubles, down: Doubles) -> float:
    """Return the luminance of a white leaf in this light."""
    return float(luminance(sun + down))
