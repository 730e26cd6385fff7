"""The atmosphere: its transmittance for sunlight, and the light that it scatters to the eye.

Molecules, haze and ozone form layers around a sphere. Single scattering is integrated along the line of sight; multiple
scattering is taken as isotropic (Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique,
2020).
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles

GROUND, TOP = 6360.0, 6460.0
"""Radii of the planet and of its atmosphere [km]."""

MOLECULES = np.array([7.21, 14.09, 33.0]) * 1e-3
"""Scattering coefficients of molecules at sea level, in the red, green and blue of sRGB [1/km].

They weaken sunlight as its spectrum is weakened (ASTM G173) by five times the air overhead, where it shows most, if
13.56 is scattered at 550 nm and the rest by the wavelength to the power of -4, and seen through the eye's response
(Wyman, Sloan and Shirley, Simple Analytic Approximations to the CIE XYZ Color Matching Functions, 2013). At single
wavelengths of 680, 550 and 440 nm, red would be farther out than a screen's, and low suns and clouds pink."""

HAZE_SCATTERING, HAZE_ABSORPTION = 3.996e-3, 4.40e-3
"""Scattering and absorption coefficients of haze at sea level [1/km]."""

MOLECULES_SCALE, HAZE_SCALE = 8.0, 1.2
"""Scale heights of molecules and of haze [km]."""

OZONE = np.array([2.47, 1.78, 0.0]) * 1e-3
"""Absorption coefficients of ozone in the middle of its layer, found alike [1/km]: it absorbs most about 600 nm, in
a screen's red (Serdyuchenko et al., High Spectral Resolution Ozone Absorption Cross-Sections, 2014)."""

OZONE_MIDDLE, OZONE_HALF = 25.0, 15.0
"""Height of the ozone's middle [km], and distance above and below at which there is none any more [km]."""

FORWARD = 0.8
"""Asymmetry of the haze's phase function: -1 is all backward, 1 all forward."""

USUAL_TURBIDITY = 2.6
"""Turbidity at which the haze has the coefficients `HAZE_SCATTERING` and `HAZE_ABSORPTION`."""

GROUND_ALBEDO = 0.25
"""Albedo of the ground."""

STEPS, SUN_STEPS, DIRECTIONS = 24, 12, 48
"""Samples along a line of sight; samples towards the sun; directions over which multiple scattering is averaged."""

_SUN_MIDDLES = ((np.arange(SUN_STEPS) + 0.5) / SUN_STEPS) ** 2
_SUN_LENGTHS = (2.0 * np.arange(SUN_STEPS) + 1.0) / SUN_STEPS**2

HIGHEST = 60.0
"""Largest height in the table of multiple scattering [km]."""

HEIGHTS = 0.01 + HIGHEST * (np.arange(10) / 9.0) ** 2
"""Heights of the rows of that table [km]."""

EYE = GROUND + 0.2
"""Radius from which the sky is seen [km]."""


def _haze_density(turbidity: float) -> float:
    """Return the density of the haze, relative to that at the usual turbidity."""
    return (turbidity - 1.0) / (USUAL_TURBIDITY - 1.0)


def _distance_out(radius: Doubles, cosine: Doubles) -> Doubles:
    """Return the distance [km] from a radius to the top of the atmosphere, by the cosine of the zenith angle."""
    return np.asarray(-radius * cosine + np.sqrt(np.maximum(radius**2 * (cosine**2 - 1.0) + TOP**2, 0.0)))


def sunlight(radius: Doubles, cosine: Doubles, turbidity: float, /) -> Doubles:
    """Return the transmittance from the sun to points in the atmosphere, shape (..., 3): 0 in the planet's shadow.

    `radius` is the points' distance from the planet's centre [km], `cosine` the cosine of the sun's zenith angle there.
    """
    distance, toward = _distance_out(radius, cosine).reshape(-1), (2.0 * radius * cosine).reshape(-1)
    along = _SUN_MIDDLES[:, None] * distance
    height = along + toward
    height *= along
    height += (radius * radius).reshape(-1)
    height = np.maximum(np.sqrt(height, out=height) - GROUND, 0.0, out=height)
    columns = np.empty((len(distance), 3))
    for column, scale in enumerate((MOLECULES_SCALE, HAZE_SCALE)):
        columns[:, column] = _SUN_LENGTHS @ np.exp(np.divide(height, -scale, out=along), out=along)
    height -= OZONE_MIDDLE
    ozone = np.abs(height, out=height)
    ozone /= -OZONE_HALF
    ozone += 1.0
    columns[:, 2] = _SUN_LENGTHS @ np.maximum(ozone, 0.0, out=ozone)
    extinction = np.stack(
        [MOLECULES, np.full(3, (HAZE_SCATTERING + HAZE_ABSORPTION) * _haze_density(turbidity)), OZONE]
    )
    grazing = np.sqrt(np.maximum(1.0 - (GROUND / radius) ** 2, 0.0))
    visible = np.clip((cosine + grazing) / 0.0093 + 0.5, 0.0, 1.0)  # part of the sun's disc above the horizon
    return np.asarray(np.exp(columns @ extinction * -distance[:, None]).reshape(*radius.shape, 3) * visible[..., None])


def sky_radiance(
    sine: Doubles,
    cosine: Doubles,
    sun_sine: float,
    turbidity: float,
    /,
    *,
    multiple: Doubles | None = None,
    eye: Doubles | float = EYE,
) -> Doubles:
    """Return the radiance of the atmosphere for a solar irradiance of 1, shape (r, c, 3).

    All lines of sight in a row have one elevation. `sine` (r,) holds the sines of these elevations, `sun_sine` is the
    sine of the sun's, and `cosine` (r, c) holds the cosines of the angles between sun and lines of sight. `eye` is the
    radius [km] of the eye, one or (r,). `multiple` is what `multiple_scattering` returns for `HEIGHTS`; without it
    light is scattered only once.
    """
    eye = np.broadcast_to(eye, sine.shape)
    ray = _rays(eye.tobytes(), sine.tobytes(), turbidity)
    sun_cosine = (ray.along[:, None] * cosine[..., None] + (eye * sun_sine)[:, None, None]) / ray.radius[:, None]
    light = sunlight(np.broadcast_to(ray.radius[:, None], sun_cosine.shape), sun_cosine, turbidity)
    molecules = 3.0 / (16.0 * np.pi) * (1.0 + cosine**2)[..., None] * np.einsum("rcsk,rsk->rck", light, ray.molecules)
    light = molecules + _haze_phase(cosine)[..., None] * np.einsum("rcsk,rsk->rck", light, ray.haze)
    if multiple is not None:
        light += ((ray.molecules + ray.haze) * _at_radius(multiple, ray.radius)).sum(axis=1)[:, None]
    return np.asarray(light)


def multiple_scattering(sun: Doubles, turbidity: float, /, *, heights: Doubles) -> Doubles:
    """Return the radiance at `heights` [km], averaged over all directions, with multiple scattering, shape (h, 3).

    `sun` is the direction to the sun. Light scattered once, or reflected by the ground, continues as a geometric
    series.
    """
    direction, radius = np.tile(_sphere(DIRECTIONS), (len(heights), 1)), np.repeat(GROUND + heights, DIRECTIONS)
    sine, cosine = direction[:, 1], (direction @ sun)[:, None]
    single = sky_radiance(sine, cosine, float(sun[1]), turbidity, eye=radius)[:, 0]
    reflected = (sine < -np.sqrt(1.0 - (GROUND / radius) ** 2))[:, None] * GROUND_ALBEDO
    ground = sunlight(np.array([GROUND + 0.01]), np.array([sun[1]]), turbidity)[0] * max(sun[1], 0.0)
    ray = _rays(radius.tobytes(), sine.tobytes(), turbidity)
    gain = (ray.molecules + ray.haze).sum(axis=1) + reflected
    source, factor = (
        each.reshape(-1, DIRECTIONS, 3).mean(axis=1) for each in (single + reflected * ground / np.pi, gain)
    )
    return np.asarray(source / (1.0 - np.minimum(factor, 0.9)))


@dataclass(frozen=True, slots=True, eq=False)
class _Ray:
    """Lines of sight in `STEPS` segments: arrays of shape (n, STEPS) or (n, STEPS, 3)."""

    along: Doubles
    """Distances of the segments' middles from the eye [km]."""

    radius: Doubles
    """Radii of the segments' middles [km]."""

    molecules: Doubles
    """Radiance seen from a segment's molecules under isotropic light of radiance 1, scattered isotropically."""

    haze: Doubles
    """Radiance seen from a segment's haze, under the same light."""


@lru_cache(maxsize=40)  # enough for all rows and heights of one sky; rays do not depend on the sun
def _rays(eye: bytes, sine: bytes, turbidity: float) -> _Ray:
    """Return lines of sight from radii `eye` (n,) [km], with sines of elevation `sine` (n,); both are float64 bytes."""
    return _ray(np.frombuffer(eye), np.frombuffer(sine), turbidity)


def _ray(eye: Doubles, sine: Doubles, turbidity: float) -> _Ray:
    """Return lines of sight, as `_rays` does, from arrays."""
    distance, edge = _ray_length(eye, sine), (np.arange(STEPS + 1) / STEPS) ** 2
    along, length = 0.5 * (edge[1:] + edge[:-1]) * distance[:, None], (np.diff(edge) * distance[:, None])[..., None]
    radius = np.sqrt((eye**2)[:, None] + along * (along + (2.0 * eye * sine)[:, None]))
    height = np.maximum(radius - GROUND, 0.0)[..., None]
    molecules = np.exp(height / -MOLECULES_SCALE) * MOLECULES
    haze = np.exp(height / -HAZE_SCALE) * (HAZE_SCATTERING * _haze_density(turbidity))
    ozone = np.maximum(1.0 - np.abs(height - OZONE_MIDDLE) / OZONE_HALF, 0.0) * OZONE
    extinction = molecules + haze * (1.0 + HAZE_ABSORPTION / HAZE_SCATTERING) + ozone
    depth = extinction * length
    transmittance = np.exp(depth - np.cumsum(depth, axis=1))
    emission = transmittance * (1.0 - np.exp(-depth)) / extinction
    return _Ray(along, radius, molecules * emission, haze * emission)


def _ray_length(radius: Doubles, cosine: Doubles) -> Doubles:
    """Return the lengths of lines of sight from radii, to the ground or the top of the atmosphere [km]."""
    inner = radius**2 * (cosine**2 - 1.0) + GROUND**2
    ground = np.where((inner > 0.0) & (cosine < 0.0), -radius * cosine - np.sqrt(np.maximum(inner, 0.0)), np.inf)
    return np.asarray(np.minimum(ground, _distance_out(radius, cosine)))


def _haze_phase(cosine: Doubles) -> Doubles:
    """Return the haze's phase function by the cosine of the scattering angle (Cornette and Shanks, 1992)."""
    g = FORWARD
    top = 3.0 * (1.0 - g * g) * (1.0 + cosine**2)
    return np.asarray(top / (8.0 * np.pi * (2.0 + g * g) * (1.0 + g * g - 2.0 * g * cosine) ** 1.5))


def _at_radius(table: Doubles, radius: Doubles) -> Doubles:
    """Return a table over `HEIGHTS`, interpolated at radii (...) [km], shape (..., 3)."""
    row = np.sqrt(np.clip((radius - GROUND) / HIGHEST, 0.0, 1.0)) * (len(table) - 1)
    low = np.minimum(row.astype(np.int64), len(table) - 2)
    part = (row - low)[..., None]
    return np.asarray(table[low] * (1.0 - part) + table[low + 1] * part)


def _sphere(count: int) -> Doubles:
    """Return directions spread evenly over the sphere, shape (count, 3)."""
    up = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.arange(count) * (np.pi * (3.0 - np.sqrt(5.0)))
    level = np.sqrt(1.0 - up * up)
    return np.stack([level * np.cos(turn), up, level * np.sin(turn)], axis=1)
