"""Heights that a program's function gives: it is asked for squares of samples, one after another."""

from collections.abc import Iterator

import numpy as np

from ...components.arrays import Doubles, Floats
from ..declared.array import HeightFunction
from .errors import MapError

SQUARE = 256
"""Samples along a side of what is asked for at a time."""


def ask_heights(asked: HeightFunction, x: Doubles, z: Doubles, /) -> Floats:
    """Return the heights [m] that a function gives where columns at `x` and rows at `z` [m] meet, (rows, columns).

    NaN is a hole. Raises `MapError` where it raises something itself, or returns what are no heights of these places.
    """
    heights = np.empty((len(z), len(x)), np.float32)
    for rows, columns in _squares(*heights.shape):
        heights[rows, columns] = _asked(asked, *np.meshgrid(x[columns], z[rows]))
    return heights


def _squares(rows: int, columns: int) -> Iterator[tuple[slice, slice]]:
    for row in range(0, rows, SQUARE):
        for column in range(0, columns, SQUARE):
            yield slice(row, row + SQUARE), slice(column, column + SQUARE)


def _asked(asked: HeightFunction, x: Doubles, z: Doubles) -> Floats:
    where = f"{asked.name}, asked for x from {x[0, 0]:g} to {x[0, -1]:g} and z from {z[0, 0]:g} to {z[-1, 0]:g} m"
    try:
        with np.errstate(all="ignore"):
            given = np.asarray(asked.function(x, z))
    except Exception as error:  # a program's own function may raise anything
        raise MapError(None, f"{where}, raised {type(error).__name__}: {' '.join(str(error).split())}") from error
    if given.shape not in (x.shape, ()) or given.dtype.kind not in "fiu":
        raise MapError(
            None, f"{where}, must return {x.shape[0]} by {x.shape[1]} numbers, and returned an array of "
            f"{given.dtype} of shape {given.shape}"
        )  # fmt: skip
    with np.errstate(over="ignore"):  # what is too large for single precision is refused as infinity
        heights = given.astype(np.float32)
    if np.isinf(heights).any():
        raise MapError(None, f"{where}, returned a height that is infinite")
    return np.broadcast_to(heights, x.shape)
