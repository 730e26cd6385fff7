"""Normals of leaves, clustered into a few directions."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles

AZIMUTHS, TILTS = 5, 2
"""Clusters around the normal of a card, and tilts of each: an odd number around distinguishes sides as finely as twice
as many, as leaves are seen from both sides."""

NORMALS = AZIMUTHS * TILTS
"""Number of clusters."""

LEAST_COVER = 128
"""Coverage from which on a texel's normal counts, of 255: fainter ones have too few bits of it."""

LEAST_FACING = 0.2
"""Least facing of a leaf in its area's estimate: one texel edge-on must not count for all."""

LEAST_AREA = 1e-3
"""Part of the leaf area added to that in a picture, as that is a divisor."""

GLSL = {"NORMALS": NORMALS}


Normals = list[tuple[float, float, float, float]]
"""Mean normals, and the share of the leaf area that each stands for."""

CARD_TURNS = 4
"""Angles around a twig of needles that its card is sampled at, as it turns to the eye."""


def card_normals(picture: Bytes, /) -> Normals:
    """Return the normals of a twig's leaves on its card (across, along, out), and the share of area of each.

    `picture` (2, n, n, 4) is that of a card, as `mip_levels` returns it.
    """
    texels = picture.astype(np.float64).reshape(2, -1, 4)
    texel = texels[1, texels[0, :, 3] >= LEAST_COVER]
    normal = 2.0 * texel[:, :3] - texel[:, 3:]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1.0)
    return _clustered(normal, 1.0 / np.maximum(normal[:, 2], LEAST_FACING))  # from the area that is seen


def tree_normals(twigs: NDArray[np.void], card: Normals, /, *, turn: bool) -> Normals:
    """Return the normals of all leaves of a tree (x, y, z), and the share of area of each.

    `twigs` are records of `TWIG`, and `card` the result of `card_normals`. Cards that `turn` lie at any angle around
    their twigs.
    """
    along, face = twigs["along"].astype(np.float64), twigs["face"].astype(np.float64)
    aside, card_values = np.cross(along, face), np.array(card)
    normal = list[Doubles]()
    for around in np.pi * np.arange(CARD_TURNS if turn else 1) / CARD_TURNS:
        across, out = np.cos(around) * aside - np.sin(around) * face, np.sin(around) * aside + np.cos(around) * face
        direction = (
            card_values[:, 0, None, None] * across
            + card_values[:, 1, None, None] * along
            + card_values[:, 2, None, None] * out
        )
        normal.append(direction.reshape(-1, 3))
    normals_of_twigs = np.concatenate(normal)[:, [0, 2, 1]]
    normals_of_twigs[normals_of_twigs[:, 2] < 0.0] *= -1.0  # a leaf has two sides
    area = card_values[:, 3, None] * twigs["span"].astype(np.float64) ** 2
    return [(x, up, z, share) for x, z, up, share in _clustered(normals_of_twigs, np.tile(area.ravel(), len(normal)))]


def pictured(normals: Normals, /) -> tuple[float, ...]:
    """Return the mean of normals in a picture that looks along the third axis, and their area there."""
    each = np.array(normals).reshape(-1, 4)
    part = each[:, 3] * each[:, 2]
    area = LEAST_AREA + float(part.sum())
    return *(part @ each[:, :3] / area).tolist(), area


def _clustered(normal: Doubles, area: Doubles) -> Normals:
    """Return mean normals of clusters of normals (n, 3) with areas (n,), and the share of area of each.

    Normals are divided by azimuth about the third axis, and each part is halved by tilt.
    """
    part = ((np.arctan2(normal[:, 1], normal[:, 0]) / (2.0 * np.pi) + 0.5) * AZIMUTHS).astype(np.intp) % AZIMUTHS
    clusters = np.zeros((NORMALS, 4))
    clusters[:, 2] = 1.0
    for number in range(AZIMUTHS):
        inside = np.flatnonzero(part == number)
        steep = inside[np.argsort(normal[inside, 2])]
        halves = np.searchsorted(np.cumsum(area[steep]), 0.5 * area[steep].sum())
        for tilt, half in enumerate((steep[:halves], steep[halves:])):
            if len(half):
                clusters[TILTS * number + tilt] = *_mean(normal[half], area[half]), area[half].sum()
    whole = clusters[:, 3].sum()
    clusters[:, 3] /= whole if whole > 0.0 else 1.0
    return [(x, y, z, share) for x, y, z, share in clusters.tolist()]


def _mean(normal: Doubles, area: Doubles) -> Doubles:
    """Return the mean (3,) of normals (n, 3), weighted by area: out of the card where there is none.

    It is shorter than 1 where they differ: less of the leaves is seen from there, and less light falls on them.
    """
    mean = (normal * area[:, None]).sum(axis=0)
    return np.asarray(mean / area.sum() if np.linalg.norm(mean) > 0.0 else (0.0, 0.0, 1.0))
