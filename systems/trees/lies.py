"""How the leaves of a twig lie, told in few directions."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles

AROUND, TILTS = 5, 2
"""Directions around the middle of a card, and how steep ones there are: an odd number around tells sides as finely as
twice as many, as leaves are seen from either side."""

LIES = AROUND * TILTS
"""Directions in all."""

SHOWN = 128
"""Coverage from which on a texel tells how a leaf lies, of 255: fainter ones have it in too few bits."""

STEEPEST = 0.2
"""Part of a leaf that is seen at least, where it stands nearly edge-on: one texel is not to count for all."""

GLSL = {"LIES": LIES}


Lies = list[tuple[float, float, float, float]]
"""Directions, and the part of the leaf area that faces each."""

TURNS = 4
"""Ways around a twig of needles that its card may lie, which turns to the eye."""


def lies_of(picture: Bytes, /) -> Lies:
    """Return directions that a twig's leaves face on its card (across, along, out), and the part of its leaf area each.

    `picture` (2, n, n, 4) is that of a card, as `smaller` returns it.
    """
    texels = picture.astype(np.float64).reshape(2, -1, 4)
    own = texels[1, texels[0, :, 3] >= SHOWN]
    normal = 2.0 * own[:, :3] - own[:, 3:]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1.0)
    return _few(normal, 1.0 / np.maximum(normal[:, 2], STEEPEST))  # of what is seen of it


def lies_on(twigs: NDArray[np.void], card: Lies, /, *, turn: bool) -> Lies:
    """Return directions that all leaves of a tree face, and the part of its leaf area each: those of its cards.

    `twigs` are records of `TWIG`, and `card` is what `lies_of` returns of their card. Cards that `turn` lie any way
    around their twigs.
    """
    along, face = twigs["along"].astype(np.float64), twigs["face"].astype(np.float64)
    aside, told = np.cross(along, face), np.array(card)
    normal = list[Doubles]()
    for around in np.pi * np.arange(TURNS if turn else 1) / TURNS:
        across, out = np.cos(around) * aside - np.sin(around) * face, np.sin(around) * aside + np.cos(around) * face
        own = told[:, 0, None, None] * across + told[:, 1, None, None] * along + told[:, 2, None, None] * out
        normal.append(own.reshape(-1, 3))
    every = np.concatenate(normal)[:, [0, 2, 1]]
    every[every[:, 2] < 0.0] *= -1.0  # a leaf has two sides
    area = told[:, 3, None] * twigs["span"].astype(np.float64) ** 2
    return [(x, up, z, share) for x, z, up, share in _few(every, np.tile(area.ravel(), len(normal)))]


def _few(normal: Doubles, area: Doubles) -> Lies:
    """Return few directions for many (n, 3), whose areas are so large (n,), and the part of the area each.

    They are parted by where they face around the third axis, and those of each part halved by how steep they are.
    """
    part = ((np.arctan2(normal[:, 1], normal[:, 0]) / (2.0 * np.pi) + 0.5) * AROUND).astype(np.intp) % AROUND
    found = np.zeros((LIES, 4))
    found[:, 2] = 1.0
    for number in range(AROUND):
        inside = np.flatnonzero(part == number)
        steep = inside[np.argsort(normal[inside, 2])]
        halves = np.searchsorted(np.cumsum(area[steep]), 0.5 * area[steep].sum())
        for tilt, some in enumerate((steep[:halves], steep[halves:])):
            if len(some):
                found[TILTS * number + tilt] = *_mean(normal[some], area[some]), area[some].sum()
    whole = found[:, 3].sum()
    found[:, 3] /= whole if whole > 0.0 else 1.0
    return [(x, y, z, share) for x, y, z, share in found.tolist()]


def _mean(normal: Doubles, area: Doubles) -> Doubles:
    """Return the mean (3,) of directions that faces (n, 3) have: out of the card where they have none.

    Where they differ it is shorter than 1, as less of them is seen from there, and less light falls on them.
    """
    mean = (normal * area[:, None]).sum(axis=0)
    return np.asarray(mean / area.sum() if np.linalg.norm(mean) > 0.0 else (0.0, 0.0, 1.0))
