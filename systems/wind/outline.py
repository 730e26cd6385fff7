"""Outlines of any shape: depth of places inside them, and the direction outwards (paper, section 3.3)."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Mask
from ..space.polygon import signed_distances

FINE = 96
"""Number of samples along the longer side of an outline."""

_BLUR = 2.0
"""Standard deviation of the blur of directions, so that no ridge shows where two sides are equally near [samples]."""


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """A shape on the ground, sampled in a rectangle a little larger than itself."""

    corner: tuple[float, float]
    """Position of the first sample, (x, z) [m]."""

    step: float
    """Distance between samples [m]."""

    field: Floats
    """Depth and outward direction at each sample, shape (rows along z, columns along x, 3)."""

    deepest: float
    """Largest distance to the outline [m]."""

    @property
    def depth(self) -> Floats:
        """Distance to the outline inside the shape, negative outside [m], shape (rows, columns)."""
        return self.field[..., 0]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Rectangle of the samples: least x, largest x, least z, largest z [m]."""
        rows, columns = self.field.shape[:2]
        x, z = self.corner
        return x, x + (columns - 1) * self.step, z, z + (rows - 1) * self.step

    def at(self, place: Floats, /) -> tuple[Floats, Floats]:
        """Return the depth [m], shape (n,), and the direction outwards (n, 2) at positions (n, 2) in its frame."""
        rows, columns = self.field.shape[:2]
        grid = (place - np.array(self.corner, np.float32)) / np.float32(self.step)
        inside = np.clip(grid, np.float32(0.0), np.array([columns - 1.001, rows - 1.001], np.float32))
        low = inside.astype(np.int32)
        fraction = inside - low.astype(np.float32)
        s, t = fraction[:, :1], fraction[:, 1:]
        flat, first = self.field.reshape(-1, 3), low[:, 1] * columns + low[:, 0]
        far = flat.take(first, axis=0)
        far += s * (flat.take(first + 1, axis=0) - far)
        first += columns
        near = flat.take(first, axis=0)
        near += s * (flat.take(first + 1, axis=0) - near)
        found = far + t * (near - far)
        return found[:, 0], found[:, 1:]


@lru_cache(maxsize=256)
def polygon_of_ellipse(across: float, along: float, /) -> tuple[tuple[float, float], ...]:
    """Return the corners of a polygon for an ellipse with these half axes [m], the first one to the right."""
    angle = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    return tuple(zip((across * np.cos(angle)).tolist(), (along * np.sin(angle)).tolist(), strict=True))


@lru_cache(maxsize=256)
def outline_of_polygon(corners: tuple[tuple[float, float], ...], /) -> Outline:
    """Return the outline of a closed polygon with these corners (x, z) [m], which may be concave."""
    points = np.array(corners, np.float64)
    low, high = points.min(axis=0), points.max(axis=0)
    step = float((high - low).max()) / (FINE - 5)
    columns, rows = (np.ceil((high - low) / step).astype(int) + 5).tolist()
    corner = (low + high) / 2 - step * (np.array([columns, rows]) - 1) / 2
    x, z = corner[0] + step * np.arange(columns), corner[1] + step * np.arange(rows)
    place = np.stack(np.meshgrid(x, z), axis=-1)
    depth = -signed_distances(place.reshape(-1, 2), points).reshape(rows, columns)
    return _outline(depth, (float(corner[0]), float(corner[1])), step)


def outline_of_picture(holds: Mask, /, *, width: float) -> Outline:
    """Return the outline of a picture's set pixels, shape (rows, columns), `width` [m] across.

    The picture's middle is the frame's origin, and its top lies ahead.
    """
    rows, columns = holds.shape
    framed = np.pad(holds, 2)
    step = width / columns
    return _outline(_signed(framed) * step, (-(columns + 3) * step / 2, -(rows + 3) * step / 2), step)


def _outline(depth: Doubles, corner: tuple[float, float], step: float) -> Outline:
    """Return the outline of a signed depth (rows, columns) [m]; directions are the gradient of the blurred depth."""
    down, right = np.gradient(_blurred(depth), step)
    outward = -np.stack([right, down], axis=2)
    length = np.linalg.norm(outward, axis=2, keepdims=True)
    outward /= np.maximum(length, 1e-9)
    outward *= np.clip(length * 2.0, 0.0, 1.0)
    field = np.concatenate([depth[..., None], outward], axis=2).astype(np.float32)
    return Outline(corner, step, field, float(field[..., 0].max()))


def _signed(holds: Mask) -> Doubles:
    """Return the signed distance of each pixel to the shape's edge, negative where not set [pixels]."""
    inside, outside = np.argwhere(holds & _next_to(~holds)), np.argwhere(~holds & _next_to(holds))
    rows, columns = np.indices(holds.shape)
    here = np.stack([rows, columns], axis=-1).reshape(-1, 2)
    depth = np.where(holds.reshape(-1), _nearest(here, outside), -_nearest(here, inside))
    return np.asarray((depth - 0.5 * np.sign(depth)).reshape(holds.shape))


def _next_to(pixels: Mask) -> Mask:
    """Return which pixels have one of these set ones beside, above or below them."""
    padded = np.pad(pixels, 1)
    return np.asarray(padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:])


def _nearest(here: NDArray[np.intp], targets: NDArray[np.intp]) -> Doubles:
    """Return the distance of each of `here` (n, 2) to the nearest target, shape (n,)."""
    parts = np.array_split(here, max(1, len(here) * len(targets) // 2_000_000))
    squares = [((part[:, None, :] - targets[None]) ** 2).sum(axis=2).min(axis=1) for part in parts]
    return np.sqrt(np.concatenate(squares).astype(np.float64))


def _blurred(field: Doubles) -> Doubles:
    """Return a field after a Gaussian blur of `_BLUR` samples."""
    offset = np.arange(-int(3 * _BLUR), int(3 * _BLUR) + 1)
    kernel = np.exp(-0.5 * (offset / _BLUR) ** 2)
    kernel /= kernel.sum()
    for axis in (0, 1):
        pad = [(0, 0), (0, 0)]
        pad[axis] = (len(offset) // 2, len(offset) // 2)
        padded = np.pad(field, pad, mode="reflect", reflect_type="odd")
        field = np.apply_along_axis(np.convolve, axis, padded, kernel, mode="valid")
    return field
