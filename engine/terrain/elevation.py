"""An elevation map as its file holds it, and the checks that all maps share."""

import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from warnings import catch_warnings, filterwarnings, simplefilter

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from .errors import MapError

MOST_CELLS = 8193
"""Greatest number of cells along a side of a map."""

_BROKEN = ".*(Truncated|[Cc]orrupt)"
"""Pillow's warnings that are treated as errors: the tags it then returns may lack the length of a cell."""


@dataclass(frozen=True, slots=True, eq=False)
class Elevation:
    """An elevation map as its file holds it."""

    values: NDArray[Any]
    """Integers or floats, row 0 first in the file, shape (rows, columns)."""

    whole: float | None
    """Value that stands for the whole vertical scale; None where values are metres."""

    cell: tuple[float, float] | None = None
    """Metres per cell in x and z; None where the file does not say."""

    void: NDArray[np.bool_] | None = None
    """Mask of cells without a height, shape (rows, columns)."""


@contextmanager
def reading(path: Path, kind: str) -> Iterator[None]:
    """Turn errors that a reader raises for a broken file into a `MapError`."""
    try:
        with catch_warnings():
            simplefilter("error", Image.DecompressionBombWarning)
            simplefilter("ignore", UserWarning)
            filterwarnings("error", _BROKEN)
            yield
    except MapError:
        raise
    except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
        raise MapError(path, f"it has more than {MOST_CELLS} cells a side, the most there may be") from error
    except UnidentifiedImageError as error:
        raise MapError(path, f"it cannot be read as {kind}") from error
    except UserWarning as warning:
        raise MapError(path, "it is damaged or broken off") from warning
    except (OSError, SyntaxError, ValueError, EOFError, TypeError, KeyError, struct.error, zlib.error) as error:
        raise MapError(path, f"it cannot be read as {kind}: {' '.join(str(error).split())}") from error


def check_size(path: Path | None, shape: tuple[int, ...]) -> None:
    """Raise `MapError` for a map that does not have 2 to `MOST_CELLS` cells a side."""
    if len(shape) != 2:
        raise MapError(path, f"it must be an array of rows and columns, not of {len(shape)} dimensions")
    rows, columns = shape
    if min(rows, columns) < 2 or max(rows, columns) > MOST_CELLS:
        raise MapError(path, f"it is {columns} by {rows} cells, and a map has 2 to {MOST_CELLS} a side")


def check_finite(
    path: Path | None, values: NDArray[Any], one: str, several: str, void: NDArray[np.bool_] | None = None
) -> None:
    """Raise `MapError` for values that are not finite outside of the `void`; `one` and `several` name the values."""
    if values.dtype.kind != "f":
        return
    wrong = ~np.isfinite(values)
    if void is not None:
        wrong &= ~void
    count = int(wrong.sum())
    if count:
        row, column = np.unravel_index(int(wrong.argmax()), wrong.shape)[:2]
        what = f"{one} is no number" if count == 1 else f"{several} are no numbers"
        raise MapError(path, f"{count} {what}, the first at row {row}, column {column}, counted from 0")


def eight_bit(path: Path | None) -> MapError:
    """Return the error for 8-bit heights."""
    instead = "export 16-bit grey" if path else "hand in metres as float32"
    return MapError(path, f"8 bits hold only 256 heights, which would make terraces; {instead}")
