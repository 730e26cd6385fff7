"""Normals of leaves, clustered into a few directions."""

import sys

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles, Indices

AZIMUTHS, TILTS = 5, 2
"""Clusters around the normal of a card, and tilts of each: an odd number around distinguishes sides as finely as twice
as many, as leaves are seen from both sides."""

NORMALS = AZIMUTHS * TILTS
"""Number of clusters of a card."""

SIDES = 2
"""Sides of a tree whose leaves are clustered apart: of leaves that lie alike, near ones hide those on the far side."""

TREE_NORMALS = SIDES * NORMALS
"""Number of clusters of a tree."""

UPWARD = 1e-6
"""Upward part added to the direction out of a crown: in the very middle, where there is none, it decides."""

LEAST_COVER = 128
"""Least coverage, of 255, of a texel whose normal counts: fainter texels store it in too few bits."""

LEAST_FACING = 0.2
"""Least facing of a leaf in its area's estimate: one texel edge-on must not count for all."""

LEAST_AREA = 1e-3
"""Part of the leaf area added to the area seen in a picture, by which normals are divided."""

GLSL = {"NORMALS": NORMALS, "TREE_NORMALS": TREE_NORMALS}


Normals = list[tuple[float, float, float, float]]
"""Mean normals, and the share of the leaf area that each stands for."""

Depths = list[tuple[float, float, float, float]]
"""Mean optical depths outwards of the leaves of each cluster, as `crown.shading` returns them."""

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
    area = 1.0 / np.maximum(normal[:, 2], LEAST_FACING)  # from the area that is seen
    return _means(normal, area, _clusters(normal, area, TILTS))


def tree_normals(twigs: NDArray[np.void], card: Normals, /, *, turn: bool) -> tuple[Normals, Depths]:
    """Return the normals of all leaves of a tree (x, y, z), the share of area of each, and their optical depths.

    Normals are those of the sides that face out of the crown. `twigs` are records of `TWIG`, and `card` the result of
    `card_normals`. Cards that `turn` lie at any angle around their twigs.
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
    leaves, copies = np.concatenate(normal), len(card_values) * len(normal)
    depths = np.tile(twigs["shading"].astype(np.float64), (copies, 1))
    leaves[np.einsum("ij,ij->i", leaves, (0.0, UPWARD, 0.0) - depths[:, :3]) < 0.0] *= -1.0  # a leaf has two sides
    area = np.tile((card_values[:, 3, None] * twigs["span"].astype(np.float64) ** 2).ravel(), len(normal))
    clusters = _clusters(leaves[:, [0, 2, 1]], area, SIDES * TILTS)
    means = [(x, up, z, share) for x, z, up, share in _means(leaves[:, [0, 2, 1]], area, clusters)]
    return means, [tuple(_mean_of(depths[each], area[each]).tolist()) for each in clusters]


def pictured(normals: Normals, /) -> tuple[float, ...]:
    """Return the mean of normals in a picture that looks along the third axis, and their area there."""
    each = np.array(normals).reshape(-1, 4)
    part = each[:, 3] * each[:, 2]
    area = LEAST_AREA + float(part.sum())
    return *(part @ each[:, :3] / area).tolist(), area


def _clusters(normal: Doubles, area: Doubles, tilts: int) -> list[Indices]:
    """Return the indices in each cluster of normals (n, 3) with areas (n,).

    Normals are divided by azimuth about the third axis, and each part by tilt, into parts of the same area.
    """
    part = ((np.arctan2(normal[:, 1], normal[:, 0]) / (2.0 * np.pi) + 0.5) * AZIMUTHS).astype(np.intp) % AZIMUTHS
    clusters = list[Indices]()
    for number in range(AZIMUTHS):
        inside = np.flatnonzero(part == number)
        steep = inside[np.argsort(normal[inside, 2])]
        limits = area[steep].sum() * np.arange(1, tilts) / tilts
        clusters += np.split(steep, np.searchsorted(np.cumsum(area[steep]), limits))
    return clusters


def _means(normal: Doubles, area: Doubles, clusters: list[Indices]) -> Normals:
    """Return the mean direction of each cluster, and its share of the area.

    It is a unit vector, however much its normals differ: the light seen on leaves goes by the product of two cosines,
    and a shorter mean would lessen both.
    """
    whole, means = max(float(area.sum()), LEAST_AREA), Normals()
    for each in clusters:
        mean = _mean_of(normal[each], area[each])
        length = float(np.linalg.norm(mean))
        x, y, z = (mean / length if length > 0.0 else np.array([0.0, 0.0, 1.0])).tolist()
        means.append((x, y, z, float(area[each].sum()) / whole))
    return means


def _mean_of(values: Doubles, area: Doubles) -> Doubles:
    """Return the mean of values (n, k), weighted by area: 0 of none."""
    return np.asarray((values * area[:, None]).sum(axis=0) / max(float(area.sum()), sys.float_info.min))
