"""Haze in colours that a game gives, those of its own sky along the horizon."""

from collections.abc import Callable, Mapping
from reprlib import repr as shortened

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...components.colour import hex_of, is_colour
from ...engine.handed import as_floats
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Part, Start
from ..space.grown import Grown
from .color import shown_as, srgb

Haze = str | tuple[float, float, float] | Callable[[Doubles], object]
"""A colour, or a function from horizontal unit vectors (x, 0, z), shape (n, 3), to colours (n, 3)."""

AROUND = 24
"""Number of sampled directions, evenly from -z over +x: enough for the two harmonics of the fit."""

_ANGLE = 2.0 * np.pi * np.arange(AROUND) / AROUND
_X, _Z = np.sin(_ANGLE), -np.cos(_ANGLE)
_FIT: Doubles = np.linalg.pinv(np.stack([np.ones(AROUND), _X, _Z, _X * _X, _X * _Z], axis=1))


def colours_around(haze: Haze, /) -> Doubles:
    """Return a haze's colours in all sampled directions, shape (`AROUND`, 3); raise ValueError for a bad colour."""
    rule = "haze has a colour, (red, green, blue) of 0 and more or one such as '#a0b0c0'"
    if isinstance(haze, str):
        colour = str(hex_of(haze))
        if not is_colour(colour):
            raise ValueError(f"{rule}, not {shortened(haze)}")
        return np.tile(srgb(colour), (AROUND, 1))
    given = haze(np.stack([_X, np.zeros(AROUND), _Z], axis=1)) if callable(haze) else haze
    colours = as_floats(given, rule)
    if colours.shape not in {(3,), (AROUND, 3)} or colours.min() < 0.0:
        of = f" for each of {AROUND} directions" if callable(haze) else ""
        raise ValueError(f"{rule}{of}, not {shortened(colours.tolist())}")
    return np.broadcast_to(colours.astype(np.float64), (AROUND, 3))


def fitted(radiance: Doubles, /) -> Doubles:
    """Fit radiance in all sampled directions (`AROUND`, 3): coefficients of 1, x, z, x^2 and xz, shape (5, 3)."""
    return np.asarray(_FIT @ radiance)


class GivenHaze(Feature):
    """Feature: haze whose colours a game gives."""

    def __init__(self, start: Start, /) -> None:
        self.haze: Haze | None = None
        self.colours: Doubles | None = None
        """Its colours in all sampled directions, as `colours_around` returns them; None for the scene's own haze."""

    def give(self, haze: Haze | None, /) -> None:
        """Use this haze from the next frame on, or with None the scene's own; raise ValueError for a bad colour."""
        self.colours = None if haze is None else colours_around(haze)
        self.haze = haze

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> "GivenHazePart":
        """Return the part that writes the haze into the frame block."""
        return GivenHazePart(self)


class GivenHazePart(Part):
    """Writes a game's haze into the frame block."""

    def __init__(self, given: GivenHaze) -> None:
        self._given = given
        self._written: Doubles | None = None

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Write the haze's coefficients, if its colours have changed."""
        colours = self._given.colours
        if colours is self._written:
            return
        self._written, row = colours, record[0]
        row["haze_given"] = 0.0
        if colours is not None:
            radiance = colours if row["writes_raw"] else shown_as(np.minimum(colours, 1.0))
            row["haze_given"][:, :3], row["haze_given"][0, 3] = fitted(radiance), 1.0
