"""The air of a planet: what it takes of the sun's light, and what it scatters to the eye.

Molecules, haze and ozone in layers around a sphere; light that is scattered once is integrated along the line of sight,
what is scattered again and again is taken as even in all directions (Hillaire, A Scalable and Production Ready Sky and
Atmosphere Rendering Technique, 2020).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]

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

STEPS, TO_SUN, AROUND, HEIGHTS = 24, 12, 48, 10
"""Points along a line of sight and along the way to the sun; directions, and heights, to take the mean of all light."""

EYE = GROUND + 0.2
"""Where the sky is looked at from [km]."""


@dataclass(frozen=True, slots=True, eq=False)
class _Matter:
    """What there is at some heights, each (..., 3) or (..., 1) [1/km]."""

    molecules: Doubles
    haze: Doubles
    takes: Doubles


def _matter(radius: Doubles, turbidity: float) -> _Matter:
    height = np.maximum(radius - GROUND, 0.0)[..., None]
    thick = (turbidity - 1.0) / (USUAL - 1.0)
    molecules = np.exp(-height / 8.0) * MOLECULES
    haze = np.exp(-height / 1.2) * HAZE * thick
    ozone = np.maximum(1.0 - np.abs(height - 25.0) / 15.0, 0.0) * OZONE
    return _Matter(molecules, haze, molecules + haze * (1.0 + HAZE_TAKES / HAZE) + ozone)


def _way_out(radius: Doubles, cosine: Doubles) -> Doubles:
    """Return the length of the way out of the air [km] from a radius, at a cosine to the zenith."""
    return np.asarray(-radius * cosine + np.sqrt(np.maximum(radius**2 * (cosine**2 - 1.0) + TOP**2, 0.0)))


def sunlight(radius: Doubles, cosine: Doubles, turbidity: float, /) -> Doubles:
    """Return the part of the sun's light that reaches points in the air, shape (..., 3).

    `radius` [km] says how high they are, `cosine` how high the sun stands over each; in the planet's shadow it is 0.
    """
    way = _way_out(radius, cosine)
    depth = np.zeros((*radius.shape, 3))
    for step in range(TO_SUN):
        part, along = 2.0 * (step + 0.5) / TO_SUN**2, way * ((step + 0.5) / TO_SUN) ** 2
        at = np.sqrt(radius**2 + along**2 + 2.0 * radius * cosine * along)
        depth += _matter(at, turbidity).takes * (way * part)[..., None]
    grazing = np.sqrt(np.maximum(1.0 - (GROUND / radius) ** 2, 0.0))
    lit = np.clip((cosine + grazing) / 0.0093 + 0.5, 0.0, 1.0)  # the sun's disc sets
    return np.asarray(np.exp(-depth) * lit[..., None])


def seen(
    direction: Doubles, sun: Doubles, turbidity: float, /, *, around: Doubles | None = None, eye: float = EYE
) -> Doubles:
    """Return the radiance of the air along directions (n, 3), for sunlight of irradiance 1, shape (n, 3).

    `sun` is the direction to it (3,). `around` is what comes from all sides to `HEIGHTS` heights, as `from_all_sides`
    has it; without it light is scattered but once.
    """
    up, apart = direction[:, 1], direction @ sun
    way = _reach(eye, up)
    edge = (np.arange(STEPS + 1) / STEPS) ** 2
    middle, length = 0.5 * (edge[1:] + edge[:-1]) * way[:, None], np.diff(edge) * way[:, None]
    place = direction[:, None] * middle[..., None] + np.array([0.0, eye, 0.0])
    radius = np.linalg.norm(place, axis=-1)
    matter = _matter(radius, turbidity)
    light = sunlight(radius, (place @ sun) / radius, turbidity)
    molecules, haze = 3.0 / (16.0 * np.pi) * (1.0 + apart**2), _forwards(apart)
    source = light * (matter.molecules * molecules[:, None, None] + matter.haze * haze[:, None, None])
    if around is not None:
        source = source + (matter.molecules + matter.haze) * _by_height(around, radius)
    kept = np.exp(-matter.takes * length[..., None])
    before = np.cumprod(kept, axis=1) / kept
    return np.asarray((before * source * (1.0 - kept) / matter.takes).sum(axis=1))


def from_all_sides(sun: Doubles, turbidity: float, /) -> Doubles:
    """Return the mean radiance that comes from all sides to `HEIGHTS` heights, scattered any number of times, (h, 3).

    What has been scattered once, and sent back by the ground, goes on as a geometric series.
    """
    direction = _sphere(AROUND)
    height = (np.arange(HEIGHTS) / (HEIGHTS - 1.0)) ** 2 * 60.0
    rows = []
    for radius in GROUND + 0.01 + height:
        once = seen(direction, sun, turbidity, eye=radius)
        down = direction[:, 1] < -np.sqrt(1.0 - (GROUND / radius) ** 2)
        ground = sunlight(np.array([GROUND + 0.01]), np.array([sun[1]]), turbidity)[0] * max(sun[1], 0.0)
        once = once + down[:, None] * GROUND_RETURNS / np.pi * ground
        again = _lit_evenly(direction, radius, turbidity) + down[:, None] * GROUND_RETURNS
        rows.append(once.mean(axis=0) / (1.0 - np.minimum(again.mean(axis=0), 0.9)))
    return np.stack(rows)


def _lit_evenly(direction: Doubles, radius: float, turbidity: float) -> Doubles:
    """Return what air that is lit by 1 from all sides sends along directions, shape (n, 3)."""
    way = _reach(radius, direction[:, 1])
    edge = (np.arange(STEPS + 1) / STEPS) ** 2
    middle, length = 0.5 * (edge[1:] + edge[:-1]) * way[:, None], np.diff(edge) * way[:, None]
    at = np.sqrt(radius**2 + middle**2 + 2.0 * radius * direction[:, 1:2] * middle)
    matter = _matter(at, turbidity)
    kept = np.exp(-matter.takes * length[..., None])
    before = np.cumprod(kept, axis=1) / kept
    return np.asarray((before * (matter.molecules + matter.haze) * (1.0 - kept) / matter.takes).sum(axis=1))


def _reach(radius: float, cosine: Doubles) -> Doubles:
    """Return how far a line of sight goes from a radius: to the ground, or out of the air [km]."""
    inner = radius**2 * (cosine**2 - 1.0) + GROUND**2
    ground = np.where((inner > 0.0) & (cosine < 0.0), -radius * cosine - np.sqrt(np.maximum(inner, 0.0)), np.inf)
    return np.asarray(np.minimum(ground, _way_out(np.full_like(cosine, radius), cosine)))


def _forwards(apart: Doubles) -> Doubles:
    """Return how haze scatters by the cosine of the angle (Cornette and Shanks, 1992)."""
    g = FORWARD
    top = 3.0 * (1.0 - g * g) * (1.0 + apart**2)
    return np.asarray(top / (8.0 * np.pi * (2.0 + g * g) * (1.0 + g * g - 2.0 * g * apart) ** 1.5))


def _by_height(table: Doubles, radius: Doubles) -> Doubles:
    """Return what stands in a table over heights, shape (..., 3)."""
    row = np.sqrt(np.clip((radius - GROUND) / 60.0, 0.0, 1.0)) * (len(table) - 1)
    low = np.minimum(row.astype(np.int64), len(table) - 2)
    part = (row - low)[..., None]
    return np.asarray(table[low] * (1.0 - part) + table[low + 1] * part)


def _sphere(count: int) -> Doubles:
    """Return evenly spread directions, shape (count, 3)."""
    up = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.arange(count) * (np.pi * (3.0 - np.sqrt(5.0)))
    level = np.sqrt(1.0 - up * up)
    return np.stack([level * np.cos(turn), up, level * np.sin(turn)], axis=1)
