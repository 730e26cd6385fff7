"""An orthographic rasteriser with a depth buffer: many small triangles at once, in numpy."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Rows

CHUNK = 1 << 15
"""Number of fragments processed at a time: few enough for the processor's cache."""

_SLIVER = 1e-9

_STAGGER = np.array([0.125, 0.625, 0.375, 0.875])
"""Position of samples within their column, row by row: staggered, so that steep edges are sampled at several places."""


@dataclass(frozen=True, slots=True, eq=False)
class Fragments:
    """The samples of an image that show a triangle, one fragment each, in rising order of `sample`."""

    sample: Rows
    """Flat index of the sample, row * columns + column, shape (f,)."""

    triangle: Rows
    """Index of the nearest triangle there, shape (f,)."""

    x: Doubles
    """x of the fragment in the triangle's own coordinates, before wrapping [samples], shape (f,)."""

    y: Doubles
    """y of the fragment, in the same coordinates [samples], shape (f,)."""


def rasterise(
    corners: Doubles, nearness: Doubles, /, *, shape: tuple[int, int], wrap: bool = False, shift: int = 0
) -> Fragments:
    """Return the nearest triangle at each sample of an image.

    `corners` are (x, y) in samples, shape (n, 3, 2): sample (row, column) lies at y = row + 0.5 and somewhere
    between x = column and column + 1, staggered from row to row over every four rows. `nearness` is larger
    nearer to the eye, shape (n, 3). With `wrap` the image is a torus, twisted by `shift` rows: what leaves at the last
    column enters at the first, with a row number smaller by `shift`. Without it, what lies outside is clipped.
    """
    planes = plane_of(corners, nearness)
    low, high = (float(nearness.min()), float(nearness.max())) if nearness.size else (0.0, 0.0)
    scale = (2.0**32 - 1.0) / max(high - low, 1e-12)
    depth = _DepthBuffer(shape, wrap=wrap, shift=shift)
    for triangle, row, column in _samples_inside(corners, shape, wrap=wrap):
        x, y = _sample_x(row, column), _sample_y(row)
        steps = np.clip((_value(planes, triangle, x, y) - low) * scale, 0.0, 2.0**32 - 1.0).astype(np.uint64)
        depth.write((steps << np.uint64(32)) | (triangle + 1).astype(np.uint64), row, column)
    return depth.fragments()


def plane_of(corners: Doubles, values: Doubles, /) -> Doubles:
    """Return (value at the origin, slope in x, slope in y) of values linear over each triangle, shape (3, n)."""
    (x0, y0), (x1, y1), (x2, y2) = (corners[:, k].T for k in range(3))
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    area = np.where(np.abs(area) < _SLIVER, np.inf, area)
    first, second = values[:, 1] - values[:, 0], values[:, 2] - values[:, 0]
    in_x = (first * (y2 - y0) - second * (y1 - y0)) / area
    in_y = (second * (x1 - x0) - first * (x2 - x0)) / area
    return np.stack([values[:, 0] - in_x * x0 - in_y * y0, in_x, in_y])


def interpolate(corners: Doubles, values: Doubles, fragments: Fragments, /) -> Doubles:
    """Return the values at the corners of triangles (n, 3), interpolated linearly at each fragment, shape (f,)."""
    value = _value(plane_of(corners, values), fragments.triangle, fragments.x, fragments.y)
    lowest, highest = values.min(axis=1), values.max(axis=1)
    np.clip(value, lowest.take(fragments.triangle), highest.take(fragments.triangle), out=value)
    return value


def ribbon_triangles(left: Floats | Doubles, right: Floats | Doubles, /) -> Doubles:
    """Return the triangles of ribbons from their edges (n, points, k), shape (n * (points - 1) * 2, 3, k)."""
    left, right = left.astype(np.float64), right.astype(np.float64)
    lower = np.stack([left[:, :-1], right[:, :-1], right[:, 1:]], axis=2)
    upper = np.stack([left[:, :-1], right[:, 1:], left[:, 1:]], axis=2)
    return np.stack([lower, upper], axis=2).reshape(-1, 3, left.shape[2])


def along_ribbons(values: Doubles, /) -> Doubles:
    """Return values at the points of ribbons (n, points) as those at the corners of their triangles, (triangles, 3)."""
    return ribbon_triangles(values[:, :, None], values[:, :, None])[:, :, 0]


class _DepthBuffer:
    """The nearest triangle at each sample so far."""

    def __init__(self, shape: tuple[int, int], *, wrap: bool, shift: int) -> None:
        self._shape, self._shift = shape, shift
        self._best = np.zeros(shape[0] * shape[1], np.uint64)
        """Largest key at each sample: nearness in the upper half, 1 + index of the triangle in the lower one."""
        self._unwrapped = [np.empty(len(self._best), np.int32) for _ in shape] if wrap else None
        """Row and column of that fragment before wrapping."""

    def write(self, key: NDArray[np.uint64], row: Rows, column: Rows) -> None:
        """Write the keys of fragments at some samples, which with wrapping may lie beyond the image."""
        rows, columns = self._shape
        if self._unwrapped is None:
            np.maximum.at(self._best, row * columns + column, key)
            return
        turns = column // columns
        wrapped = row - self._shift * turns
        sample = (wrapped - wrapped // rows * rows) * columns + (column - turns * columns)
        np.maximum.at(self._best, sample, key)
        nearest = np.flatnonzero(self._best.take(sample) == key)
        written = sample.take(nearest)
        for kept, given in zip(self._unwrapped, (row, column), strict=True):
            kept[written] = given.take(nearest)

    def fragments(self) -> Fragments:
        """Return the fragments seen in the end."""
        sample = np.flatnonzero(self._best != 0)
        triangle = (self._best.take(sample) & np.uint64(0xFFFFFFFF)).astype(np.int64) - 1
        if self._unwrapped is None:
            row = sample // self._shape[1]
            column = sample - row * self._shape[1]
        else:
            row, column = (kept.take(sample).astype(np.int64) for kept in self._unwrapped)
        return Fragments(sample, triangle, _sample_x(row, column), _sample_y(row))


def _samples_inside(corners: Doubles, shape: tuple[int, int], /, *, wrap: bool) -> Iterator[tuple[Rows, Rows, Rows]]:
    """Yield the samples inside all triangles, about `CHUNK` at a time: triangle, row and column, shape (m,) each."""
    halves = _halves(corners, shape, wrap=wrap)
    for start, stop in _chunks(halves.count):
        half, row = _expand(halves.count[start:stop], halves.low[start:stop])
        triangle, first, last = halves.row_spans(half + start, row)
        if not wrap:
            first, last = np.clip(first, 0, shape[1]), np.clip(last, 0, shape[1])
        length = np.maximum(last - first, 0)
        for begin, end in _chunks(length):
            span, column = _expand(length[begin:end], first[begin:end])
            yield triangle[begin:end].take(span), row[begin:end].take(span), column


@dataclass(frozen=True, slots=True, eq=False)
class _Edges:
    """Edges that rise in y: lower ends, and the way to the upper ends, shape (n,) each."""

    x: Doubles
    y: Doubles
    run: Doubles
    rise: Doubles

    @classmethod
    def between(cls, start: Doubles, end: Doubles, /) -> "_Edges":
        """Return the edges from `start` to `end`, shape (n, 2) each."""
        rise = end[:, 1] - start[:, 1]
        columns = start[:, 0], start[:, 1], end[:, 0] - start[:, 0], np.where(rise > 0.0, rise, 1.0)
        return cls(*(np.ascontiguousarray(column) for column in columns))

    def x_at(self, number: Rows, y: Doubles, /) -> Doubles:
        """Return x of some edges (m,) at heights y (m,), shape (m,)."""
        x = (y - self.y.take(number)) / self.rise.take(number)
        np.clip(x, 0.0, 1.0, out=x)
        x *= self.run.take(number)
        x += self.x.take(number)
        return x


@dataclass(frozen=True, slots=True, eq=False)
class _Halves:
    """Triangles, each cut at the height of its middle corner into a lower half and an upper one."""

    bent: _Edges
    """Edge of each half on the side of the middle corner."""

    straight: _Edges
    """Edge of each triangle on the other side, from its lowest to its highest corner."""

    low: Rows
    """First row of each half."""

    count: Rows
    """Number of rows of each half."""

    def row_spans(self, half: Rows, row: Rows, /) -> tuple[Rows, Rows, Rows]:
        """Return the triangle of each half, its first column on a row and the one after its last, shape (m,) each."""
        triangle, y, shift = half >> 1, _sample_y(row), _STAGGER.take(row & 3)
        bent, straight = self.bent.x_at(half, y), self.straight.x_at(triangle, y)
        first, last = np.minimum(bent, straight) - shift, np.maximum(bent, straight) - shift
        return triangle, np.ceil(first).astype(np.int64), np.ceil(last).astype(np.int64)


def _halves(corners: Doubles, shape: tuple[int, int], /, *, wrap: bool) -> _Halves:
    ordered = np.take_along_axis(corners, np.argsort(corners[:, :, 1], axis=1, kind="stable")[:, :, None], axis=1)
    rows = np.ceil(ordered[:, :, 1] - 0.5).astype(np.int64)
    if not wrap:
        rows = np.clip(rows, 0, shape[0])
    return _Halves(
        bent=_Edges.between(ordered[:, :2].reshape(-1, 2), ordered[:, 1:].reshape(-1, 2)),
        straight=_Edges.between(ordered[:, 0], ordered[:, 2]),
        low=rows[:, :2].reshape(-1),
        count=np.diff(rows, axis=1).reshape(-1),
    )


def _expand(length: Rows, first: Rows, /) -> tuple[Rows, Rows]:
    """Return the run of each element of runs of `length` integers from `first` on, laid end to end, and the element."""
    run = np.repeat(np.arange(length.shape[0]), length)
    start = first - np.cumsum(length) + length
    return run, np.arange(run.shape[0]) + start.take(run)


def _chunks(length: Rows, /) -> list[tuple[int, int]]:
    """Return ranges of runs that hold about `CHUNK` elements each."""
    if not length.size:
        return []
    number = (np.cumsum(length) - length) // CHUNK
    edges = [0, *(np.flatnonzero(np.diff(number)) + 1).tolist(), length.shape[0]]
    return list(pairwise(edges))


def _value(planes: Doubles, triangle: Rows, x: Doubles, y: Doubles, /) -> Doubles:
    value: Doubles = planes[1].take(triangle) * x
    value += planes[0].take(triangle)
    value += planes[2].take(triangle) * y
    return value


def _sample_y(row: Rows, /) -> Doubles:
    return np.asarray(row + 0.5, np.float64)


def _sample_x(row: Rows, column: Rows, /) -> Doubles:
    return np.asarray(column + _STAGGER.take(row & 3))
