"""Painting densities of grass: strokes on density maps, as pure functions of pixels."""

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...engine.terrain.density import CHANNELS, Picture, read_channels
from ...engine.terrain.record import Density
from ...engine.terrain.sample import painted_at

FINEST, LEAST, MOST = 0.5, 64, 1024
"""Side of a pixel of a new map [m], and the fewest and most pixels along its longer side."""


@dataclass(frozen=True, slots=True)
class Brush:
    """The settings of a stroke."""

    kind: str
    """The kind of grass that it paints."""

    radius: float = 4.0
    """Radius of the painted disc, which fades out from its middle [m]."""

    density: float = 1.0
    """Density that it approaches, in [0, 1]."""

    pressure: float = 0.5
    """Fraction of the difference that a dab applies in its middle, in (0, 1]."""

    alone: bool = True
    """Whether it lowers the densities of other kinds that have maps."""

    lowers: bool = False
    """Whether it only lowers densities."""

    def making_room(self, kind: str) -> "Brush":
        """Return the brush that lowers the density of another kind in favour of this brush's kind."""
        return replace(self, kind=kind, density=1.0 - self.density, lowers=True)

    def erasing(self) -> "Brush":
        """Return the brush that erases this kind."""
        return replace(self, density=0.0)


def stroked(
    picture: Picture, channel: str, brush: Brush, line: NDArray[np.float64], size: tuple[float, float], /
) -> Picture:
    """Return a map (rows, columns, 3 or 4) with a stroke along ground positions (n, 2) [m]; `size` is the terrain's.

    Between two positions there are as many dabs as a stroke without gaps needs. Raises ValueError for
    a channel that the map does not have.
    """
    number = CHANNELS.index(channel)
    if number >= picture.shape[2]:
        raise ValueError(f"the map has no {channel} channel to paint in")
    rows, columns = picture.shape[:2]
    painted = picture[..., number].astype(np.float32)
    x, z = _middles(size[0], columns), _middles(size[1], rows)
    for place in _dabs(line, 0.4 * brush.radius):
        across, down = _within(x, place[0], brush.radius), _within(z, place[1], brush.radius)
        weight = _disc(x[across] - place[0], z[down] - place[1], brush.radius) * np.float32(brush.pressure)
        change = np.float32(255.0 * brush.density) - painted[down, across]
        painted[down, across] += weight * (np.minimum(change, 0.0) if brush.lowers else change)
    result = picture.copy()
    result[..., number] = np.clip(np.rint(painted), 0.0, 255.0).astype(np.uint8)
    return result


def _middles(length: float, count: int) -> NDArray[np.float64]:
    """Return the coordinates of pixel centres along a side of the terrain [m], shape (count,)."""
    return np.asarray((np.arange(count) + 0.5) * (length / count) - length / 2, np.float64)


def _within(middles: NDArray[np.float64], place: float, radius: float) -> slice:
    """Return the slice of pixels within a radius of a coordinate [m]."""
    first, last = np.searchsorted(middles, [place - radius, place + radius]).tolist()
    return slice(first, last)


def _disc(x: NDArray[np.float64], z: NDArray[np.float64], radius: float) -> NDArray[np.float32]:
    """Return the weights of a disc: 1 in its middle, falling smoothly to 0 at its edge, shape (rows, columns)."""
    t = np.clip(1.0 - np.sqrt(x[None, :] ** 2 + z[:, None] ** 2) / radius, 0.0, 1.0)
    return (t * t * (3.0 - 2.0 * t)).astype(np.float32)


def _dabs(line: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Return the places of dabs along a line, shape (m, 2), without its first place unless that is the only one."""
    if len(line) < 2:
        return line
    pieces = []
    for start, end in pairwise(line):
        count = max(1, int(np.ceil(np.hypot(*(end - start)) / step)))
        pieces.append(start + (end - start) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(pieces)


def new_picture(density: Density, number: int, /) -> Picture:
    """Return a new map with the current density of a kind in all channels, shape (rows, columns, 3)."""
    width, depth = density.size
    pixel = max(FINEST, max(width, depth) / MOST)
    columns, rows = (int(np.clip(round(side / pixel), 2, MOST)) for side in (width, depth))
    if max(columns, rows) < LEAST:
        columns, rows = (max(2, round(LEAST * side / max(width, depth))) for side in (width, depth))
    place = (
        np.stack(np.meshgrid(_middles(width, columns), _middles(depth, rows)), axis=-1)
        .reshape(-1, 2)
        .astype(np.float32)
    )
    values = np.rint(255.0 * painted_at(density, place)[number]).astype(np.uint8).reshape(rows, columns)
    return np.repeat(values[..., None], 3, axis=2)


def read_picture(path: Path, /) -> Picture:
    """Return the pixels of a density map that has been read before, shape (rows, columns, 3 or 4)."""
    return np.asarray(np.rint(255.0 * np.stack([*read_channels(path).values()], axis=-1)), np.uint8)
