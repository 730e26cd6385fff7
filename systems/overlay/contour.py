"""Contours of a mask that is only known by asking it: sampled on a grid, and its edge found by halving."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.wind import Extent

Scalar = TypeVar("Scalar", bound=np.generic)
Ask = Callable[[Floats], Floats]
"""Weights (n,) in [0, 1] at places (n, 2)."""

CELLS = 48
"""Cells of the grid along the longer side of what is sampled."""

HALVINGS = 7
"""How often a cell's side is halved to find where the edge crosses it."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """A mask sampled at the nodes of a grid."""

    place: Floats
    """Nodes (x, z), shape (rows, columns, 2)."""

    weight: Floats
    """Shape (rows, columns)."""

    ask: Ask


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """Where a mask exceeds a level."""

    corners: Floats
    """Triangles that cover it, shape (n, 3, 2)."""

    weight: Floats
    """The mask at their corners, shape (n, 3)."""

    edge: Floats
    """Pieces of its outline, each from one end to the other, shape (m, 2, 2)."""


def sampled(mask: Ask, held: Extent, seen: Extent, /) -> Grid | None:
    """Return a mask sampled over the part of its extent that is seen, and a cell beyond; None where none is.

    Outside `held` the mask is taken to be 0.
    """
    low = np.maximum([held.left, held.ahead], [seen.left, seen.ahead])
    high = np.minimum([held.right, held.behind], [seen.right, seen.behind])
    if not (high > low).all():
        return None
    cell = float((high - low).max()) / CELLS
    axes = [np.arange(a - cell, b + 2.0 * cell, cell) for a, b in zip(low.tolist(), high.tolist(), strict=True)]
    place = np.stack(np.meshgrid(*axes), axis=-1).astype(np.float32)

    def ask(at: Floats) -> Floats:
        x, z = at.T
        inside = (x >= held.left) & (x <= held.right) & (z >= held.ahead) & (z <= held.behind)
        weight: Floats = np.where(inside, mask(at), np.float32(0.0))
        return weight

    return Grid(place, ask(place.reshape(-1, 2)).reshape(place.shape[:2]), ask)


def contour(grid: Grid, level: float, /) -> Contour:
    """Return where a mask exceeds a level, by marching squares; its outline is as sharp as the mask itself."""
    inside = grid.weight > level
    across, across_weight = _crossings(grid, level, inside, axis=1)
    down, down_weight = _crossings(grid, level, inside, axis=0)
    cells = _at_corners(inside)
    mixed = np.nonzero(cells.any(axis=-1) & ~cells.all(axis=-1))
    slots = _slots(_at_corners(grid.place)[mixed], _at_sides(across, down)[mixed])
    weights = _slots(_at_corners(grid.weight)[mixed], _at_sides(across_weight, down_weight)[mixed])
    within = cells[mixed]
    crossed = within != np.roll(within, -1, axis=1)
    triangle, owner = _fans(np.stack([within, crossed], axis=2).reshape(-1, 8))
    whole = cells.all(axis=-1)
    halves = [0, 1, 2, 0, 2, 3]
    full = _at_corners(grid.place)[whole][:, halves].reshape(-1, 3, 2)
    full_weight = _at_corners(grid.weight)[whole][:, halves].reshape(-1, 3)
    return Contour(
        np.concatenate([full, slots[owner[:, None], triangle]]),
        np.concatenate([full_weight, weights[owner[:, None], triangle]]),
        _pieces(slots[:, 1::2], within, crossed),
    )


def _crossings(grid: Grid, level: float, inside: NDArray[np.bool_], *, axis: int) -> tuple[Floats, Floats]:
    """Return where the edge crosses the grid's sides along an axis, and the weights just inside it."""
    first, second = (np.take(inside, np.arange(a, inside.shape[axis] - 1 + a), axis=axis) for a in (0, 1))
    place, after = (np.take(grid.place, np.arange(a, inside.shape[axis] - 1 + a), axis=axis) for a in (0, 1))
    crossed = first != second
    starts_in = first[crossed][:, None]
    within, without = (np.where(starts_in == want, place[crossed], after[crossed]) for want in (True, False))
    for _ in range(HALVINGS):
        middle = (within + without) / 2
        held = (grid.ask(middle) > level)[:, None]
        within, without = np.where(held, middle, within), np.where(held, without, middle)
    found, weight = np.zeros_like(place), np.zeros(place.shape[:2], np.float32)
    found[crossed], weight[crossed] = within, grid.ask(within)
    return found, weight


def _at_corners(nodes: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return the values at the four corners of each cell, going round: shape (rows - 1, columns - 1, 4, ...)."""
    return np.stack([nodes[:-1, :-1], nodes[:-1, 1:], nodes[1:, 1:], nodes[1:, :-1]], axis=2)


def _at_sides(across: Floats, down: Floats) -> Floats:
    """Return the values on the four sides of each cell, each after the corner of the same number."""
    return np.stack([across[:-1], down[:, 1:], across[1:], down[:, :-1]], axis=2)


def _slots(corners: Floats, sides: Floats) -> Floats:
    """Return corners and sides by turns, shape (n, 8, ...)."""
    return np.stack([corners, sides], axis=2).reshape(len(corners), 8, *corners.shape[2:])


def _fans(present: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the triangles of convex polygons made of those of 8 points (n, 8) that are there, and whose each is."""
    numbers = np.where(present, np.arange(8), -1)
    latest = np.maximum.accumulate(numbers, axis=1)
    first = np.argmax(present, axis=1)
    latest = np.where(latest < 0, first[:, None], latest)
    fans = np.stack([np.broadcast_to(first[:, None], (len(first), 7)), latest[:, :-1], latest[:, 1:]], axis=-1)
    real = (fans[..., 0] != fans[..., 1]) & (fans[..., 1] != fans[..., 2])
    return fans[real], np.nonzero(real)[0]


def _pieces(sides: Floats, within: NDArray[np.bool_], crossed: NDArray[np.bool_]) -> Floats:
    """Return the outline inside each cell: from where it is left, going round, to where it is entered again."""
    pieces = [np.zeros((0, 2, 2), np.float32)]
    for corner in range(4):
        to_go = within[:, corner] & crossed[:, corner]
        for step in (1, 2, 3):
            met = to_go & crossed[:, (corner + step) % 4]
            pieces.append(np.stack([sides[met, corner], sides[met, (corner + step) % 4]], axis=1))
            to_go &= ~met
    return np.concatenate(pieces)
