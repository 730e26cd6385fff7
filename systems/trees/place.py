"""Places of a kind's single trees: given positions, and rows."""

from collections.abc import Sequence

import numpy as np

from ...components.arrays import Floats, Mask
from ...engine.declared.tree import MOST, TreeKind
from ...engine.terrain.record import Terrain
from ...engine.terrain.sample import hole_at

JITTER, MOST_JITTER = 0.3, 0.4
"""Greatest sideways offset of trees in an uneven row: relative to their distance, and in all [m]."""

MISSING = 0.125
"""Share of trees missing in a row as uneven as can be."""

LEAST_APART = 0.5
"""Least distance between trees [m], unless the kind's spacing is less."""


def placed(kind: TreeKind, terrain: Terrain, taken: Floats, /, *, seed: int) -> Floats:
    """Return the ground positions (n, 2) [m] of a kind's single trees, none on another or on `taken`.

    Those off the terrain or over its holes are left out.
    """
    draw = np.random.default_rng((seed, 48))
    rows = [_along(row, kind.spacing, kind.uneven, draw) for row in kind.rows]
    chosen = [np.array(kind.positions, np.float32).reshape(-1, 2), *rows]
    fixed = np.concatenate(chosen)
    return _apart(fixed[stands(terrain, fixed)], min(kind.spacing, 1.0) * LEAST_APART, taken)


def stands(terrain: Terrain, place: Floats, /) -> Mask:
    """Return which places (n, 2) have ground, shape (n,)."""
    beside = np.abs(place) - np.array(terrain.whole) / 2.0
    return np.asarray((beside <= 0.0).all(axis=1) & ~hole_at(terrain, place))


def _along(row: Sequence[Sequence[float]], spacing: float, uneven: float, draw: np.random.Generator) -> Floats:
    """Return places along a line at a spacing [m], evenly or not."""
    line = np.array(row, np.float64)
    run = np.append(0.0, np.hypot(*np.diff(line, axis=0).T).cumsum())
    count = min(max(round(run[-1] / spacing), 1) + 1, MOST)
    distance, aside = np.linspace(0.0, run[-1], count), np.zeros((count, 2))
    if uneven > 0.0:
        each = uneven * run[-1] / max(count - 1, 1)
        distance = (distance + each * draw.uniform(-0.5, 0.5, count)).clip(0.0, run[-1])
        aside = min(JITTER * each, MOST_JITTER) * draw.uniform(-1.0, 1.0, (count, 2))
        kept = draw.random(count) >= MISSING * uneven
        distance, aside = distance[kept], aside[kept]
    place = np.stack([np.interp(distance, run, line[:, axis]) for axis in (0, 1)], axis=1)
    return np.asarray(place + aside, np.float32)


def _apart(place: Floats, least: float, taken: Floats) -> Floats:
    """Return the places at least a distance [m] from those before them, and half of it from those `taken`."""
    cells = dict[tuple[int, int], list[tuple[float, float, float]]]()

    def note(x: float, z: float, apart: float) -> None:
        cells.setdefault((int(x // least), int(z // least)), []).append((x, z, apart * apart))

    for x, z in taken.tolist():
        note(x, z, least * 0.5)
    kept = []
    for number, (x, z) in enumerate(place.tolist()):
        column, row = int(x // least), int(z // least)
        near = (each for i in (-1, 0, 1) for j in (-1, 0, 1) for each in cells.get((column + i, row + j), ()))
        if all((x - a) ** 2 + (z - b) ** 2 >= apart for a, b, apart in near):
            kept.append(number)
            note(x, z, least)
    return place[kept]
