"""Heights, slopes and densities at any place, interpolated bilinearly between the samples of a map."""

from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Mask
from .plots import CELL, CELLS, On
from .record import Density, Terrain
from .stream import tile_of

_THINS = 8.0
"""Range below its steepest slope in which a kind thins out [degrees]."""

_WHOLE = np.float32(1.0 / 255.0)
"""Density of one step of a byte."""

_FIRST = np.float32(0.0)

_BLOCK = 12288
"""Number of places computed at a time: so few that allocators reuse the memory, which is twice as fast."""


def height_at(terrain: Terrain, place: Floats, /) -> Floats:
    """Return the ground's height [m] at ground positions (x, z) [m] of shape (n, 2), shape (n,).

    Beyond the terrain the height of its nearest edge holds, or that of its mirror image if it is mirrored.
    """
    outside = _outside(terrain, place)
    if outside is not None:
        return _by_block(height_at, terrain, place, outside)
    place, _ = mirrored(terrain, place)
    flat = terrain.heights.reshape(-1)
    result = np.empty(len(place), np.float32)
    for block in _blocks(len(place)):
        at = _within_terrain(terrain, place[block])
        far, near = _rows(flat, at)
        result[block] = far + at.down * (near - far)
    return result


def mirrored(terrain: Terrain, place: Floats, /) -> tuple[Floats, Floats | None]:
    """Return ground positions (x, z) [m] folded back onto a mirrored terrain, and the sign of x and z there, (n, 2).

    A sign is -1 where the image is flipped along that axis. Instead of signs it returns None where no place is folded.
    """
    low, size = np.array(terrain.origin), np.array(terrain.size)
    off = np.zeros(len(place), np.bool_) if not terrain.mirrored else ((place < low) | (place > low + size)).any(axis=1)
    if not off.any():
        return place, None
    folded, signs = place.copy(), np.ones(place.shape, np.float32)
    across = np.mod(place[off] - low, 2.0 * size)
    folded[off] = low + size - np.abs(size - across)
    signs[off] = np.where(across > size, -1.0, 1.0)
    return folded, signs


def _outside(terrain: Terrain, place: Floats) -> Mask | None:
    """Return a mask of places (n, 2) outside of the window of a ground that streams; None if no place is."""
    if terrain.blocks is None or not len(place):
        return None
    low = np.array(terrain.origin)
    far = np.asarray(((place < low) | (place > low + terrain.size)).any(axis=1))
    return far if far.any() else None


def _by_block(sample: Callable[[Terrain, Floats], Any], terrain: Terrain, place: Floats, outside: Mask) -> NDArray[Any]:
    """Return what `sample` returns for each place; places `outside` of the window are sampled on their own blocks."""
    assert terrain.blocks is not None
    inside = sample(terrain, place[~outside])
    result = np.empty((len(place), *inside.shape[1:]), inside.dtype)
    result[~outside] = inside
    block = terrain.blocks.at(place)
    for row, column in np.unique(block[outside], axis=0).tolist():
        here = outside & (block == (row, column)).all(axis=1)
        result[here] = sample(tile_of(terrain.blocks, row, column), place[here])
    return result


def slope_at(terrain: Terrain, place: Floats, /) -> Floats:
    """Return the ground's slope (dh/dx, dh/dz) at ground positions (x, z) [m], both of shape (n, 2).

    It is the exact slope of `height_at`, so it has small steps from cell to cell. Beyond the terrain the slope of its
    nearest edge holds, or that of its mirror image if it is mirrored.
    """
    outside = _outside(terrain, place)
    if outside is not None:
        return _by_block(slope_at, terrain, place, outside)
    place, signs = mirrored(terrain, place)
    flat = terrain.heights.reshape(-1)
    slope = np.empty((len(place), 2), np.float32)
    for block in _blocks(len(place)):
        at = _within_terrain(terrain, place[block])
        low = at.corner + at.stride
        a, b, c, d = flat.take(at.corner), flat.take(at.corner + 1), flat.take(low), flat.take(low + 1)
        slope[block, 0] = (b - a) + at.down * ((d - c) - (b - a))
        slope[block, 1] = (c - a) + at.right * ((d - b) - (c - a))
    slope *= np.float32(1.0 / terrain.cell)
    return slope if signs is None else slope * signs


def normal_at(terrain: Terrain, place: Floats, /) -> Floats:
    """Return the ground's normal, unit vectors (x, y, z) of shape (n, 3), at ground positions (x, z) [m], shape (n, 2).

    It is perpendicular to the slope of `slope_at`.
    """
    slope = slope_at(terrain, place)
    normal = np.stack([-slope[:, 0], np.ones(len(place), np.float32), -slope[:, 1]], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return normal


def density_at(density: Density, place: Floats, /) -> Floats:
    """Return each kind's density in [0, 1] at ground positions (x, z) [m] of shape (n, 2), shape (kinds, n).

    Sown or cleared density replaces that of the maps, beyond the terrain too. It is lower below trees.
    """
    return _below_crowns(density, _on_open_ground(density, place), place)


def _below_crowns(density: Density, result: Floats, place: Floats) -> Floats:
    """Return densities (kinds, n), or (n,), reduced by the shade of trees."""
    left = density.crowns.left_at(place)
    return result if left is None else result * left


def _on_open_ground(density: Density, place: Floats, kind: NDArray[np.intp] | None = None) -> Floats:
    """Return densities of all kinds (kinds, n), or of a kind each (n,), without the shade of trees."""
    if not density.sown.any:
        return _limited(density, _painted(density, place, kind), place, kind)
    on, rest = _sown_on(density, place), np.ones(len(place), np.bool_)
    rest[on.which] = False
    sown_kind, painted_kind = (None, None) if kind is None else (kind[on.which], kind[rest])
    result = np.empty((len(density.maps), len(place)) if kind is None else len(place), np.float32)
    result[..., on.which] = density.sown.between(on, sown_kind).T * _WHOLE
    result[..., rest] = _painted(density, place[rest], painted_kind)
    return _limited(density, result, place, kind)


def _painted(density: Density, place: Floats, kind: NDArray[np.intp] | None) -> Floats:
    return painted_at(density, place) if kind is None else _own_painted_at(density, place, kind)


def density_on_lines(density: Density, x: Floats, z: Floats, /) -> Floats:
    """Return each kind's density without trees at crossings of lines of `x` (m, n) and `z` [m], (kinds, m, n, n).

    The second last axis is along z. Sown density is that of the nearest cell, which is faster than in `density_at`.
    """
    shape = *x.shape, x.shape[1]
    if not density.sown.any:
        return natural_at(density, _met(x, z)).reshape(-1, *shape)
    most = (np.array(density.size) - CELL) / 2.0
    page, row, column = density.sown.on_lines(np.clip(x, -most[0], most[0]), np.clip(z, -most[1], most[1]))
    beyond = [np.abs(lines) > side / 2.0 for lines, side in zip((x, z), density.size, strict=True)]
    if beyond[0].any() or beyond[1].any():
        page = np.where(beyond[0][:, None, :] | beyond[1][:, :, None], -1, page)
    rest = np.flatnonzero(page < 0)
    if len(rest) == page.size:
        return natural_at(density, _met(x, z)).reshape(-1, *shape)
    found = density.sown.pages.reshape(-1, len(density.maps)).take((page * CELLS + row) * CELLS + column, axis=0)
    result = np.ascontiguousarray(found.reshape(-1, len(density.maps)).T) * _WHOLE
    if len(rest):
        result[:, rest] = painted_at(density, _met(x, z)[rest])
    if density.land is not None:
        result = _limited(density, result, _met(x, z))
    return np.asarray(result.reshape(-1, *shape), np.float32)


def left_on_lines(density: Density, x: Floats, z: Floats, /) -> Floats | None:
    """Return the fraction of density in the shade of trees at crossings of lines, (m, n, n); None if all are 1."""
    left = density.crowns.left_at(_met(x, z)) if len(density.crowns) else None
    return None if left is None else left.reshape(*x.shape, x.shape[1])


def _met(x: Floats, z: Floats) -> Floats:
    """Return the crossings of lines (x, z) [m], (m * n * n, 2)."""
    shape = *x.shape, x.shape[1]
    return np.stack([np.broadcast_to(x[:, None, :], shape), np.broadcast_to(z[:, :, None], shape)], -1).reshape(-1, 2)


def natural_at(density: Density, place: Floats, /) -> Floats:
    """Return each kind's density by maps, slopes and holes alone, without sowing and trees, (kinds, n)."""
    return _limited(density, painted_at(density, place), place)


def hole_at(terrain: Terrain, place: Floats, /) -> Mask:
    """Return whether there is a hole at ground positions (x, z) [m] of shape (n, 2), shape (n,).

    Holes begin half-way between samples with ground and without.
    """
    outside = _outside(terrain, place)
    if outside is not None:
        return _by_block(hole_at, terrain, place, outside)
    if terrain.holes is None:
        return np.zeros(len(place), np.bool_)
    at = _within_terrain(terrain, place)
    flat = terrain.holes.reshape(-1)
    a, b, c, d = (flat.take(at.corner + more).astype(np.float32) for more in (0, 1, at.stride, at.stride + 1))
    far, near = a + at.right * (b - a), c + at.right * (d - c)
    return np.asarray(far + at.down * (near - far) > 0.5)


def bareness(slopes: Sequence[float | None], /) -> Floats:
    """Return each kind's steepest rise (height over distance) and its loss of density per rise below, (kinds, 2)."""
    ends = np.array([89.9 if slope is None else min(slope, 89.9) for slope in slopes])
    rise, whole = (np.tan(np.radians(np.maximum(ends - before, 0.0))) for before in (0.0, _THINS))
    thins = np.where([slope is None for slope in slopes], 1e9, 1.0 / np.maximum(rise - whole, 1e-6))
    return np.stack([rise, thins], axis=1).astype(np.float32)


def _limited(density: Density, result: Floats, place: Floats, kind: NDArray[np.intp] | None = None) -> Floats:
    """Return densities (kinds, n), or of a kind each (n,), limited by the ground's slope and 0 in holes."""
    if density.land is None:
        return result
    if density.slopes:
        rise = np.hypot(*slope_at(density.land, place).T)
        ends = bareness(density.slopes)
        ends = ends[:, None] if kind is None else ends[kind]
        result = result * np.clip((ends[..., 0] - rise) * ends[..., 1], 0.0, 1.0)
    if density.land.holes is not None or density.land.blocks is not None:
        result[..., hole_at(density.land, place)] = 0.0
    return result


def own_density_at(density: Density, kind: NDArray[np.intp], place: Floats, /) -> Floats:
    """Return the density in [0, 1] of the kind `kind` (n,) at each ground position (x, z) [m] (n, 2), shape (n,).

    It is the same as in `density_at`, at a cost that does not depend on the number of kinds.
    """
    return _below_crowns(density, _on_open_ground(density, place, kind), place)


def _own_painted_at(density: Density, place: Floats, kind: NDArray[np.intp]) -> Floats:
    if density.even is not None:
        return density.even[kind]
    flat, each = density.maps.reshape(-1), density.maps[0].size
    result = np.empty(len(place), np.float32)
    for block in _blocks(len(place)):
        at = _within_maps(density, place[block])
        far, near = _rows(flat, at._replace(corner=at.corner + kind[block] * each))
        result[block] = far + at.down * (near - far)
    return result


def painted_at(density: Density, place: Floats, /) -> Floats:
    """Return each kind's density in the scene's maps at ground positions (x, z) [m] (n, 2), shape (kinds, n).

    Maps are read like a texture laid over the terrain: a pixel's value holds at its centre, and beyond the outermost
    centres it stays the same.
    """
    result = np.empty((len(density.maps), len(place)), np.float32)
    if density.even is not None:
        result[:] = density.even[:, None]
        return result
    for block in _blocks(len(place)):
        at = _within_maps(density, place[block])
        for kind, values in enumerate(density.maps):
            far, near = _rows(values.reshape(-1), at)
            result[kind, block] = far + at.down * (near - far)
    return result


def _sown_on(density: Density, place: Floats) -> On:
    """Return those of places (n, 2) that lie on stored plots of the terrain; at its edge the last cells hold."""
    most = (np.array(density.size) - CELL) / 2.0
    on = density.sown.on(place.clip(-most, most).astype(np.float32))
    x, z = np.abs(place.T)
    within = ((x <= density.size[0] / 2.0) & (z <= density.size[1] / 2.0))[on.which]
    return on if within.all() else On(on.which[within], on.page[within], on.cell[within])


def _blocks(count: int) -> Iterator[slice]:
    return (slice(start, start + _BLOCK) for start in range(0, count, _BLOCK))


class _Within(NamedTuple):
    """Positions of places in a map."""

    corner: NDArray[np.intp]
    """Flat index of the sample at the cell's far left, shape (n,)."""

    right: Floats
    """Fraction of the way to the next column, in [0, 1], shape (n,)."""

    down: Floats
    """Fraction of the way to the next row, in [0, 1], shape (n,)."""

    stride: int
    """Step from a row to the next in the flat map."""


def _within_terrain(terrain: Terrain, place: Floats) -> _Within:
    rows, columns = terrain.heights.shape
    return _within(place, _laid(terrain.origin, (1.0 / terrain.cell, 1.0 / terrain.cell), (columns, rows), 0.0))


def _within_maps(density: Density, place: Floats) -> _Within:
    _, rows, columns = density.maps.shape
    width, depth = density.size
    return _within(place, _laid((-width / 2, -depth / 2), (columns / width, rows / depth), (columns, rows), -0.5))


class _Laid(NamedTuple):
    """A map's transformation from ground to samples: columns along x and rows along z, arrays of shape (2, 1)."""

    scale: Floats
    """Number of samples per metre."""

    origin: Floats
    """Fractional sample at the ground's origin."""

    last: Floats
    """Number of the last sample."""

    before: Floats
    """Number of the last sample but one, 0 where there is one alone."""

    stride: int
    """Step from a row to the next in the flat map."""


@lru_cache(maxsize=64)
def _laid(low: tuple[float, float], scale: tuple[float, float], count: tuple[int, int], shift: float) -> _Laid:
    origin = [-end * each + shift for end, each in zip(low, scale, strict=True)]
    numbers = scale, origin, [each - 1 for each in count], [max(each - 2, 0) for each in count]
    scales, origins, last, before = np.array(numbers, np.float32)[:, :, None]
    return _Laid(scales, origins, last, before, count[0])


def _within(place: Floats, laid: _Laid) -> _Within:
    at = np.multiply(place.T, laid.scale, order="C")
    at += laid.origin
    np.maximum(at, _FIRST, out=at)  # quicker than `clip` where places are few
    np.minimum(at, laid.last, out=at)
    cell = np.floor(at)
    np.minimum(cell, laid.before, out=cell)
    at -= cell
    column, corner = cell.astype(np.intp)
    corner *= laid.stride
    corner += column
    return _Within(corner, at[0], at[1], laid.stride)


def _rows(flat: Floats, at: _Within) -> tuple[Floats, Floats]:
    """Return values interpolated along x at each place, in the row above it and in the row below."""
    low = at.corner + at.stride
    far, near = flat.take(at.corner), flat.take(low)
    far += at.right * (flat.take(at.corner + 1) - far)
    near += at.right * (flat.take(low + 1) - near)
    return far, near
