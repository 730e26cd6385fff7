"""An orthographic rasteriser with a depth buffer: many small triangles at once, in numpy."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]
Integers = NDArray[np.int64]

_CHUNK = 1 << 20
_SLIVER = 1e-9

_STAGGER = np.array([0.125, 0.625, 0.375, 0.875])
"""Where samples lie in their column, row by row: so that steep edges are met at more than one place."""


@dataclass(frozen=True, slots=True, eq=False)
class Fragments:
    """The samples of an image that show a triangle, at most one for each, in rising order of `sample`."""

    sample: Integers
    """Flat index of the sample, row * columns + column, shape (f,)."""

    triangle: Integers
    """The nearest triangle there, shape (f,)."""

    x: Doubles
    """Where the triangle was met, before wrapping, shape (f,)."""

    y: Doubles
    """Shape (f,)."""


def rasterise(
    corners: Doubles, nearness: Doubles, /, *, shape: tuple[int, int], wrap: bool = False, chunk: int = _CHUNK
) -> Fragments:
    """Return what each sample of an image shows of triangles: the nearest one.

    `corners` are (x, y) in samples, shape (n, 3, 2): sample (row, column) lies at y = row + 0.5 and somewhere
    between x = column and column + 1, staggered from row to row over every four rows. `nearness` is larger
    nearer to the eye, shape (n, 3). With `wrap` the image is a torus; without it, what lies outside is cut
    off. `chunk` bounds the fragments that are held at a time.
    """
    planes = plane_of(corners, nearness)
    spans = _row_spans(corners, shape, wrap=wrap)
    low, high = (float(nearness.min()), float(nearness.max())) if nearness.size else (0.0, 0.0)
    scale = (2.0**32 - 1.0) / max(high - low, 1e-12)
    best = np.zeros(shape[0] * shape[1], np.uint64)
    kept: list[tuple[Integers, NDArray[np.uint64], Integers, Integers]] = []
    for start, stop in _chunks(spans.length, chunk):
        span, column = _expand(spans.length[start:stop])
        span += start
        triangle, row, column = spans.triangle[span], spans.row[span], column + spans.first[span]
        near = _value(planes, triangle, _across(row, column), _centre(row))
        steps = np.clip((near - low) * scale, 0.0, 2.0**32 - 1.0).astype(np.uint64)
        key = (steps << np.uint64(32)) | (triangle + 1).astype(np.uint64)
        sample = (row % shape[0]) * shape[1] + column % shape[1]
        np.maximum.at(best, sample, key)
        wins = best[sample] == key
        kept.append((sample[wins], key[wins], row[wins], column[wins]))
    return _winners(best, kept)


def plane_of(corners: Doubles, values: Doubles, /) -> Doubles:
    """Return (value at 0, slope in x, slope in y) of what is linear over each triangle, shape (n, 3)."""
    (x0, y0), (x1, y1), (x2, y2) = (corners[:, k].T for k in range(3))
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    area = np.where(np.abs(area) < _SLIVER, np.inf, area)
    first, second = values[:, 1] - values[:, 0], values[:, 2] - values[:, 0]
    in_x = (first * (y2 - y0) - second * (y1 - y0)) / area
    in_y = (second * (x1 - x0) - first * (x2 - x0)) / area
    return np.stack([values[:, 0] - in_x * x0 - in_y * y0, in_x, in_y], axis=1)


def interpolate(corners: Doubles, values: Doubles, fragments: Fragments, /) -> Doubles:
    """Return at each fragment what is given at the corners of the triangles, (n, 3); shape (f,)."""
    at = _value(plane_of(corners, values), fragments.triangle, fragments.x, fragments.y)
    lowest, highest = values.min(axis=1), values.max(axis=1)
    return np.asarray(np.clip(at, lowest[fragments.triangle], highest[fragments.triangle]))


def ribbon_triangles(left: Doubles, right: Doubles, /) -> Doubles:
    """Return the triangles of ribbons from their edges (n, points, k), shape (n * (points - 1) * 2, 3, k)."""
    lower = np.stack([left[:, :-1], right[:, :-1], right[:, 1:]], axis=2)
    upper = np.stack([left[:, :-1], right[:, 1:], left[:, 1:]], axis=2)
    return np.stack([lower, upper], axis=2).reshape(-1, 3, left.shape[2])


@dataclass(frozen=True, slots=True, eq=False)
class _Spans:
    triangle: Integers
    row: Integers
    first: Integers
    length: Integers


def _row_spans(corners: Doubles, shape: tuple[int, int], /, *, wrap: bool) -> _Spans:
    """Return the samples inside each triangle as runs along the rows."""
    ordered = np.take_along_axis(corners, np.argsort(corners[:, :, 1], axis=1, kind="stable")[:, :, None], axis=1)
    low = np.ceil(ordered[:, 0, 1] - 0.5).astype(np.int64)
    high = np.ceil(ordered[:, 2, 1] - 0.5).astype(np.int64)
    if not wrap:
        low, high = np.clip(low, 0, shape[0]), np.clip(high, 0, shape[0])
    triangle, offset = _expand(np.maximum(high - low, 0))
    row = low[triangle] + offset
    ends = _crossings(ordered, triangle, _centre(row))
    first, last = (np.ceil(end - _STAGGER[row % 4]).astype(np.int64) for end in ends)
    if not wrap:
        first, last = np.clip(first, 0, shape[1]), np.clip(last, 0, shape[1])
    full = last > first
    return _Spans(triangle[full], row[full], first[full], (last - first)[full])


def _crossings(ordered: Doubles, triangle: Integers, y: Doubles, /) -> tuple[Doubles, Doubles]:
    """Return where lines of constant y enter and leave triangles whose corners rise in y."""
    bottom, middle, top = (ordered[triangle, k] for k in range(3))
    lower = y < middle[:, 1]
    start, end = np.where(lower[:, None], bottom, middle), np.where(lower[:, None], middle, top)
    bent = _along(start, end, y)
    straight = _along(bottom, top, y)
    return np.minimum(bent, straight), np.maximum(bent, straight)


def _along(start: Doubles, end: Doubles, y: Doubles, /) -> Doubles:
    rise = end[:, 1] - start[:, 1]
    part = np.where(rise > 0.0, (y - start[:, 1]) / np.where(rise > 0.0, rise, 1.0), 0.0)
    return np.asarray(start[:, 0] + np.clip(part, 0.0, 1.0) * (end[:, 0] - start[:, 0]))


def _expand(length: Integers, /) -> tuple[Integers, Integers]:
    """Return, for runs of the given lengths one after another, each element's run and its place in it."""
    owner = np.repeat(np.arange(length.shape[0]), length)
    start = np.cumsum(length) - length
    return owner, np.arange(owner.shape[0]) - start[owner]


def _chunks(length: Integers, chunk: int, /) -> list[tuple[int, int]]:
    """Return ranges of runs that hold about `chunk` elements each."""
    if not length.size:
        return []
    number = (np.cumsum(length) - length) // chunk
    edges = [0, *(np.flatnonzero(np.diff(number)) + 1).tolist(), length.shape[0]]
    return list(pairwise(edges))


def _value(planes: Doubles, triangle: Integers, x: Doubles, y: Doubles, /) -> Doubles:
    return np.asarray(planes[triangle, 0] + planes[triangle, 1] * x + planes[triangle, 2] * y)


def _centre(row: Integers, /) -> Doubles:
    return np.asarray(row + 0.5, np.float64)


def _across(row: Integers, column: Integers, /) -> Doubles:
    return np.asarray(column + _STAGGER[row % 4])


def _winners(
    best: NDArray[np.uint64], kept: list[tuple[Integers, NDArray[np.uint64], Integers, Integers]], /
) -> Fragments:
    if not kept:
        nothing, nowhere = np.zeros(0, np.int64), np.zeros(0)
        return Fragments(nothing, nothing, nowhere, nowhere)
    sample, key, row, column = (np.concatenate(parts) for parts in zip(*kept, strict=True))
    wins = np.flatnonzero(best[sample] == key)
    owner = np.full(best.shape[0], -1)
    owner[sample[wins]] = wins
    owner = owner[owner >= 0]
    triangle = (key[owner] & np.uint64(0xFFFFFFFF)).astype(np.int64) - 1
    return Fragments(sample[owner], triangle, _across(row[owner], column[owner]), _centre(row[owner]))
