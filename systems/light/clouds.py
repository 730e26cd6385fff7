"""Clouds: a layer of them that drifts, higher the denser its map is; how they look, and what they leave of light.

They are seen in slices, one above another: their bases, which are grey, their sides, and their tops, which the sun
lights. Each hides what is behind it the more, the denser it is, and is lit the less, the denser the map is there.
`sky.frag` draws what this module means.
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

CONNECTED = 0.17
"""Sine of the elevation down to which slices look like one cloud."""

RISE, SLICES = 2.0 * CLOUDS_SIDE / BILLOWS * (CONNECTED + BENT), (0.0, 0.5, 1.0)
"""How far their tops are above their bases [m]; and how high the slices are, of that: bases, sides and tops.

Seen ten degrees up, a slice lies no farther behind the one below than a heap is wide."""

STEP = 0.12
"""How much denser the map is where a cloud is as high as that, of its range from 0 to 1."""

HIDES = 0.22
"""How much denser the map is than at the edge of a slice where that hides all; as x grows to it, (1 - (x / HIDES)^2)^2
of what is behind is seen: so edges begin softly."""

SOFT = 0.05
"""How much thinner the map may be at an edge than where clouds would begin if edges were hard."""

LIT, DEEPER = (0.74, 0.9, 1.06), (0.75, 0.7, 0.7)
"""How much of the sun's light comes to a slice is the square of the first, less the second for each 1 that the map is
denser there than at its edge: of the lowest to the highest."""

SIDES = 0.0, 0.4, 0.3
"""How much more, for each 1 that the map is denser than behind: that side is turned to the eye, and up."""

ASIDE, SHADES, MOTTLED = 34.0, (0.3, 0.7, 0.7), 0.6
"""How far from it, towards the sun, is what shades a cloud's side [m]; how much less of the sun's light comes to each
slice for each 1 that the map is denser there; and how much denser undersides look for that."""

SUNLIT, SILVER = 0.95, 0.8
"""What a slice sends of the sun's light that comes to it; and of what goes through it, straight ahead of the sun."""

UNDER = 0.27, 0.3
"""What clouds send in full shade, before that: of the sun's light on level ground above, and of the sky's."""

HIGHER = 1.0, 1.25, 1.5
"""How many times as much of that each slice sends, from the lowest to the highest."""

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
    "CLOUDS_AT": CLOUDS_AT, "CLOUDS_BENT": BENT, "CLOUD_RISE": RISE / CLOUDS_AT, "CLOUD_STEP": STEP,
    "CLOUD_SLICES": SLICES,
    "CLOUD_HIDES": HIDES, "CLOUD_LIT": LIT, "CLOUD_DEEPER": DEEPER, "CLOUD_SIDES": SIDES,
    "CLOUD_ASIDE": ASIDE, "CLOUD_SHADES": SHADES, "CLOUD_MOTTLED": MOTTLED, "CLOUD_OVERCAST": OVERCAST,
    "CLOUD_SUNLIT": SUNLIT,
    "CLOUD_SILVER": SILVER, "CLOUD_HIGHER": HIGHER, "CLOUD_PALE": PALE, "CLOUD_DARK": DARK,
    "CLOUD_SENDS": SENDS, "CLOUD_AIR": AIR,
}  # fmt: skip

_RANKS = (np.arange(256) + 0.5) / 256.0
_HEIGHTS = np.array(SLICES)[:, None]
_LIT, _DEEPER, _HIGHER = (np.array(each)[:, None] for each in (LIT, DEEPER, HIGHER))


@dataclass(frozen=True, slots=True)
class Clouds:
    """A sky's clouds in the mean."""

    edge: float
    """Where they begin: how dense the map is at their edges. Above 1 there are none."""

    hides: float
    """The part of the sky that they hide, from 0 to 1."""

    sunlit: float
    """What they send down of the sun's light that comes to their sides and edges, over the whole sky."""

    shaded: float
    """What they send down of what the lowest slice sends in full shade."""

    past: float
    """The part of the sun's light that comes past them, over the whole land."""


def in_shade(sun: Doubles, high: float, sky: Doubles, /) -> Doubles:
    """Return the lowest slice's radiance in full shade, (3,): under a sun of a sine of elevation, and a clear sky."""
    return UNDER[0] * max(high, 0.0) * sun + UNDER[1] * sky


@lru_cache(maxsize=64)
def clouds_of(cover: float, /) -> Clouds:
    """Return the mean of clouds that cover a part of the sky: the values of their map are evenly spread."""
    if cover <= 0.0:
        return Clouds(2.0, 0.0, 0.0, 0.0, 1.0)
    edge = 1.0 - cover - min(SOFT, cover) - OVERCAST * cover**SOON
    least = SENDS * max(edge, 0.0)
    above = _RANKS - edge - STEP * _HEIGHTS
    open_ = (1.0 - np.clip(above / HIDES, 0.0, 1.0) ** 2) ** 2
    before = np.cumprod(np.vstack([np.ones_like(_RANKS), open_]), axis=0)
    shows = before[:-1] * (1.0 - open_)
    sunlit = SUNLIT * np.clip(_LIT - _DEEPER * above, 0.0, 1.0) ** 2
    shaded = _HIGHER * (PALE - DARK * _RANKS)
    hides, sun, sky = (float(each.sum(axis=0).mean()) for each in (shows, shows * sunlit, shows * shaded))
    return Clouds(edge, hides, sun, sky, least + (1.0 - least) * float((open_[0] * open_[-1]).mean()))
