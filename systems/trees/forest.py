"""Trees of density: all of a small ground, and those about a viewer on a large one; and their heights by age."""

from collections.abc import Iterable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Mask, Place
from ...components.tree import HIGHEST, LOWEST
from ...engine.declared.tree import TreeKind
from ...engine.noise import noise_table, smooth_noise
from ...engine.random import hash3, stream, unit
from ...engine.terrain.sample import height_at, natural_at, slope_at
from ..space.grown import Grown
from .habit import HABITS
from .place import stands
from .scatter import SQUARE, Scatter, Squares, apart
from .standing import DENSE_TO, STANDING, individualise

MOST_ENTITIES = 20_000
"""Trees of density that are all entities; of more, only those near viewers are."""

LEVELS = 5
"""Number of rings about a viewer, each of fewer trees and twice the reach of the last: up to 8 km."""

HECTARE = 1e4
"""[m²]."""

GROVE = 45.0
"""Distance between groves, about [m]."""

FINER, FINER_PART = 2.7, 0.4
"""Frequency of the noise that makes groves uneven, and its amplitude, both relative to the groves'."""

GROVE_EDGE = 3.0
"""Steepness of a grove's density by its noise of -1 to 1: full from a third on."""

DENSER = 4.0
"""Density of trees in groves, relative to the mean of the whole ground."""

STEEPEST = 89.9
"""Greatest slope on which trees grow [degrees]: its tangent is a finite number."""

LEAST_APART = 0.5
"""Least distance from a tree of another kind, relative to the kind's own spacing."""

DIAMETER_DECAY = 1.5
"""Natural logarithm of the ratio of the thinnest to grown trunks in number: it falls by the same factor from each class
of diameters to the next (de Liocourt, De l'amenagement des sapinieres, 1898), here by 1.35 in each of five."""

HEIGHT_GROWTH = 1.6
"""Rate of height growth by diameter d: 1 - exp(-HEIGHT_GROWTH d) (Meyer, A Mathematical Expression for Height Curves,
1940)."""

SEEDLING = 0.1
"""Height of the youngest trees shown, of grown ones."""

Square = tuple[int, int]
Rows = NDArray[np.void]
Gone = dict[Square, dict[int, Place]]
"""Trees gone from squares: by number on each, and where they stood."""


class Forest:
    """The trees that the kinds' densities bring to a ground; `fixed` are the places (n, 2) of single trees, by kind."""

    def __init__(self, grown: Grown, fixed: list[Floats]) -> None:
        self._grown, self._fixed = grown, fixed
        self._squares: dict[tuple[int, int, int], Rows] = {}
        """Grown trees of squares, by level and square."""
        self._terrain_version = -1
        self.gone: Gone = {}
        names = list(grown.scene.grass)
        self._kinds = [
            (number, kind, None if kind.among is None else names.index(kind.among), grown.scene.seed + number)
            for number, kind in enumerate(grown.scene.trees.values())
            if kind.density > 0.0
        ]

    @property
    def is_large(self) -> bool:
        """Whether there are too many trees for all to be entities."""
        hectares = float(np.prod(self._grown.ground.terrain.whole)) / HECTARE
        return hectares * sum(kind.density for _, kind, _, _ in self._kinds) > MOST_ENTITIES

    def all(self) -> Rows:
        """Return all trees of a small ground, records of `STANDING`."""
        half = [int(np.ceil(side / 2.0 / SQUARE)) for side in self._grown.ground.terrain.whole]
        squares = Squares((-half[0], -half[1]), np.ones((2 * half[0], 2 * half[1]), np.bool_))
        return self._trees_on(squares, 0)[0] if self._kinds else np.zeros(0, STANDING)

    @property
    def streams(self) -> bool:
        """Whether the ground is streamed: then only squares of its window can grow."""
        return self._grown.ground.terrain.blocks is not None

    def reaches(self, square: Square, /) -> bool:
        """Return whether a square may have trees."""
        half = np.ceil(np.divide(self._grown.ground.terrain.whole, 2.0 * SQUARE))
        return bool((np.array(square, float) >= -half).all() and (np.array(square, float) < half).all())

    def on(self, squares: Iterable[Square], /) -> dict[Square, Rows]:
        """Return the trees on squares, at full density."""
        wanted = [(0, *square) for square in squares]
        self._grow(wanted)
        return {(i, j): self._squares[0, i, j] for _, i, j in wanted}

    def around(self, eye: tuple[float, float, float], but: Iterable[Square], /) -> Rows:
        """Return the trees about an eye (x, y, z) [m] but on some squares: fewer and fewer from `DENSE_TO` on."""
        left_out = {(0, *square) for square in but}
        wanted = [each for level in range(LEVELS) for each in self._squares_of_ring(eye, level) if each not in left_out]
        self._grow(wanted)
        self._forget([*wanted, *left_out])
        self._update_heights()
        gone = self.gone
        parts = [self._squares[each] for each in wanted if each[0] or each[1:] not in gone]
        parts += [self._standing(each[1:]) for each in wanted if not each[0] and each[1:] in gone]
        # Joining bytes is much faster than np.concatenate.
        return np.frombuffer(bytearray().join(part.tobytes() for part in parts), STANDING)

    def _standing(self, square: Square) -> Rows:
        rows = self._squares[0, *square]
        return np.delete(rows, [number for number in self.gone[square] if number < len(rows)])

    @property
    def version(self) -> int:
        """Number of changes of the terrain."""
        return self._grown.ground.terrain.changes.count

    def grow_about(self, eye: tuple[float, float, float], /) -> None:
        """Grow all that `around` returns for an eye (x, y, z) [m], on any thread."""
        self._grow([each for level in range(LEVELS) for each in self._squares_of_ring(eye, level)])

    def _squares_of_ring(self, eye: tuple[float, float, float], level: int) -> list[tuple[int, int, int]]:
        """Return the squares of a level that are shown to an eye anywhere on its own square."""
        side, outer = SQUARE * 2**level, DENSE_TO * 2**level
        eye_square = np.floor(np.array(eye[::2]) / side).astype(int)
        steps = np.arange(-round(outer / side) - 1, round(outer / side) + 2)
        i, j = np.meshgrid(steps, steps, indexing="ij")
        nearest = np.hypot(np.maximum(abs(i) - 1, 0), np.maximum(abs(j) - 1, 0)) * side
        farthest = np.hypot(abs(i) + 1, abs(j) + 1) * side
        shown = (nearest <= outer) & ((farthest >= 0.4 * outer) | (level == 0))
        squares = np.stack([i[shown], j[shown]], axis=1) + eye_square
        terrain = self._grown.ground.terrain
        low, high = np.array(terrain.origin), np.array(terrain.origin) + terrain.size
        corner = squares * side
        within = (
            (corner >= low) & (corner + side <= high) if terrain.blocks else (corner + side > low) & (corner < high)
        )
        return [(level, *square) for square in squares[within.all(axis=1)].tolist()]

    def _grow(self, wanted: list[tuple[int, int, int]]) -> None:
        unknown = [each for each in wanted if each not in self._squares]
        for level in sorted({each[0] for each in unknown}):
            missing = np.array([each[1:] for each in unknown if each[0] == level])
            low = missing.min(axis=0)
            mask = np.zeros(missing.max(axis=0) - low + 1, np.bool_)
            mask[tuple((missing - low).T)] = True
            rows, square = self._trees_on(Squares((int(low[0]), int(low[1])), mask), level)
            number = (square[:, 0] - low[0]) * mask.shape[1] + square[:, 1] - low[1]
            order = np.argsort(number, kind="stable")
            ends = np.searchsorted(number[order], np.arange(mask.size + 1))
            rows = rows[order]
            for i, j in missing.tolist():
                index = (i - low[0]) * mask.shape[1] + j - low[1]
                self._squares[level, i, j] = rows[ends[index] : ends[index + 1]].copy()

    def _forget(self, wanted: list[tuple[int, int, int]]) -> None:
        if len(self._squares) > 4 * len(wanted) + 100:
            kept = set(wanted)
            self._squares = {each: rows for each, rows in self._squares.items() if each in kept}

    def _update_heights(self) -> None:
        """Move known trees to the terrain as it is now."""
        terrain = self._grown.ground.terrain
        if self._terrain_version != terrain.changes.count and self._terrain_version >= 0:
            for rows in self._squares.values():
                rows["root"][:, 1] = height_at(terrain, np.ascontiguousarray(rows["root"][:, ::2]))
        self._terrain_version = terrain.changes.count

    def _trees_on(self, squares: Squares, level: int) -> tuple[Rows, NDArray[np.int32]]:
        """Return the trees on squares, records of `STANDING`, and the square of each (n, 2)."""
        found, taken = [], list[Floats]()
        for order, (number, kind, among, seed) in enumerate(self._kinds):
            margin = len(self._kinds) - 1 - order if level == 0 else 0
            asked = _widened(squares, margin)
            share = partial(self._share, kind, among, seed)
            place, square = Scatter(kind, seed, share, DENSER if kind.groves > 0.0 else 1.0, level).within(asked)
            if level == 0:
                free = apart(place, self._fixed[number], kind.spacing)
                for others in (*self._fixed[:number], *self._fixed[number + 1 :], *taken):
                    free &= apart(place, others, LEAST_APART * kind.spacing)
                place, square = place[free], square[free]
                taken.append(place)
            offset = square - squares.corner
            inside: Mask = np.asarray(((offset >= 0) & (offset < squares.wanted.shape)).all(axis=1))
            inside[inside] = squares.wanted[tuple(offset[inside].T)]
            found.append((self._rows(number, kind, seed, place[inside], level), square[inside]))
        return np.concatenate([rows for rows, _ in found]), np.concatenate([square for _, square in found])

    def _share(self, kind: TreeKind, among: int | None, seed: int, place: Floats) -> Floats:
        """Return the density of a kind's trees at places (n, 2) [m], as a share of the greatest, shape (n,)."""
        terrain, share = self._grown.ground.terrain, np.ones(len(place), np.float32)
        if kind.groves > 0.0:
            lattice = (place / np.float32(GROVE)).astype(np.float32)
            wave, finer = (
                smooth_noise(noise_table(seed, 45 + n), lattice * np.float32(f))[:, 0]
                for n, f in ((0, 1.0), (1, FINER))
            )
            dense = np.clip(GROVE_EDGE * (wave + FINER_PART * finer), 0.0, 1.0)
            share = np.clip(1.0 - kind.groves * (1.0 - dense), 0.0, 1.0).astype(np.float32)
        share *= stands(terrain, place)
        grows = np.flatnonzero(share > 0.0)
        if among is not None:
            share[grows] *= natural_at(self._grown.ground.density, place[grows])[among]
        rise = np.hypot(*slope_at(terrain, place[grows]).T)
        share[grows] *= rise <= np.tan(np.radians(min(kind.slope, STEEPEST)))
        return share

    def _rows(self, number: int, kind: TreeKind, seed: int, place: Floats, level: int) -> Rows:
        rows = np.zeros(len(place), STANDING)
        rows["root"][:, 0], rows["root"][:, 2] = place.T
        rows["root"][:, 1] = height_at(self._grown.ground.terrain, place)
        hashed = hash3(seed, *(np.ascontiguousarray(each).view(np.int32) for each in place.T))
        low, high = kind.height or HABITS[kind.habit].height
        tall = low + (high - low) * unit(stream(hashed, 5)).astype(np.float64)
        rows["height"] = np.clip(tall * grown_to(kind.young, unit(stream(hashed, 7))), LOWEST, HIGHEST)
        rows["yaw"] = np.pi * (2.0 * unit(stream(hashed, 6)) - 1.0)
        rows["foliage"], rows["kind"], rows["ring"] = kind.foliage, number, level + 1
        individualise(rows)
        return rows


def _widened(squares: Squares, by: int) -> Squares:
    """Return squares with a margin of `by` more on each side."""
    wanted = np.pad(squares.wanted, by)
    for _ in range(by):
        for axis in (0, 1):
            wanted = wanted | np.roll(wanted, 1, axis) | np.roll(wanted, -1, axis)
    return Squares((squares.corner[0] - by, squares.corner[1] - by), wanted)


def grown_to(young: float, chance: NDArray[np.floating], /) -> Doubles:
    """Return the heights of trees, of grown ones, shape (n,); a share of `young` of them is still growing.

    `chance` is a random number of each in [0, 1), shape (n,).
    """
    grows = chance < young
    order = np.where(grows, chance, 0.0) / max(young, float(np.finfo(np.float32).tiny))
    diameter = -np.log1p(-order * (1.0 - np.exp(-DIAMETER_DECAY))) / DIAMETER_DECAY
    height = -np.expm1(-HEIGHT_GROWTH * diameter) / -np.expm1(-HEIGHT_GROWTH)
    return np.where(grows, SEEDLING + (1.0 - SEEDLING) * height, 1.0)
