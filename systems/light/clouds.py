"""Clouds: a layer of them that drifts, higher the denser its map is; how they look, and what they leave of light.

A cloud reaches from a level base up to where a parabola of its density ends, and billows stand out from its sides. A
line of sight steps through the layer and sums up what stops it on its way, and how the sun lights that: so bases are
flat and grey, tops are heaped and bright where they face the sun, and edges are soft. `cloudscape.frag` draws what this
module means.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles
from .repeating import CLOUDS_SIDE

CLOUDS_AT = 450.0
"""How high above the eye their undersides are [m]."""

BENT = 0.12
"""How they bend down: at this sine of elevation a level layer of them would be half as far off as without."""

FADE = (-0.02, 0.14)
"""Sines of elevations between which clouds come out of the haze at the horizon."""

RISE = 150.0
"""How far the highest tops are above the bases [m]: a third of how wide heaps are, as of cumulus in fair weather."""

FARTHEST = 450.0
"""How far aside a line of sight goes from the bases to the highest tops at most [m]: lower down, tops are flatter. With
more, what is asked at two heights is of different heaps."""

ROUND = 0.3
"""How much denser than at its edge a cloud is on the map that reaches to the highest tops; one of an x-th part of that
reaches to the root of x of the height, as a dome."""

BILLOWED = 0.36
"""How much denser than in the deepest creases clouds are on the highest billows, on the map: so far these stand out.
Half of it is more, and half of it less than the map says, so that clouds hide as much of the sky as without."""

COLUMN = 45.0
"""Optical depth of a cloud, straight up, is this times how much denser its map is than at its edge: for its shadow, and
for the mean of the sky."""

SOFT = 1.0 / COLUMN
"""How much denser than at its edge a cloud is until it hides as much as its edges let through."""

ASIDE, NEAR = 40.0, 55.0
"""How far off it, towards the sun, is what shades a cloud's side, by how the map rises and by how billows do [m]."""

DEEPER, WITHIN = 9.0, 0.06
"""By how much the odds fall that the sun's light comes to a place, in powers of e, for each 1 that clouds are denser on
the map towards the sun; and the part that is scattered on to all places."""

UNDERSIDE, BASE, SIDES = 0.08, 0.35, 4.5
"""How much denser that is for a base; how much of a side's billows it shows; and how much more higher places do,
for all of the height."""

OPEN, HEAPED = 0.6, 1.0
"""How much less the highest billows are shaded than the deepest creases, as if clouds were so much denser there; and
how much more of a base's light in full shade they send."""

SUNLIT, SILVER = 1.25, 1.0
"""What a cloud sends of the sun's light on a leaf, which gets 0.8 of it: all; and its edges of what goes through, ahead
of the sun."""

STRAYS = 0.28
"""The optical depth that such light meets, of a cloud's: what droplets scatter almost straight on goes on as before.

Of droplets' light the square of their asymmetry does, 0.85 (Joseph, Wiscombe and Weinman, The Delta-Eddington
Approximation for Radiative Flux Transfer, 1976)."""

UNDER = 0.27, 0.3
"""What clouds send in full shade, before that: of the sun's light on level ground above, and of the sky's."""

HIGHER = 0.8
"""How much more of that the highest tops send than bases."""

PALE, DARK = 0.72, 0.22
"""How much of that it sends at its edge, and how much less where the map is denser by 1: thick clouds are darker
beneath."""

AIR = 0.12
"""The part of a clear sky's light that comes from air below the clouds: it is seen before them where the sun shines in.

Of molecules up to a mean height of 8 km 0.055 lie so low, of aerosols up to 1.2 km 0.31; three quarters of the light
come from the first in usual air (Preetham, Shirley and Smits, 1999, turbidity 3)."""

SENDS = 0.35
"""What a lone cloud that hides the sun sends on of its light; where there are more, it is in the sky's."""

OVERCAST, SOON = 0.6, 9.0
"""How dense the thinnest place of an overcast is, and by which power of the cover that comes."""

GLSL = {
    "CLOUDS_AT": CLOUDS_AT, "CLOUDS_BENT": BENT, "CLOUDS_FADE": FADE, "CLOUD_RISE": RISE,
    "CLOUD_STEP": RISE / CLOUDS_AT, "CLOUD_FARTHEST": FARTHEST / CLOUDS_SIDE, "CLOUD_ROUND": ROUND,
    "CLOUD_BILLOWED": BILLOWED, "CLOUD_COLUMN": COLUMN,
    "CLOUD_ASIDE": ASIDE, "CLOUD_NEAR": NEAR, "CLOUD_DEEPER": DEEPER, "CLOUD_WITHIN": WITHIN,
    "CLOUD_UNDER": UNDERSIDE, "CLOUD_BASE": BASE, "CLOUD_SIDE": SIDES, "CLOUD_OPEN": OPEN, "CLOUD_HEAPED": HEAPED,
    "CLOUD_SUNLIT": SUNLIT, "CLOUD_SILVER": SILVER, "CLOUD_HIGHER": HIGHER, "CLOUD_PALE": PALE, "CLOUD_DARK": DARK,
    "CLOUD_SENDS": SENDS, "CLOUD_STRAYS": STRAYS, "CLOUD_AIR": AIR, "CLOUD_OVERCAST": OVERCAST,
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
    open_ = np.exp(-COLUMN * above)
    hides = 1.0 - open_
    odds = np.exp(DEEPER * (above + UNDERSIDE * (1.0 - BASE)))
    sunlit = hides * SUNLIT * (WITHIN + (1.0 - WITHIN) / (1.0 + odds))
    shaded = hides * (PALE - DARK * above)
    hidden, sun, sky = (float(each.mean()) for each in (hides, sunlit, shaded))
    return Clouds(edge, hidden, sun, sky, least + (1.0 - least) * float(open_.mean()))
