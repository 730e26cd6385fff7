"""Haze that a game gives: the colours of its own sky along the horizon."""

from collections.abc import Callable, Mapping
from reprlib import repr as shortened

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...components.colour import hex_of, is_colour
from ...engine.handed import as_floats
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Part
from ..space.grown import Grown
from .color import shown_as, srgb

Haze = str | tuple[float, float, float] | Callable[[Doubles], object]
"""A colour, or what gives colours (n, 3) of directions over the ground, unit vectors (x, 0, z), shape (n, 3)."""

AROUND = 24
"""Directions that are asked for, evenly from -z over +x: all that turns up to twice on the way round is kept."""

_ANGLE = 2.0 * np.pi * np.arange(AROUND) / AROUND
_X, _Z = np.sin(_ANGLE), -np.cos(_ANGLE)
_FIT: Doubles = np.linalg.pinv(np.stack([np.ones(AROUND), _X, _Z, _X * _X, _X * _Z], axis=1))


def colours_around(haze: Haze, /) -> Doubles:
    """Return the colours of a haze all around, shape (`AROUND`, 3); raises ValueError for what are none."""
    due = "haze has a colour, (red, green, blue) of 0 and more or one such as '#a0b0c0'"
    if isinstance(haze, str):
        colour = str(hex_of(haze))
        if not is_colour(colour):
            raise ValueError(f"{due}, not {shortened(haze)}")
        return np.tile(srgb(colour), (AROUND, 1))
    asked = haze(np.stack([_X, np.zeros(AROUND), _Z], axis=1)) if callable(haze) else haze
    found = as_floats(asked, due)
    if found.shape not in {(3,), (AROUND, 3)} or found.min() < 0.0:
        of = f" for each of {AROUND} directions" if callable(haze) else ""
        raise ValueError(f"{due}{of}, not {shortened(found.tolist())}")
    return np.broadcast_to(found.astype(np.float64), (AROUND, 3))


def fitted(radiance: Doubles, /) -> Doubles:
    """Return radiance all around (`AROUND`, 3) by 1, x, z, x^2 and xz of the direction (x, z), shape (5, 3)."""
    return np.asarray(_FIT @ radiance)


class GivenHaze(Feature):
    """The haze of a game's own, if it has given any."""

    def __init__(self) -> None:
        self.haze: Haze | None = None
        self.colours: Doubles | None = None
        """What it comes to, as `colours_around` returns it."""

    def give(self, haze: Haze | None, /) -> None:
        """Let things fade into this from the next frame on, or into the scene's own; raises ValueError as above."""
        self.colours = None if haze is None else colours_around(haze)
        self.haze = haze

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> "GivenHazePart":
        """Return what tells shaders of it."""
        del ctx, block, units
        return GivenHazePart(self)


class GivenHazePart(Part):
    """Tells shaders of it."""

    def __init__(self, given: GivenHaze) -> None:
        self._given = given
        self._told: Doubles | None = None

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Write it, if it is another."""
        del grown
        colours = self._given.colours
        if colours is self._told:
            return
        self._told, row = colours, record[0]
        row["haze_given"] = 0.0
        if colours is not None:
            radiance = colours if row["writes_raw"] else shown_as(np.minimum(colours, 1.0))
            row["haze_given"][:, :3], row["haze_given"][0, 3] = fitted(radiance), 1.0
