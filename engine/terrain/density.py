"""Loading density maps, which say where each kind of grass grows and how densely."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...components.arrays import Floats
from ..declared.array import MapArray
from ..declared.grass import GrassKind, Place
from ..declared.terrain import TerrainSource
from .elevation import check_finite, reading
from .errors import MapError
from .record import Density, Terrain

Channels = Mapping[str, Floats]
"""Densities in [0, 1] by channel name, each of shape (rows, columns)."""

Picture = NDArray[np.uint8]
"""Pixels of a map, shape (rows, columns, 3 or 4)."""

MOST_SIDE = 4097
"""Greatest number of pixels along a side of a density map."""

_WHOLE = {"b1": 1.0, "u1": 255.0, "u2": 65535.0}
"""Value of full density in integer arrays, by numpy kind and item size."""

ROUNDED = 1e-5
"""Tolerance of densities below 0 and above 1, for rounding errors of sums and filters in single precision."""

CHANNELS = ("red", "green", "blue", "alpha")


def load_density(
    kinds: Mapping[str, GrassKind], terrain: Terrain, folder: Path, given: Mapping[str, Picture], /
) -> Density:
    """Return the density of each kind on the terrain, in the order of `kinds`; map files lie in `folder`.

    Pictures that are `given` replace the files of their names; an array in a scene is the map itself.

    Kinds with a place have their painted density, scaled down where the sum would pass 1. Kinds without a place share
    the rest equally, so that with such a kind the prairie is full everywhere. Flowers stand among other kinds and take
    no ground from them. All maps are enlarged to the longest sides among them. Raises `MapError` for an unusable map.
    """
    maps = dict.fromkeys(kind.place.map for kind in kinds.values() if kind.place is not None)
    pictures = {each: _channels_in(each, folder, given) for each in maps}
    painted = {name: _channel(folder, kind.place, pictures) for name, kind in kinds.items() if kind.place is not None}
    rows, columns = (max([2, *(picture.shape[axis] for picture in painted.values())]) for axis in (0, 1))
    densities = np.empty((len(kinds), rows, columns), np.float32)
    for number, name in enumerate(kinds):
        densities[number] = _enlarged(painted[name], rows, columns) if name in painted else 1.0
    placed = np.array([name in painted for name in kinds], np.bool_)
    among = np.array([kind.plant == "flower" for kind in kinds.values()], np.bool_)
    placed, others = placed & ~among, ~(placed | among)
    densities[placed] /= np.maximum(densities[placed].sum(axis=0), np.float32(1.0))
    if others.any():
        densities[others] = np.maximum(1.0 - densities[placed].sum(axis=0), 0.0) / np.float32(others.sum())
    slopes = tuple(kind.slope for kind in kinds.values())
    limits = slopes if any(slope is not None for slope in slopes) else ()
    return Density(densities, terrain.whole, terrain, limits)


def load_holes(source: TerrainSource, folder: Path, /) -> Floats | None:
    """Return a scene's map (rows, columns) of holes in the ground, None if it has none; raises `MapError`."""
    return None if source.holes is None else _channels_in(source.holes, folder, {})[CHANNELS[0]]


def at_samples(values: Floats, rows: int, columns: int, /) -> Floats:
    """Return a map with the nearest of its values at each sample of a terrain, (rows, columns).

    The outermost samples stand on the map's edges.
    """
    for axis, count in enumerate((rows, columns)):
        own = values.shape[axis]
        place = np.linspace(0.0, own, count) - 0.5
        values = values.take(np.clip(np.rint(place), 0, own - 1).astype(np.intp), axis)
    return values


def _channel(folder: Path, place: Place, pictures: Mapping[str | MapArray, Channels]) -> Floats:
    channels = pictures[place.map]
    if place.channel not in channels:
        path = None if isinstance(place.map, MapArray) else folder / place.map
        raise MapError(path, f"it has no {place.channel} channel, only {', '.join(channels)}")
    return channels[place.channel]


def _channels_in(each: str | MapArray, folder: Path, given: Mapping[str, Picture]) -> Channels:
    if isinstance(each, MapArray):
        return _channels_of(each.values)
    return _channels_of(given[each]) if each in given else read_channels(folder / each)


def _channels_of(values: NDArray[Any]) -> Channels:
    """Return densities by channel of an array (rows, columns) or (rows, columns, 1 to 4); raises `MapError`."""
    shape = values.shape
    if not (len(shape) == 2 or (len(shape) == 3 and 1 <= shape[2] <= len(CHANNELS))):
        raise MapError(None, f"it must be an array of rows and columns, with 1 to 4 channels at most, not {shape}")
    if not 1 <= min(shape[:2]) <= max(shape[:2]) <= MOST_SIDE:
        raise MapError(None, f"it is {shape[1]} by {shape[0]} cells; a density map has 1 to {MOST_SIDE} a side")
    whole = _WHOLE.get(values.dtype.kind + str(values.dtype.itemsize))
    if whole is None and values.dtype.kind != "f":
        due = "floats from 0 to 1, unsigned integers of 8 or 16 bits, or true and false"
        raise MapError(None, f"it holds {values.dtype} values; densities are {due}")
    check_finite(None, values, "density", "densities")
    if whole is None and (values.min() < -ROUNDED or values.max() > 1.0 + ROUNDED):
        raise MapError(None, f"it goes from {values.min():.6g} to {values.max():.6g}; densities are from 0 to 1")
    numbers = values.reshape(*shape[:2], -1).astype(np.float32) / np.float32(whole or 1.0)
    numbers = np.clip(numbers, 0.0, 1.0)
    return {name: numbers[..., number] for number, name in enumerate(CHANNELS[: numbers.shape[2]])}


def read_channels(path: Path, /) -> Channels:
    """Return the densities in a picture by channel; raises `MapError`."""
    with reading(path, "a picture"):
        if not path.is_file():
            raise MapError(path, "there is no such file")
        with Image.open(path) as image:
            if max(image.size) > MOST_SIDE:
                width, height = image.size
                raise MapError(path, f"it is {width} by {height} pixels; a density map has at most {MOST_SIDE} a side")
            if image.mode in ("I;16", "I;16B", "I;16L"):
                return dict.fromkeys(CHANNELS[:3], np.asarray(image).astype(np.float32) / np.float32(65535.0))
            if image.mode not in ("1", "L", "LA", "P", "PA", "RGB", "RGBA"):
                raise MapError(path, f"its mode is {image.mode}; a density map is a grey, RGB or RGBA picture")
            clear = image.mode in ("LA", "PA", "RGBA") or "transparency" in image.info
            return _channels_of(np.asarray(image.convert("RGBA" if clear else "RGB")))


def _enlarged(values: Floats, rows: int, columns: int) -> Floats:
    """Return a map enlarged to (rows, columns) by bilinear interpolation, like a magnified texture."""
    for axis, count in enumerate((rows, columns)):
        own = values.shape[axis]
        place = np.clip((np.arange(count) + 0.5) * (own / count) - 0.5, 0.0, own - 1.0)
        low = np.minimum(place.astype(np.intp), max(own - 2, 0))
        part = np.expand_dims((place - low).astype(np.float32), 1 - axis)
        high = np.minimum(low + 1, own - 1)
        values = values.take(low, axis) * (1 - part) + values.take(high, axis) * part
    return values
