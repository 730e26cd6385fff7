"""Contours of a mask given as a function: it is sampled on a grid, and its edge is found by bisection."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.wind import Extent

Scalar = TypeVar("Scalar", bound=np.generic)
Ask = Callable[[Floats], Floats]
"""Function from places (n, 2) to weights (n,) in [0, 1]."""

CELLS = 48
"""Number of cells of the grid along its longer side."""

HALVINGS = 7
"""Number of bisections of a cell's side that the edge crosses."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """A mask sampled at the nodes of a grid."""

    place: Floats
    """Nodes (x, z), shape (rows, columns, 2)."""

    weight: Floats
    """The mask at the nodes, shape (rows, columns)."""

    ask: Ask
    """The mask itself."""


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """The area in which a mask exceeds a level."""

    corners: Floats
    """Triangles that cover the area, shape (n, 3, 2)."""

    weight: Floats
    """The mask at the triangles' corners, shape (n, 3)."""

    edge: Floats
    """Segments of the area's outline, shape (m, 2, 2)."""


def sampled(mask: Ask, held: Extent, seen: Extent, /) -> Grid | None:
    """Sample a mask over the intersection of its extent `held` and the seen extent, and a cell beyond.

    Return None where they do not overlap. Outside `held` the mask is taken as 0.
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
    """Return the area in which a mask exceeds a level, by marching squares with a bisected outline."""
    inside = grid.weight > level
    across, across_weight = _crossings(grid, level, inside, axis=1)
    down, down_weight = _crossings(grid, level, inside, axis=0)
    cells = _cell_corners(inside)
    mixed = np.nonzero(cells.any(axis=-1) & ~cells.all(axis=-1))
    points = _alternating(_cell_corners(grid.place)[mixed], _cell_sides(across, down)[mixed])
    weights = _alternating(_cell_corners(grid.weight)[mixed], _cell_sides(across_weight, down_weight)[mixed])
    is_inside = cells[mixed]
    crossed = is_inside != np.roll(is_inside, -1, axis=1)
    triangle, owner = _fans(np.stack([is_inside, crossed], axis=2).reshape(-1, 8))
    is_whole = cells.all(axis=-1)
    quad_triangles = [0, 1, 2, 0, 2, 3]
    full = _cell_corners(grid.place)[is_whole][:, quad_triangles].reshape(-1, 3, 2)
    full_weight = _cell_corners(grid.weight)[is_whole][:, quad_triangles].reshape(-1, 3)
    return Contour(
        np.concatenate([full, points[owner[:, None], triangle]]),
        np.concatenate([full_weight, weights[owner[:, None], triangle]]),
        _outline_segments(points[:, 1::2], is_inside, crossed),
    )


def _crossings(grid: Grid, level: float, inside: NDArray[np.bool_], *, axis: int) -> tuple[Floats, Floats]:
    """Return the points at which the outline crosses the cells' sides along an axis, and the weights just inside."""
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


def _cell_corners(nodes: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return nodes' values at the four corners of each cell, going round: shape (rows - 1, columns - 1, 4, ...)."""
    return np.stack([nodes[:-1, :-1], nodes[:-1, 1:], nodes[1:, 1:], nodes[1:, :-1]], axis=2)


def _cell_sides(across: Floats, down: Floats) -> Floats:
    """Return values on the four sides of each cell; a side follows the corner of the same index."""
    return np.stack([across[:-1], down[:, 1:], across[1:], down[:, :-1]], axis=2)


def _alternating(corners: Floats, sides: Floats) -> Floats:
    """Return corners and sides alternating, shape (n, 8, ...)."""
    return np.stack([corners, sides], axis=2).reshape(len(corners), 8, *corners.shape[2:])


def _fans(present: NDArray[np.bool_]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Triangulate convex polygons of the present ones of 8 points (n, 8); return triangles, and each one's polygon."""
    numbers = np.where(present, np.arange(8), -1)
    latest = np.maximum.accumulate(numbers, axis=1)
    first = np.argmax(present, axis=1)
    latest = np.where(latest < 0, first[:, None], latest)
    fans = np.stack([np.broadcast_to(first[:, None], (len(first), 7)), latest[:, :-1], latest[:, 1:]], axis=-1)
    real = (fans[..., 0] != fans[..., 1]) & (fans[..., 1] != fans[..., 2])
    return fans[real], np.nonzero(real)[0]


def _outline_segments(sides: Floats, within: NDArray[np.bool_], crossed: NDArray[np.bool_]) -> Floats:
    """Return the outline's segments: in each cell from a leaving crossing, going round, to the next entering one."""
    segments = [np.zeros((0, 2, 2), np.float32)]
    for corner in range(4):
        unmatched = within[:, corner] & crossed[:, corner]
        for step in (1, 2, 3):
            matched = unmatched & crossed[:, (corner + step) % 4]
            segments.append(np.stack([sides[matched, corner], sides[matched, (corner + step) % 4]], axis=1))
            unmatched &= ~matched
    return np.concatenate(segments)
