"""Clouds: a layer of them that drifts, higher the denser its map is; how they look, and what they leave of light.

A cloud reaches from a level base up to where a parabola of its density ends. A line of sight asks the map at a few
heights, takes it to change evenly from one to the next, and finds where it enters a cloud and how much of it lies
before the sky: so bases are flat and grey, and the sun lights round tops. `sky.frag` draws what this module means.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles
from .repeating import BILLOWS, CLOUDS_SIDE

CLOUDS_AT = 450.0
"""How high above the eye their undersides are [m]."""

BENT = 0.12
"""How they bend down: at this sine of elevation a level layer of them would be half as far off as without."""

RISE = 0.7 * 2.0 * CLOUDS_SIDE / BILLOWS * (0.17 + BENT)
"""How far the highest tops are above the bases [m]: a line of sight ten degrees up goes aside below them by 0.7 of the
distance from heap to heap. With more, what is asked at two heights is of different heaps."""

HEIGHTS = (0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0)
"""The heights at which a line of sight asks the map, of that."""

ROUND = 0.3
"""How much denser than at its edge a cloud is on the map that reaches to the highest tops; one of an x-th part of that
reaches to the root of x of the height, as a dome."""

LEVEL = 1.5
"""Level of the map's mip-maps that heaps are read from: with finer ones, heights differ by more than a heap's edge."""

ABOVE = 3.0
"""The same of heights above the base: half of the way aside from one height to the next is some two texels wide there.
Heaps narrower than that would be seen once at each height, as a stack of slices."""

THICK = 160.0
"""Optical depth of all heights where the map is denser by 1 than at a cloud's edge: only wisps are soft."""

COLUMN = THICK * 2.0 / 3.0 / ROUND**0.5
"""Optical depth of a cloud seen from below is this times its density above that at the edge, to the power of 1.5."""

SOFT = 0.023
"""How much denser than at its edge a cloud is that hides half of what is behind it, seen from below."""

LIT, HIGHER_UP, DEEPER = 0.7, 0.45, 0.7
"""How much of the sun's light comes to a base is the square of the first; that grows with the height, from bases to
the highest tops, by the second, and falls by the third for each 1 that the map is denser than at the edge."""

ASIDE, SHADES, MOTTLED = 34.0, 0.9, 0.6
"""How far from it, towards the sun, is what shades a cloud's side [m]; how much less of the sun's light comes to it
for each 1 that the map is denser there; and how much denser undersides look for that."""

MOST_SHADED = (-0.3, 0.4)
"""How much thinner and denser that counts at most."""

SUNLIT, SILVER = 0.95, 1.6
"""What a cloud sends of the sun's light that comes to it; and its edges of what goes through, ahead of the sun."""

STRAYS = 0.28
"""The optical depth that such light meets, of a cloud's: what droplets scatter almost straight on goes on as before.

Of droplets' light the square of their asymmetry does, 0.85 (Joseph, Wiscombe and Weinman, The Delta-Eddington
Approximation for Radiative Flux Transfer, 1976)."""

UNDER = 0.27, 0.3
"""What clouds send in full shade, before that: of the sun's light on level ground above, and of the sky's."""

HIGHER = 0.6
"""How much more of that the highest tops send than bases."""

PALE, DARK = 1.3, 0.6
"""How much of that it sends where the map is 0, and how much less where it is 1: thick clouds are darker beneath."""

AIR = 0.12
"""The part of a clear sky's light that comes from air below the clouds: it is seen before them where the sun shines in.

Of molecules up to a mean height of 8 km 0.055 lie so low, of aerosols up to 1.2 km 0.31; three quarters of the light
come from the first in usual air (Preetham, Shirley and Smits, 1999, turbidity 3)."""

SENDS = 0.35
"""What a lone cloud that hides the sun sends on of its light; where there are more, it is in the sky's."""

OVERCAST, SOON = 0.6, 8.0
"""How dense the thinnest place of an overcast is, and by which power of the cover that comes."""

GLSL = {
    "CLOUDS_AT": CLOUDS_AT, "CLOUDS_BENT": BENT, "CLOUD_RISE": RISE / CLOUDS_AT, "CLOUD_HEIGHTS": HEIGHTS,
    "CLOUD_ROUND": ROUND, "CLOUD_LEVEL": LEVEL, "CLOUD_ABOVE": ABOVE, "CLOUD_THICK": THICK, "CLOUD_COLUMN": COLUMN,
    "CLOUD_LIT": LIT, "CLOUD_HIGHER_UP": HIGHER_UP, "CLOUD_DEEPER": DEEPER, "CLOUD_ASIDE": ASIDE,
    "CLOUD_SHADES": SHADES, "CLOUD_MOTTLED": MOTTLED, "CLOUD_MOST_SHADED": MOST_SHADED, "CLOUD_OVERCAST": OVERCAST,
    "CLOUD_SUNLIT": SUNLIT, "CLOUD_SILVER": SILVER, "CLOUD_HIGHER": HIGHER, "CLOUD_PALE": PALE, "CLOUD_DARK": DARK,
    "CLOUD_SENDS": SENDS, "CLOUD_STRAYS": STRAYS, "CLOUD_AIR": AIR,
}  # fmt: skip

_RANKS = (np.arange(256) + 0.5) / 256.0


@dataclass(frozen=True, slots=True)
class Clouds:
    """A sky's clouds in the mean."""

    edge: float
    """Where they begin: how dense the map is at their edges. Above 1 there are none."""

    hides: float
    """The part of the sky that they hide, from 0 to 1."""

    sunlit: float
    """What they send down of the sun's light that comes to their bases and edges, over the whole sky."""

    shaded: float
    """What they send down of what a base sends in full shade."""

    past: float
    """The part of the sun's light that comes past them, over the whole land."""


def in_shade(sun: Doubles, high: float, sky: Doubles, /) -> Doubles:
    """Return a base's radiance in full shade, (3,): under a sun of a sine of elevation, and a clear sky."""
    return UNDER[0] * max(high, 0.0) * sun + UNDER[1] * sky


@lru_cache(maxsize=64)
def clouds_of(cover: float, /) -> Clouds:
    """Return the mean of clouds that cover a part of the sky, seen from below: values of the map are evenly spread."""
    if cover <= 0.0:
        return Clouds(2.0, 0.0, 0.0, 0.0, 1.0)
    edge = 1.0 - cover - min(SOFT, cover) - OVERCAST * cover**SOON
    least = SENDS * max(edge, 0.0)
    above = np.maximum(_RANKS - edge, 0.0)
    open_ = np.exp(-COLUMN * above**1.5)
    hides = 1.0 - open_
    sunlit = hides * SUNLIT * np.clip(LIT - DEEPER * above, 0.0, 1.0) ** 2
    shaded = hides * (PALE - DARK * _RANKS)
    hidden, sun, sky = (float(each.mean()) for each in (hides, sunlit, shaded))
    return Clouds(edge, hidden, sun, sky, least + (1.0 - least) * float(open_.mean()))
