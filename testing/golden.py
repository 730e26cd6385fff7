"""Comparing a picture with a recorded one."""

import os
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

RECORD = "TALLGRASS_RECORD"
"""Environment variable; where it is 1, `same_picture` records its picture."""

TILE = 8
"""Side of the squares whose means are compared [pixels]."""

Levels = NDArray[np.float64]


def same_picture(picture: ArrayLike, path: str | Path, /, *, tolerance: float, record: bool = False) -> None:
    """Raise AssertionError where a picture differs from the one recorded in a PNG file, or there is none.

    `picture` holds display colours from 0 to 255, top row first, shape (height, width, 3). Both are cut into squares of
    8 by 8 pixels; `tolerance` is the greatest difference of a square's mean colour in any channel [levels of 255]. At 0
    every pixel has to be the same. So a single blade may be a pixel off on another graphics card, and a missing thing
    is found however large the picture is.

    A picture that differs is written next to the recorded one, as `NAME.differs.png`. With `record`, or with
    `TALLGRASS_RECORD=1` in the environment, the picture is recorded and nothing is compared; nothing else records one.
    Raises ValueError for anything but a picture.
    """
    place, drawn = Path(path), _picture(picture)
    beside = place.with_suffix(".differs.png")
    if record or os.environ.get(RECORD) == "1":
        place.parent.mkdir(parents=True, exist_ok=True)
        _write(drawn, place)
        beside.unlink(missing_ok=True)
        return
    if not place.is_file():
        raise AssertionError(f"no picture is recorded in {place}: look at what is drawn, then record it ({RECORD}=1)")
    problem = _difference(drawn, _read(place), tolerance)
    if problem is None:
        beside.unlink(missing_ok=True)
        return
    _write(drawn, beside)
    raise AssertionError(f"{problem} in {place.name}; what was drawn is in {beside}")


def _picture(picture: ArrayLike) -> NDArray[np.uint8]:
    levels = np.asarray(picture)
    if levels.ndim != 3 or levels.shape[2] != 3 or 0 in levels.shape or levels.dtype.kind not in "iuf":
        raise ValueError(f"a picture is an array (height, width, 3) of numbers, not {levels.shape} of {levels.dtype}")
    if not (np.isfinite(levels).all() and levels.min() >= 0 and levels.max() <= 255):
        raise ValueError("a picture's colours are numbers from 0 to 255")
    return np.asarray(np.rint(levels), np.uint8)


def _read(path: Path) -> NDArray[np.uint8]:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def _write(picture: NDArray[np.uint8], path: Path) -> None:
    Image.fromarray(picture).save(path)


def _difference(drawn: NDArray[np.uint8], recorded: NDArray[np.uint8], tolerance: float) -> str | None:
    """Return a message on the difference of two pictures, or None where it is within `tolerance`."""
    if drawn.shape != recorded.shape:
        (height, width, _), (rows, columns, _) = drawn.shape, recorded.shape
        return f"the picture is {width} by {height} pixels, not {columns} by {rows} as"
    apart = drawn.astype(np.float64) - recorded
    away = np.abs(apart if tolerance == 0.0 else _tiles(apart)).max(axis=2)
    if away.max() <= tolerance:
        return None
    row, column = np.unravel_index(away.argmax(), away.shape)
    side = 1 if tolerance == 0.0 else TILE
    where = f"at column {column * side}, row {row * side}"
    return f"the picture differs by {away.max():.4g} of 255 {where}, over {tolerance:g}, from what is recorded"


def _tiles(apart: Levels) -> Levels:
    """Return the means of squares of `TILE` pixels, shape (rows, columns, 3); squares at the edges may be smaller."""
    for axis in (0, 1):
        starts = np.arange(0, apart.shape[axis], TILE)
        sizes = np.diff(starts, append=apart.shape[axis])
        shape = [1, 1, 1]
        shape[axis] = -1
        apart = np.add.reduceat(apart, starts, axis=axis) / sizes.reshape(shape)
    return apart
