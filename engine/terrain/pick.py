"""Exact intersection of rays with the ground, cell by cell of the terrain, each a bilinear surface."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from .record import Terrain

_SAME = 1e-12
"""Value below which components of unit vectors, and a surface's curvature along a ray, are taken as 0."""


_MARGIN = 1.0
"""Margin above the highest and below the lowest ground in which rays are followed [m], against rounding errors."""


def pick(terrain: Terrain, origin: Doubles, direction: Doubles, /, *, farthest: float = np.inf) -> Floats:
    """Return each ray's first intersection with the ground (x, y, z) [m], (n, 3), NaN if not within `farthest` [m].

    Rays begin at `origin` (n, 3) [m] and go along `direction` (n, 3), of any length but 0. A ray that begins below the
    ground meets it at its origin. Beyond the terrain, ground is at `height_at`; mirrored ground ends where drawn.
    """
    found = np.full((len(origin), 3), np.nan, np.float32)
    lowest, highest = terrain.span[0] - _MARGIN, terrain.span[1] + _MARGIN
    for number, (start, way) in enumerate(zip(origin, direction, strict=True)):
        scaled = way / np.abs(way).max()  # else squares of tiny lengths were 0
        along = scaled / np.linalg.norm(scaled)
        along[np.abs(along) < _SAME] = 0.0
        begin, end = _between(start[1], along[1], lowest, highest)
        if terrain.mirrored:
            begin, end = _over_mirrored(terrain, start, along, begin, end)
        away = _met(terrain, start, along, begin, min(end, farthest))
        if away is not None:
            found[number] = start + away * along
    return found


def _between(y: float, rise: float, lowest: float, highest: float) -> tuple[float, float]:
    """Return begin and end of the stretch of a ray [m] that may meet ground between two heights.

    A ray that starts at a height below both meets it at 0. The end is before the begin where no ground can be met.
    """
    if rise == 0.0:
        return 0.0, np.inf if y <= highest else -1.0
    ends = (highest - y) / rise, (lowest - y) / rise
    if rise > 0.0:
        return 0.0, ends[0] if y > lowest else 0.0 if y <= highest else -1.0
    return max(ends[0], 0.0), max(ends[1], 0.0)


def _over_mirrored(terrain: Terrain, start: Doubles, along: Doubles, begin: float, end: float) -> tuple[float, float]:
    """Return a ray's stretch [m] clipped to the drawn part of a mirrored terrain."""
    for place, way, side in zip(start[::2], along[::2], terrain.size, strict=True):
        reach = side / 2.0 + terrain.beyond
        if way == 0.0:
            end = end if abs(place) <= reach else -1.0
        else:
            enters, leaves = sorted(((-reach - place) / way, (reach - place) / way))
            begin, end = max(begin, enters), min(end, leaves)
    return begin, end


def _met(terrain: Terrain, start: Doubles, along: Doubles, begin: float, end: float) -> float | None:
    """Return the distance along a ray of its first intersection between `begin` and `end` [m], None without one."""
    if end < begin:
        return None
    rows, columns = terrain.heights.shape
    at = (start[::2] - np.array(terrain.origin)) / terrain.cell
    way = along[::2] / terrain.cell
    counts = (np.inf, np.inf) if terrain.mirrored else (columns, rows)
    lines = [_crossings(at[axis], way[axis], begin, end, count) for axis, count in enumerate(counts)]
    inner = np.sort(np.concatenate(lines))
    last = end if np.isfinite(end) else (inner[-1] if len(inner) else begin)
    stops = np.concatenate([[begin], inner, [last]])
    before, after = stops[:-1], stops[1:]
    middle = at + 0.5 * (before + after)[:, None] * way
    cell = np.floor(middle)
    near = cell if terrain.mirrored else np.clip(cell, -1, counts)  # no integer is as large as some places are
    a, b, c, d = _corners(terrain, near.astype(np.intp))
    inside = ((cell >= 0) & (cell < np.array([columns - 1, rows - 1]))) | terrain.mirrored
    u, v = (at - cell + before[:, None] * way).T * inside.T
    du, dv = way[:, None] * inside.T
    twist = a - b - c + d
    right, down = b - a, c - a
    # Height above the ground along the ray, t from the entry into each cell: low + slope * t + bend * t * t.
    low = start[1] + before * along[1] - (a + right * u + down * v + twist * u * v)
    slope = along[1] - (right * du + down * dv + twist * (u * dv + v * du))
    roots = _first_root(low, slope, -twist * du * dv, after - before)
    hit = np.flatnonzero(np.isfinite(roots))
    return float(before[hit[0]] + roots[hit[0]]) if len(hit) else None


def _crossings(at: float, way: float, begin: float, end: float, count: float) -> Doubles:
    """Return distances between `begin` and `end` [m] at which a ray crosses the lines 0 to count - 1 of an axis.

    An infinite count means all lines, also those below 0.
    """
    if way == 0.0:
        return np.zeros(0)
    ends = sorted((at + begin * way, at + end * way))
    first, last = np.ceil(ends[0]), np.floor(ends[1])
    if count < np.inf:
        first, last = max(first, 0.0), min(last, count - 1.0)
    crossed = (np.arange(first, last + 1.0) - at) / way
    return np.asarray(crossed[(crossed > begin) & (crossed < end)])


def _corners(terrain: Terrain, cell: NDArray[np.intp]) -> Doubles:
    """Return the heights of the corners of cells (n, 2): far left, far right, near left, near right, shape (4, n)."""
    rows, columns = terrain.heights.shape
    i, j = cell.T
    on = _in_mirror if terrain.mirrored else _nearest
    left, right = on(i, columns), on(i + 1, columns)
    far, near = on(j, rows), on(j + 1, rows)
    heights = terrain.heights
    return np.array([heights[far, left], heights[far, right], heights[near, left], heights[near, right]], np.float64)


def _nearest(sample: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    return np.clip(sample, 0, count - 1)


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
