"""Clouds: constants of a drifting layer of clouds, and its mean effect on the light of the sky and the ground.

A cloud stands on a level base. Its height is the root of its excess density: how much the cloud map exceeds its value
at the edge. Billows stand out from its sides. `cloudscape.frag` marches through the layer and accumulates optical depth
and sunlight: bases are flat and grey, tops are heaped and bright towards the sun, edges are soft.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles
from .repeating import CLOUDS_SIDE

BASE_HEIGHT = 450.0
"""Height of the bases above the eye [m]."""

BEND = 0.12
"""Bend of the layer towards the horizon: at this sine of elevation clouds are half as far away as in a level layer."""

FADE = (-0.02, 0.14)
"""Sines of elevation between which clouds fade in from the haze at the horizon."""

TALLEST = 150.0
"""Height of the highest tops above the bases [m]: a third of a heap's width, as in fair-weather cumulus."""

FARTHEST_ASIDE = 450.0
"""Largest horizontal distance of a line of sight between bases and highest tops [m]; near the horizon it flattens tops.
With more, samples at successive heights would belong to different heaps."""

DOME = 0.3
"""Excess density at which a cloud reaches the highest tops. With the fraction x of it, a cloud has sqrt(x) of that
height: a dome."""

BILLOWED = 0.36
"""Difference in map density between the highest billows and the deepest creases. It is centred on the map's value, so
that billows do not change the mean cover."""

DEPTH = 45.0
"""Vertical optical depth per unit of excess density, for a cloud's shadow and the mean of the sky."""

SOFT = 1.0 / DEPTH
"""Excess density at which the vertical optical depth is 1."""

MAP_ASIDE, BILLOWS_ASIDE = 40.0, 55.0
"""Distances towards the sun at which the self-shadowing of a cloud is taken from the slope of the map, and from the
slope of the billows [m]."""

SHADING, MULTIPLE = 9.0, 0.06
"""Decrease in the log-odds of sunlight at a place, per unit of map density towards the sun; and the fraction of
sunlight that multiple scattering brings to every place."""

BASE_SHADING, BASE_BILLOWS, SIDE_BILLOWS = 0.08, 0.35, 4.5
"""Extra density towards the sun at a base; strength of billows at a base; its increase over the whole height."""

CREASE_SHADING, BILLOW_LIGHT = 0.6, 1.0
"""Difference in shading density between the deepest creases and the highest billows; and the extra light in full shade
that the highest billows send, relative to a base's."""

SUNLIT, SILVER = 1.25, 1.0
"""Radiance of a sunlit cloud relative to a leaf in the sun: a cloud reflects all light, a leaf gets 0.8 of it. And
strength of the silver lining: transmitted light at edges in front of the sun."""

SILVER_DEPTH = 0.28
"""Optical depth for the silver lining, relative to the cloud's: light scattered almost straight on counts as
unscattered.

The fraction scattered so is the square of the droplets' asymmetry of 0.85 (Joseph, Wiscombe and Weinman, The
Delta-Eddington Approximation for Radiative Flux Transfer, 1976)."""

SHADED_BASE = 0.27, 0.3
"""Radiance of a base in full shade, relative to sunlight on level ground above it, and to skylight."""

SHADED_TOP = 0.8
"""Extra radiance in full shade of the highest tops, relative to a base's."""

SHADED_EDGE, DARKENING = 0.72, 0.22
"""Factor on the radiance in full shade at a cloud's edge; and its decrease per unit of map density: thick clouds are
darker beneath."""

AIR_VEIL = 0.12
"""Fraction of a clear sky's radiance that comes from air below the clouds: it veils them where the sun shines in.

Of molecules with a scale height of 8 km, 0.055 lie that low; of aerosols with 1.2 km, 0.31. Molecules send three
quarters of the light in usual air (Preetham, Shirley and Smits, 1999, turbidity 3)."""

LONE_CLOUD = 0.35
"""Fraction of sunlight that a lone cloud before the sun scatters on; with many clouds it is part of the skylight."""

OVERCAST, OVERCAST_POWER = 0.6, 9.0
"""Excess density at the thinnest place of an overcast; and the power of the cover by which it is added."""

GLSL = {
    "CLOUD_BASE_HEIGHT": BASE_HEIGHT,
    "CLOUD_BEND": BEND,
    "CLOUD_FADE": FADE,
    "CLOUD_TALLEST": TALLEST,
    "CLOUD_TALLEST_RATIO": TALLEST / BASE_HEIGHT,
    "CLOUD_FARTHEST_ASIDE": FARTHEST_ASIDE / CLOUDS_SIDE,
    "CLOUD_DOME": DOME,
    "CLOUD_BILLOWED": BILLOWED,
    "CLOUD_DEPTH": DEPTH,
    "CLOUD_MAP_ASIDE": MAP_ASIDE,
    "CLOUD_BILLOWS_ASIDE": BILLOWS_ASIDE,
    "CLOUD_SHADING": SHADING,
    "CLOUD_MULTIPLE": MULTIPLE,
    "CLOUD_BASE_SHADING": BASE_SHADING,
    "CLOUD_BASE_BILLOWS": BASE_BILLOWS,
    "CLOUD_SIDE_BILLOWS": SIDE_BILLOWS,
    "CLOUD_CREASE_SHADING": CREASE_SHADING,
    "CLOUD_BILLOW_LIGHT": BILLOW_LIGHT,
    "CLOUD_SUNLIT": SUNLIT,
    "CLOUD_SILVER": SILVER,
    "CLOUD_SHADED_TOP": SHADED_TOP,
    "CLOUD_SHADED_EDGE": SHADED_EDGE,
    "CLOUD_DARKENING": DARKENING,
    "CLOUD_LONE": LONE_CLOUD,
    "CLOUD_SILVER_DEPTH": SILVER_DEPTH,
    "CLOUD_AIR_VEIL": AIR_VEIL,
    "CLOUD_OVERCAST": OVERCAST,
}

_RANKS = (np.arange(256) + 0.5) / 256.0


@dataclass(frozen=True, slots=True)
class Clouds:
    """Means of a sky's clouds over the whole sky."""

    edge: float
    """Map density at the edges of clouds; above 1 there are no clouds."""

    hidden: float
    """Fraction of the sky that clouds hide, from 0 to 1."""

    sunlit: float
    """Radiance that clouds send down in sunlight, relative to a white leaf in full sun."""

    shaded: float
    """Radiance that clouds send down in shade, relative to a base in full shade."""

    past: float
    """Fraction of sunlight that passes the clouds, averaged over the land."""


def in_shade(sun: Doubles, high: float, sky: Doubles, /) -> Doubles:
    """Return a base's radiance in full shade, (3,).

    `sun` is the radiance of a white leaf in full sun, `high` the sine of the sun's elevation, `sky` the clear sky's
    irradiance as radiance.
    """
    return SHADED_BASE[0] * max(high, 0.0) * sun + SHADED_BASE[1] * sky


@lru_cache(maxsize=64)
def clouds_of(cover: float, /) -> Clouds:
    """Return the means of clouds that cover a fraction of the sky, seen from below; the map's values are uniform."""
    if cover <= 0.0:
        return Clouds(2.0, 0.0, 0.0, 0.0, 1.0)
    edge = 1.0 - cover - min(SOFT, cover) - OVERCAST * cover**OVERCAST_POWER
    lone = LONE_CLOUD * max(edge, 0.0)
    excess = np.maximum(_RANKS - edge, 0.0)
    transmittance = np.exp(-DEPTH * excess)
    hidden = 1.0 - transmittance
    odds = np.exp(SHADING * (excess + BASE_SHADING * (1.0 - BASE_BILLOWS)))
    sunlit = hidden * SUNLIT * (MULTIPLE + (1.0 - MULTIPLE) / (1.0 + odds))
    shaded = hidden * (SHADED_EDGE - DARKENING * excess)
    part, sun, sky = (float(each.mean()) for each in (hidden, sunlit, shaded))
    return Clouds(edge, part, sun, sky, lone + (1.0 - lone) * float(transmittance.mean()))
