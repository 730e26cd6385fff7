"""Exact intersection of rays with the ground, cell by cell of the terrain, each a bilinear surface."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Ints
from ..pair import numbered
from .record import Terrain

_SAME = 1e-12
"""Value below which components of unit vectors, and a surface's curvature along a ray, are taken as 0."""


_MARGIN = 1.0
"""Margin above the highest and below the lowest ground in which rays are followed [m], against rounding errors."""

_RIGHT, _DOWN = np.array([[0], [1], [0], [1]]), np.array([[0], [0], [1], [1]])
"""Samples from the far left corner of a cell to the far left, far right, near left and near right one."""

_STRETCHES = 2**16
"""Number of stretches of rays, one in each cell, that are computed together: 2 MB for each of their numbers."""


def pick(terrain: Terrain, origin: Doubles, direction: Doubles, /, *, farthest: float = np.inf) -> Floats:
    """Return each ray's first intersection with the ground (x, y, z) [m], (n, 3), NaN if not within `farthest` [m].

    Rays begin at `origin` (n, 3) [m] and go along `direction` (n, 3), of any length but 0. A ray that begins below the
    ground meets it at its origin. Beyond the terrain, ground is at `height_at`; mirrored ground ends where drawn.
    """
    found = np.full((len(origin), 3), np.nan, np.float32)
    scaled = direction / np.abs(direction).max(axis=1, keepdims=True)  # else squares of tiny lengths were 0
    along = scaled / np.sqrt((scaled * scaled).sum(axis=1, keepdims=True))
    along[np.abs(along) < _SAME] = 0.0
    with np.errstate(divide="ignore", invalid="ignore"):  # of rays along an axis
        begin, end = _between(origin[:, 1], along[:, 1], terrain.span[0] - _MARGIN, terrain.span[1] + _MARGIN)
        if terrain.mirrored:
            begin, end = _over_mirrored(terrain, origin, along, begin, end)
        end = np.minimum(end, farthest)
        rays = np.flatnonzero(end >= begin)
        start, along, begin, end = (each[rays] for each in (origin, along, begin, end))
        crossings = _Crossings.of(terrain, start, along, begin, end)
    for part in crossings.parts():
        away = _met(terrain, start[part], along[part], begin[part], end[part], crossings.of_rays(part))
        found[rays[part]] = start[part] + away[:, None] * along[part]
    return found


def _between(y: Doubles, rise: Doubles, lowest: float, highest: float) -> tuple[Doubles, Doubles]:
    """Return begin and end of the stretch of each ray [m] that may meet ground between two heights.

    A ray that starts at a height below both meets it at 0. The end is before the begin where no ground can be met.
    """
    top, bottom = (highest - y) / rise, (lowest - y) / rise
    level, climbs = np.where(y <= highest, np.inf, -1.0), np.where(y > lowest, top, 0.0)
    begin = np.where(rise < 0.0, np.maximum(top, 0.0), 0.0)
    return begin, np.where(rise < 0.0, np.maximum(bottom, 0.0), np.where(rise > 0.0, climbs, level))


def _over_mirrored(
    terrain: Terrain, start: Doubles, along: Doubles, begin: Doubles, end: Doubles
) -> tuple[Doubles, Doubles]:
    """Return the stretches of rays [m] clipped to the drawn part of a mirrored terrain."""
    for place, way, side in zip(start[:, ::2].T, along[:, ::2].T, terrain.size, strict=True):
        reach = side / 2.0 + terrain.beyond
        one, other = (-reach - place) / way, (reach - place) / way
        still = way == 0.0
        begin = np.where(still, begin, np.maximum(begin, np.minimum(one, other)))
        leaves = np.where(still, np.where(np.abs(place) <= reach, np.inf, -1.0), np.maximum(one, other))
        end = np.minimum(end, leaves)
    return begin, end


def _met(
    terrain: Terrain, start: Doubles, along: Doubles, begin: Doubles, end: Doubles, crossings: "_Crossings"
) -> Doubles:
    """Return the distance along each ray of its first intersection between `begin` and `end` [m], NaN without one."""
    ray, enters = crossings.stretches(begin, end)
    leaves = _ends_of_stretches(ray, enters, end)
    at, way = crossings.at[ray], crossings.way[ray]
    cell = np.floor(at + 0.5 * (enters + leaves)[:, None] * way)
    # With u and v from 0 to 1 across a cell along x and z, the ground's height in it is
    # far_left + right * u + down * v + twist * u * v. Off the terrain it is as at the edge: there u or v stays 0.
    far_left, far_right, near_left, near_right = _corners(terrain, cell)
    right, down, twist = far_right - far_left, near_left - far_left, far_left - far_right - near_left + near_right
    rows, columns = terrain.heights.shape
    is_on = ((cell >= 0) & (cell < np.array([columns - 1, rows - 1]))) | terrain.mirrored
    u, v = (at - cell + enters[:, None] * way).T * is_on.T
    du, dv = way.T * is_on.T
    # So the ray's height above the ground is low + slope * t + bend * t * t, t metres after it enters the cell.
    low = start[ray, 1] + enters * along[ray, 1] - (far_left + right * u + down * v + twist * u * v)
    slope = along[ray, 1] - (right * du + down * dv + twist * (u * dv + v * du))
    roots = _first_root(low, slope, -twist * du * dv, leaves - enters)
    hit = np.flatnonzero(np.isfinite(roots))[::-1]  # of each ray the first one is written last
    away = np.full(len(begin), np.nan)
    away[ray[hit]] = enters[hit] + roots[hit]
    return away


def _ends_of_stretches(ray: Ints, enters: Doubles, end: Doubles) -> Doubles:
    """Return where stretches of rays end [m]: where the next one begins, and the last one of each ray where that ends.

    The last one of a ray without an end has no length.
    """
    is_last = np.append(ray[1:] != ray[:-1], True)
    return np.where(is_last, np.where(np.isfinite(end)[ray], end[ray], enters), np.append(enters[1:], 0.0))


@dataclass(frozen=True, slots=True, eq=False)
class _Crossings:
    """The lines between cells that rays cross."""

    at: Doubles
    """Where rays begin, in cells along x and z, shape (n, 2)."""

    way: Doubles
    """Way of rays along x and z [cells/m], shape (n, 2)."""

    first: Doubles
    """First line along x and along z that lies on each ray, shape (n, 2)."""

    count: NDArray[np.intp]
    """Number of these lines, shape (n, 2)."""

    @classmethod
    def of(cls, terrain: Terrain, start: Doubles, along: Doubles, begin: Doubles, end: Doubles) -> "_Crossings":
        """Return the lines that rays cross between `begin` and `end` [m]: of mirrored terrain also those beyond it."""
        at, way = (start[:, ::2] - np.array(terrain.origin)) / terrain.cell, along[:, ::2] / terrain.cell
        ends = np.sort([at + begin[:, None] * way, at + end[:, None] * way], axis=0)
        first, last = np.ceil(ends[0]), np.floor(ends[1])
        if not terrain.mirrored:
            rows, columns = terrain.heights.shape
            first, last = np.maximum(first, 0.0), np.minimum(last, np.array([columns, rows]) - 1.0)
        count = np.where(way == 0.0, 0.0, np.maximum(last - first + 1.0, 0.0))
        return cls(at, way, first, count.astype(np.intp))

    def parts(self) -> Iterator[slice]:
        """Yield slices of the rays whose stretches are computed together: at least one ray."""
        done = np.cumsum(self.count.sum(axis=1) + 1)
        begin = 0
        while begin < len(done):
            seen = done[begin - 1] if begin else 0
            end = max(int(np.searchsorted(done, seen + _STRETCHES, side="right")), begin + 1)
            yield slice(begin, end)
            begin = end

    def of_rays(self, part: slice) -> "_Crossings":
        """Return those of some rays."""
        return _Crossings(self.at[part], self.way[part], self.first[part], self.count[part])

    def stretches(self, begin: Doubles, end: Doubles) -> tuple[Ints, Doubles]:
        """Return the ray of each stretch within a cell, and the distance at which it begins [m], in their order."""
        count, (first, at, way) = self.count.reshape(-1), (each.reshape(-1) for each in (self.first, self.at, self.way))
        line, number = numbered(count)  # of ray 0 along x and along z, of ray 1 along x, and so on
        crossed, ray = (first[line] + number - at[line]) / way[line], line // 2
        inside = np.minimum(np.maximum(crossed, begin[ray]), end[ray])  # against rounding errors
        ray, before = np.concatenate([np.arange(len(begin), dtype=np.int32), ray]), np.concatenate([begin, inside])
        order = np.lexsort((before, ray))
        return ray[order], before[order]


def _corners(terrain: Terrain, cell: Doubles) -> Doubles:
    """Return the heights of the corners of cells (n, 2): far left, far right, near left, near right, shape (4, n)."""
    rows, columns = terrain.heights.shape
    near_by = cell if terrain.mirrored else np.clip(cell, -1, (columns, rows))  # integers cannot be as large as places
    i, j = near_by.astype(np.intp).T
    on = _in_mirror if terrain.mirrored else _nearest
    return terrain.heights[on(j + _DOWN, rows), on(i + _RIGHT, columns)].astype(np.float64)


def _nearest(sample: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    return np.asarray(np.minimum(np.maximum(sample, 0), count - 1))


def _in_mirror(sample: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    return np.asarray(count - 1 - np.abs(count - 1 - np.mod(sample, 2 * (count - 1))))


def _first_root(low: Doubles, slope: Doubles, bend: Doubles, length: Doubles) -> Doubles:
    """Return the first t in [0, `length`] at which low + slope * t + bend * t * t is 0 or less; infinity if none is."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        root = np.sqrt(slope * slope - 4.0 * bend * low)
        half = -0.5 * (slope + np.where(slope < 0.0, -root, root))  # this sign avoids cancellation
        one = np.where(np.abs(bend) > _SAME, half / bend, np.inf)
        other = np.where(half != 0.0, low / half, np.inf)
    slack = 1e-9 * (1.0 + length)
    each = np.array([one, other])
    each = np.where((each >= -slack) & (each <= length + slack), np.clip(each, 0.0, length), np.inf)
    return np.where(low <= 0.0, 0.0, each.min(axis=0))
