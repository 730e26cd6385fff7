"""Elevation models from TIFF and GeoTIFF files."""

from contextlib import suppress
from math import cos, radians
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..declared.terrain import TerrainSource
from .elevation import Elevation, check_size, eight_bit, reading
from .errors import MapError

_BITS, _PIXEL_SCALE, _TIE_POINT, _GEO_KEYS, _NO_DATA = 258, 33550, 33922, 34735, 42113
_MODEL_TYPE, _LENGTH_UNIT, _GEOGRAPHIC = 1024, 3076, 2
_UNITS = {9001: 1.0, 9002: 0.3048, 9003: 1200.0 / 3937.0}
"""Metres per length unit: metre, foot, United States survey foot."""

_DEGREE = 111_195.0
"""Metres per degree of latitude."""

_VOIDS = (-9999.0, -32767.0, -32768.0)
"""Numbers that elevation models mark voids with, often without saying so; no ground lies there."""


def read_tiff(path: Path, source: TerrainSource, /) -> Elevation:
    """Return the elevation model of a TIFF file: one band of 32-bit floats, or of 16- or 32-bit integers.

    Floats and signed integers are metres. So are unsigned integers where the file says how wide a cell is, as
    elevation models do; others are a whole range. Raises `MapError`.
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
