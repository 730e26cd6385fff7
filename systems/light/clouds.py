"""Clouds: a layer of them that drifts, higher the denser its map is; how they look, and what they leave of light.

They are seen in slices, one above another. Each hides what is behind it the more, the denser it is, and has the sun's
light as far as the cloud lets it through on the way there. `sky.frag` draws what this module means.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles

CLOUDS_AT = 450.0
"""How high above the eye their undersides are [m]."""

SLICES, RISE = 3, 60.0
"""Slices that they are seen in, and how far one is above another [m]."""

STEP = 0.12
"""How much denser the map is where a cloud is a slice higher, of its range from 0 to 1."""

HIDES = 0.3
"""How much denser the map is than at the edge of a slice where that hides all; as x grows to it, (1 - x / HIDES)^4 of
what is behind is seen, which is near enough to exp(-4 x / HIDES), and costs a graphics card less."""

SHADES = 0.9
"""How much denser it is, a little way toward the sun, where none of its light comes to a slice: it falls by the
fourth power too."""

SUNLIT, SILVER = 0.7, 0.8
"""What a slice sends of the sun's light that comes to it; and of what goes through it, straight ahead of the sun."""

UNDER = 0.27, 0.3
"""What the lowest slice sends in full shade: of the sun's light on level ground above, and of the sky's."""

HIGHER = 0.5
"""How much more of that each slice sends than the one below it."""

SENDS = 0.35
"""What a lone cloud that hides the sun sends on of its light; where there are more, it is in the sky's."""

OVERCAST, SOON = 0.35, 8.0
"""How dense the thinnest place of an overcast is, and by which power of the cover that comes."""

GLSL = {
    "CLOUDS_AT": CLOUDS_AT, "CLOUD_RISE": RISE, "CLOUD_STEP": STEP, "CLOUD_HIDES": HIDES, "CLOUD_SHADES": SHADES,
    "CLOUD_SUNLIT": SUNLIT, "CLOUD_SILVER": SILVER, "CLOUD_HIGHER": HIGHER, "CLOUD_SENDS": SENDS,
}  # fmt: skip

_RANKS = (np.arange(256) + 0.5) / 256.0
_HEIGHTS = np.arange(SLICES)[:, None]


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
    edge = 1.0 - cover - OVERCAST * cover**SOON
    least = SENDS * max(edge, 0.0)
    above = _RANKS - edge - STEP * _HEIGHTS
    open_ = np.clip(1.0 - above / HIDES, 0.0, 1.0)
    before = np.cumprod(np.vstack([np.ones_like(_RANKS), open_**4]), axis=0)
    shows = before[:-1] * (1.0 - open_**4)
    sunlit = SUNLIT * (0.5 + 0.5 * open_) * np.clip(1.0 - above / SHADES, 0.0, 1.0) ** 4
    shaded = 1.0 + HIGHER * _HEIGHTS
    hides, sun, sky = (float(each.sum(axis=0).mean()) for each in (shows, shows * sunlit, shows * shaded))
    return Clouds(edge, hides, sun, sky, least + (1.0 - least) * float(before[2].mean()))
