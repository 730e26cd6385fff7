"""A game's own ground texture, drawn in place of the scene's soil and litter."""

import logging
from collections.abc import Mapping
from math import inf
from reprlib import repr as shortened
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.shadow_map import texture_number
from ...engine.gl.functions import functions_of
from ...engine.gl.texture import is_released
from ...engine.handed import NUMBER_TYPES
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Part, Start
from ..space.grown import Grown

log = logging.getLogger("tallgrass")

ENCODED, LINEAR = 1.1, 0.5
"""Exponent that turns a texel into a pigment, the root of an albedo: for sRGB-like textures and for linear ones."""

COVERS_TERRAIN = -1.0
"""Value of `earth_side` for a texture that covers the terrain once."""


class Earth(Feature):
    """Feature: the ground texture that a game has handed in, if any."""

    def __init__(self, start: Start, /) -> None:
        self.texture: Any = None
        self.side: float | None = None
        self.power = ENCODED

    def hand_in(self, texture: object, side: float | None, /, *, linear: bool) -> None:
        """Use a texture from the next frame on, None for none; raise TypeError or ValueError for invalid arguments.

        It repeats every `side` [m]; with None it covers the terrain once. `linear` says that its texels are linear.
        """
        if texture is not None:
            texture_number(texture, "a ground's texture is a 2D one")
        if side is not None and not (isinstance(side, NUMBER_TYPES) and 0.0 < side < inf):
            raise ValueError(f"the side of a ground's texture is above 0 m, not {shortened(side)}")
        self.texture, self.side, self.power = texture, side, LINEAR if linear else ENCODED

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> "EarthPart":
        """Return the part that writes the texture into the frame block."""
        return EarthPart(ctx, block, self)


class EarthPart(Part):
    """Writes the ground texture into the frame block for as long as it exists in GL."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, earth: Earth) -> None:
        self._gl, self._block, self._earth = functions_of(ctx), block, earth
        self._reported: Any = None
        """Texture whose release has been logged."""

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Write the texture's number, side and exponent."""
        earth, row = self._earth, record[0]
        self._block.given.earth = number = self._number_or_zero(earth.texture)
        row["earth_power"] = earth.power
        row["earth_side"] = 0.0 if not number else COVERS_TERRAIN if earth.side is None else earth.side

    def _number_or_zero(self, texture: Any) -> int:
        """Return the GL name of a texture, 0 for none or a released one; log a released one once."""
        if texture is None:
            return 0
        number = texture_number(texture)
        if not is_released(texture, number, self._gl):
            return number
        if self._reported is not texture:
            self._reported = texture
            log.warning("texture %d of a game's ground has been released: the scene's own ground is drawn", number)
        return 0
