"""Where the trees of a kind stand: at places that are written, along rows, and where their density brings them."""

from collections.abc import Callable, Sequence

import numpy as np

from ...components.arrays import Floats, Mask
from ...engine.declared.tree import MOST, TreeKind
from ...engine.noise import noise_table, smooth_noise
from ...engine.terrain.record import Terrain
from ...engine.terrain.sample import hole_at, slope_at

Dense = Callable[[Floats], Floats]

HECTARE = 1e4
"""[m²]."""

GROVE = 45.0
"""How far it is from grove to grove, about [m]."""

FINER, FINER_PART = 2.7, 0.4
"""How many times as close together what makes groves uneven is, and how much it adds to them."""

STEEP = 3.0
"""How fast groves grow dense from their edge inwards, by their noise of -1 to 1: all over a third of it."""

STEEPEST = 89.9
"""Slope on which trees grow at most [degrees]: its tangent is a number."""

TRIES = 4
"""Places that are tried for each tree that density brings."""

NEAREST = 0.5
"""How near to another kind's a tree may stand, of its own spacing."""


def placed(kind: TreeKind, terrain: Terrain, dense: Dense | None, taken: Floats, /, *, seed: int) -> Floats:
    """Return the ground positions (n, 2) [m] of a kind's trees; none stands on another of them or of those `taken`.

    `dense` says how densely they grow at ground positions (n, 2), in [0, 1], shape (n,). Places off the terrain and
    over its holes are left out.
    """
    draw = np.random.default_rng((seed, 44))
    chosen = [np.array(kind.positions, np.float32).reshape(-1, 2), *(_along(row, kind.spacing) for row in kind.rows)]
    fixed = np.concatenate(chosen)
    fixed = fixed[_stands(terrain, fixed)]
    sown = _sown(kind, terrain, dense, draw, seed)
    fixed = _apart(fixed, min(kind.spacing, 1.0) * NEAREST, taken)
    return np.concatenate([fixed, _apart(sown, kind.spacing, taken, before=fixed)])


def _along(row: Sequence[Sequence[float]], spacing: float) -> Floats:
    """Return places along a line, evenly, at its first and its last, and so far apart [m]."""
    line = np.array(row, np.float64)
    run = np.append(0.0, np.hypot(*np.diff(line, axis=0).T).cumsum())
    count = min(max(round(run[-1] / spacing), 1) + 1, MOST)
    at = np.linspace(0.0, run[-1], count)
    return np.stack([np.interp(at, run, line[:, axis]) for axis in (0, 1)], axis=1).astype(np.float32)


def _stands(terrain: Terrain, place: Floats) -> Mask:
    """Return which places have ground."""
    beside = np.abs(place) - np.array(terrain.whole) / 2.0
    return np.asarray((beside <= 0.0).all(axis=1) & ~hole_at(terrain, place))


def _sown(kind: TreeKind, terrain: Terrain, dense: Dense | None, draw: np.random.Generator, seed: int) -> Floats:
    """Return where density might bring trees, before any is too near to another."""
    size = np.array(terrain.whole)
    count = min(round(kind.density * size.prod() / HECTARE), MOST) * TRIES
    place = (-size / 2.0 + draw.uniform(0.0, 1.0, (count, 2)) * size).astype(np.float32)
    share = np.ones(count)
    if kind.groves > 0.0 and count:
        lattice = (place / np.float32(GROVE)).astype(np.float32)
        wave, finer = (
            smooth_noise(noise_table(seed, 45 + n), lattice * np.float32(f))[:, 0] for n, f in ((0, 1.0), (1, FINER))
        )
        wave = wave + FINER_PART * finer
        share = np.clip(1.0 - kind.groves * (1.0 - np.clip(STEEP * wave, 0.0, 1.0)), 0.0, 1.0)
    if dense is not None:
        share = share * dense(place)
    grows = draw.uniform(0.0, 1.0, count) < share / TRIES * (TRIES if kind.groves > 0.0 else 1.0)
    grows &= _stands(terrain, place)
    grows &= np.hypot(*slope_at(terrain, place).T) <= np.tan(np.radians(min(kind.slope, STEEPEST)))
    return np.asarray(place[grows], np.float32)


def _apart(place: Floats, least: float, taken: Floats, *, before: Floats | None = None) -> Floats:
    """Return the places that are at least so far [m] from those `taken` and from those before them.

    Those `taken` are other kinds', and count as half as far.
    """
    cells = dict[tuple[int, int], list[tuple[float, float, float]]]()
    own = np.zeros((0, 2), np.float32) if before is None else before

    def note(x: float, z: float, apart: float) -> None:
        cells.setdefault((int(x // least), int(z // least)), []).append((x, z, apart * apart))

    for x, z in taken.tolist():
        note(x, z, least * NEAREST)
    for x, z in own.tolist():
        note(x, z, least)
    kept = []
    for number, (x, z) in enumerate(place.tolist()):
        column, row = int(x // least), int(z // least)
        near = (each for i in (-1, 0, 1) for j in (-1, 0, 1) for each in cells.get((column + i, row + j), ()))
        if all((x - a) ** 2 + (z - b) ** 2 >= apart for a, b, apart in near):
            kept.append(number)
            note(x, z, least)
    return place[kept]
