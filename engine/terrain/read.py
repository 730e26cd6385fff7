"""Elevation maps read from files and arrays."""

from collections.abc import Callable
from math import isqrt
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..declared.terrain import TerrainSource
from .elevation import Elevation, check_size, eight_bit, reading
from .errors import MapError
from .geotiff import read_tiff

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOURS = {2: "RGB colours", 3: "a palette of colours", 4: "grey and alpha", 6: "RGBA colours"}


def read_elevation(path: Path, source: TerrainSource, /) -> Elevation:
    """Return what an elevation map file holds; raises `MapError` where it is no such file or cannot be right."""
    reader = _readers().get(path.suffix.lower())
    if reader is None:
        raise MapError(path, "elevation maps are 16-bit grey .png, .r16 or .raw, .npy, or .tif files")
    with reading(path, "a file"):
        if not path.is_file():
            raise MapError(path, "there is no such file")
    elevation = reader(path, source)
    check_size(path, elevation.values.shape)
    return elevation


def elevation_of(values: NDArray[Any], /) -> Elevation:
    """Return what an array of heights says, which is what a .npy file of it does; raises `MapError` as one would."""
    check_size(None, values.shape)
    return _elevation_in(None, values)


def _elevation_in(path: Path | None, values: NDArray[Any]) -> Elevation:
    kind = values.dtype.kind
    if kind not in "fiu":
        raise MapError(path, f"it holds {values.dtype} values; heights are floats or integers")
    if values.dtype.itemsize == 1:
        raise eight_bit(path)
    return Elevation(values, whole=float(np.iinfo(values.dtype).max) if kind == "u" else None)


def _readers() -> dict[str, Callable[[Path, TerrainSource], Elevation]]:
    raw, tiff = _read_raw, read_tiff
    return {".png": _read_png, ".npy": _read_npy, ".r16": raw, ".raw": raw, ".tif": tiff, ".tiff": tiff}


def _read_png(path: Path, _: TerrainSource) -> Elevation:
    with reading(path, "a PNG"):
        with path.open("rb") as file:
            header = file.read(26)
        if header[:8] != _SIGNATURE or len(header) < 26:
            raise MapError(path, "it is no PNG file")
        width, height = (int.from_bytes(header[i : i + 4]) for i in (16, 20))
        depth, colour = header[24], header[25]
        if colour in _COLOURS:
            raise MapError(path, f"it holds {_COLOURS[colour]}, not heights; export one channel of 16-bit grey")
        if depth != 16:
            raise eight_bit(path)
        check_size(path, (height, width))
        with Image.open(path, formats=["PNG"]) as image:
            return Elevation(np.asarray(image).astype(np.uint16, copy=False), whole=65535.0)


def _read_npy(path: Path, _: TerrainSource) -> Elevation:
    with reading(path, "a NumPy array"):
        values = np.load(path, mmap_mode="r", allow_pickle=False)
        if not isinstance(values, np.ndarray):
            values.close()
            raise MapError(path, "it is an archive of arrays, not one array")
        return _elevation_in(path, values)


def _read_raw(path: Path, source: TerrainSource) -> Elevation:
    with reading(path, "16-bit numbers"):
        size = path.stat().st_size
        if size == 0 or size % 2:
            raise MapError(path, f"its {size} bytes are no 16-bit heights")
        count = size // 2
        columns = source.columns or isqrt(count)
        if source.columns is None and columns * columns != count:
            raise MapError(path, f"its {count} heights make no square; give columns")
        if count % columns:
            raise MapError(path, f"its {count} heights make no whole rows of {columns} columns")
        check_size(path, (count // columns, columns))
        values = np.fromfile(path, "<u2" if source.byte_order == "little" else ">u2")
        return Elevation(values.reshape(-1, columns), whole=65535.0)
