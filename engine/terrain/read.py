"""Reading elevation maps from files and arrays."""

from collections.abc import Callable
from contextlib import suppress
from math import cos, isqrt, radians
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..declared.terrain import TerrainSource
from .elevation import Elevation, check_size, eight_bit, reading
from .errors import MapError

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOURS = {2: "RGB colours", 3: "a palette of colours", 4: "grey and alpha", 6: "RGBA colours"}

_BITS, _PIXEL_SCALE, _TIE_POINT, _GEO_KEYS, _NO_DATA = 258, 33550, 33922, 34735, 42113
_MODEL_TYPE, _LENGTH_UNIT, _GEOGRAPHIC = 1024, 3076, 2
_UNITS = {9001: 1.0, 9002: 0.3048, 9003: 1200.0 / 3937.0}
"""Metres per length unit: metre, foot, United States survey foot."""

_DEGREE = 111_195.0
"""Metres per degree of latitude."""

_VOIDS = (-9999.0, -32767.0, -32768.0)
"""Values by which elevation models mark voids, often without declaring it; no ground is as low."""


def read_elevation(path: Path, source: TerrainSource, /) -> Elevation:
    """Return the elevation map of a file; raises `MapError` where it cannot be read or is invalid."""
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
    """Return the elevation map of an array, as of a .npy file that holds it; raises `MapError`."""
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
    raw, tiff = _read_raw, _read_tiff
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


def _read_tiff(path: Path, source: TerrainSource, /) -> Elevation:
    """Return the elevation model of a TIFF file: one band of 32-bit floats, or of 16- or 32-bit integers.

    Floats and signed integers are metres, and so are unsigned integers where the file gives a cell size, as elevation
    models do. Other unsigned integers span the vertical scale. Raises `MapError`.
    """
    with reading(path, "a TIFF of one band of 32-bit floats or 16-bit integers"):
        with Image.open(path, formats=["TIFF"]) as image:
            tags: dict[int, Any] = dict(image.tag_v2)  # type: ignore[attr-defined]
            check_size(path, (image.height, image.width))
            _check_band(path, image.mode, tags)
            values = np.asarray(image)
        surveyed = _PIXEL_SCALE in tags
        if image.mode.startswith("I;16") and not surveyed:
            return Elevation(values, whole=2.0 ** tags[_BITS][0] - 1.0)
        cell = _cell(path, tags, len(values)) if surveyed and "cell" not in source.model_fields_set else None
        return Elevation(values, None, cell, _void(values, tags))


def _check_band(path: Path, mode: str, tags: dict[int, Any]) -> None:
    if mode not in ("F", "I", "I;16", "I;16B", "L", "1") or len(tags.get(_BITS, (1,))) > 1:
        raise MapError(path, "it has several bands or colours; export one band of heights")
    if mode in ("L", "1"):
        raise eight_bit(path)


def _void(values: NDArray[Any], tags: dict[int, Any]) -> NDArray[np.bool_]:
    marks = list(_VOIDS)
    with suppress(ValueError):
        marks.append(float(str(tags.get(_NO_DATA, "")).strip("\0 ")))
    void = np.zeros(values.shape, np.bool_)
    for mark in marks:
        with np.errstate(over="ignore"):
            sought = np.float32(mark) if values.dtype.kind == "f" else mark
        void |= np.isnan(values) if np.isnan(mark) else values == sought
    return void


def _cell(path: Path, tags: dict[int, Any], rows: int) -> tuple[float, float]:
    x, z = (abs(float(side)) for side in tags[_PIXEL_SCALE][:2])
    keys = _geo_keys(tags)
    if keys.get(_MODEL_TYPE) == _GEOGRAPHIC:
        tie = tags.get(_TIE_POINT, (0.0,) * 6)
        latitude = float(tie[4]) - (rows / 2 - float(tie[1])) * z
        return x * _DEGREE * cos(radians(latitude)), z * _DEGREE
    unit = _UNITS.get(keys.get(_LENGTH_UNIT, 9001))
    if unit is None:
        raise MapError(path, "its unit of length is not known; give cell in metres")
    return x * unit, z * unit


def _geo_keys(tags: dict[int, Any]) -> dict[int, int]:
    numbers = tags.get(_GEO_KEYS, ())
    entries = (numbers[i : i + 4] for i in range(4, len(numbers) - 3, 4))
    return {key: value for key, location, _, value in entries if location == 0}
