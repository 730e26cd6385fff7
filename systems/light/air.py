"""The air of a planet: what it takes of the sun's light, and what it scatters to the eye.

Molecules, haze and ozone in layers around a sphere; light that is scattered once is integrated along the line of sight,
what is scattered again and again is taken as even in all directions (Hillaire, A Scalable and Production Ready Sky and
Atmosphere Rendering Technique, 2020).
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...components.arrays import Doubles

GROUND, TOP = 6360.0, 6460.0
"""Radii of the planet and of its air [km]."""

MOLECULES = np.array([5.802, 13.558, 33.1]) * 1e-3
"""What molecules scatter at sea level, red, green and blue [1/km]; they thin out over 8 km."""

HAZE, HAZE_TAKES = 3.996e-3, 4.40e-3
"""What haze scatters, and takes altogether beyond that, at sea level [1/km]; it thins out over 1.2 km."""

OZONE = np.array([0.650, 1.881, 0.085]) * 1e-3
"""What ozone takes at a height of 25 km [1/km]; it is gone 15 km above and below."""

FORWARD = 0.8
"""How much haze scatters forwards, from -1 for backwards to 1."""

USUAL = 2.6
"""The turbidity at which there is as much haze as `HAZE` says."""

GROUND_RETURNS = 0.25
"""The part of the light that the ground sends back."""

STEPS, TO_SUN, AROUND = 24, 12, 48
"""Points along a line of sight and along the way to the sun; directions to take the mean of all light."""

_MIDDLES = ((np.arange(TO_SUN) + 0.5) / TO_SUN) ** 2
_LENGTHS = (2.0 * np.arange(TO_SUN) + 1.0) / TO_SUN**2

HIGHEST = 60.0
"""Up to where light from all sides is made out [km]."""

HEIGHTS = 0.01 + HIGHEST * (np.arange(10) / 9.0) ** 2
"""The heights at which it is [km]."""

EYE = GROUND + 0.2
"""Where the sky is looked at from [km]."""


def _thick(turbidity: float) -> float:
    """Return how much haze there is, of the usual."""
    return (turbidity - 1.0) / (USUAL - 1.0)


def _way_out(radius: Doubles, cosine: Doubles) -> Doubles:
    """Return the length of the way out of the air [km] from a radius, at a cosine to the zenith."""
    return np.asarray(-radius * cosine + np.sqrt(np.maximum(radius**2 * (cosine**2 - 1.0) + TOP**2, 0.0)))


def sunlight(radius: Doubles, cosine: Doubles, turbidity: float, /) -> Doubles:
    """Return the part of the sun's light that reaches points in the air, shape (..., 3).

    `radius` [km] says how high they are, `cosine` how high the sun stands over each; in the planet's shadow it is 0.
    """
    way, toward = _way_out(radius, cosine).reshape(-1), (2.0 * radius * cosine).reshape(-1)
    along = _MIDDLES[:, None] * way
    height = along + toward
    height *= along
    height += (radius * radius).reshape(-1)
    height = np.maximum(np.sqrt(height, out=height) - GROUND, 0.0, out=height)
    met = np.empty((len(way), 3))
    for column, scale in enumerate((8.0, 1.2)):
        met[:, column] = _LENGTHS @ np.exp(np.divide(height, -scale, out=along), out=along)
    height -= 25.0
    ozone = np.abs(height, out=height)
    ozone /= -15.0
    ozone += 1.0
    met[:, 2] = _LENGTHS @ np.maximum(ozone, 0.0, out=ozone)
    takes = np.stack([MOLECULES, np.full(3, (HAZE + HAZE_TAKES) * _thick(turbidity)), OZONE])
    grazing = np.sqrt(np.maximum(1.0 - (GROUND / radius) ** 2, 0.0))
    lit = np.clip((cosine + grazing) / 0.0093 + 0.5, 0.0, 1.0)  # the sun's disc sets
    return np.asarray(np.exp(met @ takes * -way[:, None]).reshape(*radius.shape, 3) * lit[..., None])


def seen_in_rows(
    up: Doubles,
    apart: Doubles,
    high: float,
    turbidity: float,
    /,
    *,
    around: Doubles | None = None,
    eye: Doubles | float = EYE,
) -> Doubles:
    """Return the radiance of the air along lines of sight in rows, for sunlight of irradiance 1, shape (r, c, 3).

    Each row is of one elevation. `up` (r,) are the sines of these, `high` is that of the sun's, and `apart` (r, c) are
    the cosines of the angles between the two. All are seen from one radius `eye`, or each row from its own, (r,) [km].
    `around` is what comes from all sides to `HEIGHTS`, as `from_all_sides` has it; without it light is scattered but
    once.
    """
    eye = np.broadcast_to(eye, up.shape)
    ray = _rays(eye.tobytes(), up.tobytes(), turbidity)
    above = (ray.along[:, None] * apart[..., None] + (eye * high)[:, None, None]) / ray.radius[:, None]
    light = sunlight(np.broadcast_to(ray.radius[:, None], above.shape), above, turbidity)
    molecules = 3.0 / (16.0 * np.pi) * (1.0 + apart**2)[..., None] * np.einsum("rcsk,rsk->rck", light, ray.molecules)
    light = molecules + _forwards(apart)[..., None] * np.einsum("rcsk,rsk->rck", light, ray.haze)
    if around is not None:
        light += ((ray.molecules + ray.haze) * _by_height(around, ray.radius)).sum(axis=1)[:, None]
    return np.asarray(light)


def from_all_sides(sun: Doubles, turbidity: float, /, *, heights: Doubles = HEIGHTS) -> Doubles:
    """Return the mean radiance that comes from all sides to some heights, scattered any number of times, shape (h, 3).

    What has been scattered once, and sent back by the ground, goes on as a geometric series.
    """
    direction, radius = np.tile(_sphere(AROUND), (len(heights), 1)), np.repeat(GROUND + heights, AROUND)
    up, apart = direction[:, 1], (direction @ sun)[:, None]
    once = seen_in_rows(up, apart, float(sun[1]), turbidity, eye=radius)[:, 0]
    down = (up < -np.sqrt(1.0 - (GROUND / radius) ** 2))[:, None] * GROUND_RETURNS
    ground = sunlight(np.array([GROUND + 0.01]), np.array([sun[1]]), turbidity)[0] * max(sun[1], 0.0)
    ray = _rays(radius.tobytes(), up.tobytes(), turbidity)
    again = (ray.molecules + ray.haze).sum(axis=1) + down
    first, then = (each.reshape(-1, AROUND, 3).mean(axis=1) for each in (once + down * ground / np.pi, again))
    return np.asarray(first / (1.0 - np.minimum(then, 0.9)))


@dataclass(frozen=True, slots=True, eq=False)
class _Ray:
    """Lines of sight, cut into `STEPS` pieces, (n, STEPS) or (n, STEPS, 3) each."""

    along: Doubles
    """How far the middles of the pieces are [km]."""

    radius: Doubles
    """How high they are [km]."""

    molecules: Doubles
    """What is seen of light of radiance 1 that falls on the molecules there, and is scattered evenly."""

    haze: Doubles
    """The same of the haze there."""


@lru_cache(maxsize=40)  # all that a sky is made of: they are the same wherever the sun goes
def _rays(eye: bytes, up: bytes, turbidity: float) -> _Ray:
    """Return lines of sight from radii (n,), by the sines of their elevations (n,)."""
    return _ray(np.frombuffer(eye), np.frombuffer(up), turbidity)


def _ray(eye: Doubles, up: Doubles, turbidity: float) -> _Ray:
    way, edge = _reach(eye, up), (np.arange(STEPS + 1) / STEPS) ** 2
    along, length = 0.5 * (edge[1:] + edge[:-1]) * way[:, None], (np.diff(edge) * way[:, None])[..., None]
    radius = np.sqrt((eye**2)[:, None] + along * (along + (2.0 * eye * up)[:, None]))
    height = np.maximum(radius - GROUND, 0.0)[..., None]
    molecules, haze = np.exp(height / -8.0) * MOLECULES, np.exp(height / -1.2) * (HAZE * _thick(turbidity))
    takes = molecules + haze * (1.0 + HAZE_TAKES / HAZE) + np.maximum(1.0 - np.abs(height - 25.0) / 15.0, 0.0) * OZONE
    depth = takes * length
    before = np.exp(depth - np.cumsum(depth, axis=1))
    shows = before * (1.0 - np.exp(-depth)) / takes
    return _Ray(along, radius, molecules * shows, haze * shows)


def _reach(radius: Doubles, cosine: Doubles) -> Doubles:
    """Return how far lines of sight go from radii: to the ground, or out of the air [km]."""
    inner = radius**2 * (cosine**2 - 1.0) + GROUND**2
    ground = np.where((inner > 0.0) & (cosine < 0.0), -radius * cosine - np.sqrt(np.maximum(inner, 0.0)), np.inf)
    return np.asarray(np.minimum(ground, _way_out(radius, cosine)))


def _forwards(apart: Doubles) -> Doubles:
    """Return how haze scatters by the cosine of the angle (Cornette and Shanks, 1992)."""
    g = FORWARD
    top = 3.0 * (1.0 - g * g) * (1.0 + apart**2)
    return np.asarray(top / (8.0 * np.pi * (2.0 + g * g) * (1.0 + g * g - 2.0 * g * apart) ** 1.5))


def _by_height(table: Doubles, radius: Doubles) -> Doubles:
    """Return what stands in a table over heights, shape (..., 3)."""
    row = np.sqrt(np.clip((radius - GROUND) / HIGHEST, 0.0, 1.0)) * (len(table) - 1)
    low = np.minimum(row.astype(np.int64), len(table) - 2)
    part = (row - low)[..., None]
    return np.asarray(table[low] * (1.0 - part) + table[low + 1] * part)


def _sphere(count: int) -> Doubles:
    """Return evenly spread directions, shape (count, 3)."""
    up = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.arange(count) * (np.pi * (3.0 - np.sqrt(5.0)))
    level = np.sqrt(1.0 - up * up)
    return np.stack([level * np.cos(turn), up, level * np.sin(turn)], axis=1)
