"""Clouds: constants of a drifting layer of clouds, and its mean effect on the light of the sky and the ground.

A cloud stands on a level base. Its height is the root of its excess density: how much the cloud map exceeds its value
at the edge, relative to the most that it does anywhere. So sides lean inwards, up to round tops. Fine parts of the map
fade with height: they fray bases and leave scraps of cloud. Billows stand out from all sides.

`cloudscape.frag` marches through the layer and accumulates optical depth and two sorts of light: sunlight from lit
sides, and from sides in shade what is scattered through the cloud many times. So bases are flat and grey, tops are
heaped and bright towards the sun, edges are soft.
"""

import math
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

TALLEST = 200.0
"""Height of the highest tops above the bases [m]: half of a heap's width, as in fair-weather cumulus."""

ASPECT = 0.5
"""Height of a lone cloud, relative to its width."""

FARTHEST_ASIDE = 540.0
"""Largest horizontal distance of a line of sight between bases and highest tops [m]; near the horizon it flattens tops.
With more, samples at successive heights would belong to different heaps."""

DOME = 0.3
"""Excess density whose column weakens light as a cloud of the height of the highest tops does; of the fraction x of it,
as one of sqrt(x) of that height. Where few clouds are left, it is also what reaches so high: others stay lower."""

BILLOWED = 0.36
"""Difference in map density between the highest billows and the deepest creases. It is centred on the map's value, so
that billows do not change the mean cover."""

DENSEST = 1.0 + 0.5 * BILLOWED
"""Largest density of the map, with the highest billows: there a cloud just reaches the highest tops, and none is cut
off."""

DEPTH = 45.0
"""Vertical optical depth per unit of excess density, for a cloud's shadow and the mean of the sky."""

SOFT = 1.0 / DEPTH
"""Excess density at which the vertical optical depth is 1."""

MAP_ASIDE, BILLOWS_ASIDE = 40.0, 55.0
"""Distances towards the sun at which the self-shadowing of a cloud is taken from the slope of the map, and from the
slope of the billows [m]."""

SHADING = 9.0
"""Decrease in the log-odds of sunlight at a place, per unit of map density towards the sun."""

BASE_SHADING, RELIEF = 0.2, 4.5
"""Extra density towards the sun at a base; and the increase over the whole height, up to 1, of the fraction to which
billows are lit and shaded one by one: at bases they are not, as light comes to them through the whole cloud."""

CREASE_SHADING = 0.6
"""Difference in shading density between the deepest creases and the highest billows."""

SUPPORT = 2.0 / BILLOWED
"""Strength of billows per unit of excess density, up to 1: they at most double it, so that they float nowhere far above
a cloud. At a base it is larger by 1, so that billows reach out there too."""

SUNLIT, SILVER = 1.25, 1.0
"""Radiance of a sunlit cloud relative to a leaf in the sun: a cloud reflects all light, a leaf gets 0.8 of it. And
strength of the silver lining: transmitted light at edges in front of the sun."""

SILVER_DEPTH = 0.28
"""Optical depth for the silver lining, relative to the cloud's: light scattered almost straight on counts as
unscattered.

The fraction scattered so is the square of `ASYMMETRY` (Joseph, Wiscombe and Weinman, The Delta-Eddington Approximation
for Radiative Flux Transfer, 1976)."""

ASYMMETRY = 0.85
"""Mean cosine of the angle by which cloud droplets scatter light."""

WATER, DROPLET = 0.5, 8.0
"""Liquid water in clouds [g/m^3], and effective radius of their droplets [micrometres], as in small cumulus."""

EXTINCTION = 1.5 * WATER / DROPLET
"""Optical depth of a cloud per metre of depth [1/m] (Stephens, Radiation Profiles in Extended Water Clouds, 1978)."""

DIFFUSION = 0.5 * (1.0 - ASYMMETRY) * EXTINCTION * TALLEST
"""Weakening of light that is scattered through a cloud, per height of the highest tops: 1 / (1 + `DIFFUSION`) comes
through that much cloud.

The rest is reflected, as droplets absorb nothing. This is scattering to all orders in two streams (Bohren, Multiple
Scattering of Light and Some of Its Observable Consequences, 1987)."""

AIR_VEIL = 0.12
"""Fraction of a clear sky's radiance that comes from air below the clouds: it veils them where the sun shines in.

Of molecules with a scale height of 8 km, 0.055 lie that low; of aerosols with 1.2 km, 0.31. Molecules send three
quarters of the light in usual air (Preetham, Shirley and Smits, 1999, turbidity 3)."""

LONE_CLOUD = 0.35
"""Fraction of sunlight that a lone cloud before the sun scatters on; with many clouds it is part of the skylight."""

GROUND_ALBEDO = 0.19
"""Albedo of the ground below clouds: luminance that meadow, grove and hedgerow send straight up, as they are drawn from
above under a clear sky, relative to white level ground.

It is grey: bases of clouds tell of all the land around, with its soil and straw, and eyes are adapted to its colour."""

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
    "CLOUD_DENSEST": DENSEST,
    "CLOUD_BILLOWED": BILLOWED,
    "CLOUD_DEPTH": DEPTH,
    "CLOUD_MAP_ASIDE": MAP_ASIDE,
    "CLOUD_BILLOWS_ASIDE": BILLOWS_ASIDE,
    "CLOUD_SHADING": SHADING,
    "CLOUD_BASE_SHADING": BASE_SHADING,
    "CLOUD_RELIEF": RELIEF,
    "CLOUD_CREASE_SHADING": CREASE_SHADING,
    "CLOUD_SUNLIT": SUNLIT,
    "CLOUD_SILVER": SILVER,
    "CLOUD_DIFFUSION": DIFFUSION,
    "CLOUD_SUPPORT": SUPPORT,
    "CLOUD_ASPECT": ASPECT,
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

    lit: float
    """Radiance that the lit sides of clouds send down, relative to a cloud in full sun."""

    scattered: float
    """Radiance that clouds send down of the light scattered through them, relative to a thin cloud's."""

    both: float
    """Part of `scattered` on lit sides."""

    past: float
    """Fraction of sunlight that passes the clouds, averaged over the land."""


def sun_scattered(high: float, edge: float, /) -> float:
    """Return the sunlight that a thin cloud sends from its shade, relative to a cloud in full sun.

    `high` is the sine of the sun's elevation, `edge` as in `Clouds`. A lone cloud takes sunlight in with its top and a
    side, and lets it out of its base and the half of its sides that is in shade. An overcast has no sides.
    """
    aspect, sine = ASPECT * min(max(edge, 0.0), 1.0), max(high, 0.0)
    return (sine + aspect * math.sqrt(max(1.0 - high * high, 0.0))) / (1.0 + 2.0 * aspect)


def in_shade(sun: Doubles, high: float, sky: Doubles, clouds: Clouds, /) -> Doubles:
    """Return the radiance of a thin cloud in full shade, (3,); of thicker ones less is left.

    `sun` is the radiance of a white leaf in full sun, `high` the sine of the sun's elevation, `sky` the clear sky's
    irradiance as radiance.
    """
    return SUNLIT * sun_scattered(high, clouds.edge) * sun + sky


def sent_down(sun: Doubles, high: float, shaded: Doubles, clouds: Clouds, /) -> Doubles:
    """Return the mean radiance of clouds times their cover, (3,): `shaded` is that of `in_shade`."""
    lit = clouds.lit - sun_scattered(high, clouds.edge) * clouds.both
    return SUNLIT * lit * sun + clouds.scattered * shaded


def from_below(sun: Doubles, high: float, down: Doubles, clouds: Clouds, /) -> Doubles:
    """Return the mean radiance of the ground below clouds, (3,).

    `sun` and `high` are as in `in_shade`; `down` is the irradiance of sky and clouds as radiance, without what comes
    from the ground. Of light from below, clouds reflect what they do not let through, and all of it goes to and fro, as
    a geometric series (Barker and Davies, Solar Radiative Fluxes for Broken Cloud Fields above Reflecting Surfaces,
    1992).
    """
    level = SUNLIT * max(high, 0.0) * clouds.past * sun + down
    return np.asarray(GROUND_ALBEDO * level / (1.0 - GROUND_ALBEDO * (clouds.hidden - clouds.scattered)))


@lru_cache(maxsize=64)
def clouds_of(cover: float, /) -> Clouds:
    """Return the means of clouds that cover a fraction of the sky, seen from below; the map's values are uniform."""
    if cover <= 0.0:
        return Clouds(2.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    edge = 1.0 - cover - min(SOFT, cover) - OVERCAST * cover**OVERCAST_POWER
    lone = LONE_CLOUD * max(edge, 0.0)
    excess = np.maximum(_RANKS - edge, 0.0)
    transmittance = np.exp(-DEPTH * excess)
    hidden = 1.0 - transmittance
    lit = 1.0 / (1.0 + np.exp(SHADING * (excess + BASE_SHADING)))
    scattered = hidden / (1.0 + DIFFUSION * np.sqrt(excess / DOME))
    part, bright, sent, both = (float(each.mean()) for each in (hidden, hidden * lit, scattered, scattered * lit))
    return Clouds(edge, part, bright, sent, both, lone + (1.0 - lone) * float(transmittance.mean()))
