"""Stars: a field of them from a scene's seed, as many of each magnitude as there are, that turns about the pole.

They are drawn over the sky, each as a soft spot, once the sun is low enough below the horizon.
"""

from collections.abc import Mapping
from functools import lru_cache
from math import asin, atan2, cos, degrees, log, pi, radians, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...engine.declared.light import Light
from ...engine.gl.stream import release_all
from ..frame.block import FrameBlock, joined
from .color import luminance
from .daylight import Daylight
from .sky import NIGHT
from .sun import transmitted_from_zenith

FAINTEST = 6.0
"""Magnitude of the faintest stars, as a naked eye sees them."""

BRIGHTER_THAN_0, STEEPNESS = 4.8, 0.5
"""Number of stars in the whole sky brighter than magnitude 0; and the increase of the decadic logarithm of the number
per magnitude. They give 48 to magnitude 2, 480 to 4, 4800 to 6 (Cox, Allen's Astrophysical Quantities, 2000, has 40,
530 and 5000)."""

STARS = round(BRIGHTER_THAN_0 * 10.0 ** (STEEPNESS * FAINTEST))
"""Number of stars in the whole sky."""

MAGNITUDE = 0.4
"""Decrease of the decadic logarithm of a star's light per magnitude (Pogson, 1856)."""

WARM, COLD = np.array([1.0, 0.78, 0.55]), np.array([0.70, 0.79, 1.0])
"""Colours of stars of 4,200 and 9,000 K, linear, as most that a naked eye sees lie between."""

SKY_MAGNITUDE = 20.0
"""Magnitude of a square second of arc of the night sky under half a moon (Krisciunas and Schaefer, A Model of the
Brightness of Moonlight, 1991)."""

SECOND = pi / 180.0 / 3600.0
"""Second of arc [rad]."""

OF_NIGHT = 10.0 ** (MAGNITUDE * SKY_MAGNITUDE) * SECOND**2
"""Light of a star of magnitude 0, relative to the night sky's radiance [sr]."""

DEPRESSIONS, ILLUMINANCES = (6.0, 12.0, 18.0), (3.4, 0.008, 0.0006)
"""Depressions of the sun at the ends of civil, nautical and astronomical twilight [degrees], and the illuminance of
level ground then [lx] (Seidelmann, Explanatory Supplement to the Astronomical Almanac, 1992). Stars stand out from the
sky the less, the brighter it is; before the end of civil twilight none are drawn."""

EQUINOX, YEAR = 80.0, 365.24
"""Day of the year when the sun's right ascension is 0; length of a year [days]."""

SPOT = 0.6
"""Standard deviation of a star's spot [pixels]: its light is the same wherever it stands between pixels, to 0.2 %."""

REACH = 4.5
"""Half the side of a spot's square, in standard deviations: beyond it even the brightest stars add nothing visible."""

GLSL = {"STAR_SPOT": SPOT, "STAR_REACH": REACH}


@lru_cache(maxsize=4)
def star_field(*, seed: int) -> Floats:
    """Return the stars of a seed, brightest first, shape (STARS, 6): direction and light.

    The direction is a unit vector: towards the equator at right ascensions of 0 and 6 hours, and towards the pole.
    Light is red, green and blue; its luminance is 1 for magnitude 0.
    """
    random = np.random.default_rng([seed, 0x73746172])
    magnitude = np.log10((np.arange(STARS) + 0.5) / BRIGHTER_THAN_0) / STEEPNESS
    up, around = random.uniform(-1.0, 1.0, STARS), random.uniform(0.0, 2.0 * pi, STARS)
    level = np.sqrt(1.0 - up * up)
    colour = WARM + random.random((STARS, 1)) * (COLD - WARM)
    light = colour * (10.0 ** (-MAGNITUDE * magnitude) / luminance(colour))[:, None]
    return np.column_stack([level * np.cos(around), level * np.sin(around), up, light]).astype(np.float32)


def turn_of(light: Light, toward_sun: tuple[float, float, float], /) -> Doubles:
    """Return the matrix (3, 3) from directions of `star_field` to those in the scene, by the direction to the sun.

    North is -z. So stars turn with the sun, and over the year about the pole as well.
    """
    up, (x, y, z) = radians(light.latitude), toward_sun
    hour_angle = atan2(-x, cos(up) * y + sin(up) * z)
    sidereal = hour_angle + 2.0 * pi * (light.day - EQUINOX) / YEAR
    south, west = np.array([cos(sidereal), sin(sidereal), 0.0]), np.array([sin(sidereal), -cos(sidereal), 0.0])
    pole = np.array([0.0, 0.0, 1.0])
    return np.stack([-west, sin(up) * pole + cos(up) * south, sin(up) * south - cos(up) * pole])


def starlight(shown: Daylight, /) -> float:
    """Return the light of a star of magnitude 0 in the picture [radiance sr]; 0 before the end of civil twilight."""
    depression = -degrees(asin(max(-1.0, min(1.0, shown.direction[1]))))
    if depression <= DEPRESSIONS[0]:
        return 0.0
    dark = ILLUMINANCES[-1] / np.exp(np.interp(depression, DEPRESSIONS, np.log(ILLUMINANCES)))
    return float(OF_NIGHT * dark * luminance(NIGHT) * shown.exposure)


class Stars:
    """The stars' buffer and program."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx, self._record = ctx, block.record
        self._program = joined(ctx, block, units, "systems/light/stars.vert", "systems/light/stars.frag", {})
        self._buffer: moderngl.Buffer | None = None
        self._array: moderngl.VertexArray | None = None

    def lay(self, *, seed: int) -> None:
        """Take over the stars of a scene's seed."""
        release_all(self._array, self._buffer)
        self._buffer = self.ctx.buffer(star_field(seed=seed))
        self._array = self.ctx.vertex_array(self._program, [(self._buffer, "3f 3f /i", "star", "bright")])

    def shine(self, light: Light, shown: Daylight, record: NDArray[np.void], /) -> None:
        """Take over a light that is shown, and write that of stars into the frame block."""
        record[0]["starlight"] = starlight(shown)
        self._program["turn"] = turn_of(light, shown.direction).T.reshape(9).tolist()
        self._program["zenith_depth"] = -log(luminance(transmitted_from_zenith(light.turbidity)))

    def draw(self) -> int:
        """Add the stars to the sky, behind all that is opaque; return the number of draw calls."""
        if self._array is None or self._record[0]["starlight"] <= 0.0:
            return 0
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=STARS)
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        return 1

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self._array, self._buffer, self._program)
