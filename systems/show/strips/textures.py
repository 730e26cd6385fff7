"""The strips of all rings as textures."""

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....engine.gl.mipmaps import mipmapped
from ...grow.record import Growth
from .grow import Strips, strips_of

_WHOLE = 16
"""Layers are so many texels wide and high, or twice, three times as many: the finest mip-maps are whole then."""


def strip_stock(growths: Sequence[Growth], ring: int) -> list[list[Strips]]:
    """Return a ring's strips by kind and model."""
    return [[strips_of(model)[ring] for model in growth.models] for growth in growths]


def strip_texture(ctx: moderngl.Context, stock: Sequence[list[list[Strips]]]) -> moderngl.TextureArray:
    """Return the atlas of all strips: rings, kinds, models, orientations and strips are layers, in this order.

    Pictures stand in the lower left corner of layers that are large enough for all of them.
    """
    every = [strips for kinds in stock for models in kinds for strips in models]
    largest = np.max([strips.texels.shape[2:4] for strips in every], axis=0)
    texture = mipmapped(
        ctx, np.concatenate([_padded(strips.texels, -(-largest // _WHOLE) * _WHOLE) for strips in every])
    )
    texture.repeat_x = texture.repeat_y = False
    return texture


def _padded(texels: NDArray[np.uint8], size: NDArray[np.int64]) -> NDArray[np.uint8]:
    flat = texels.reshape(-1, *texels.shape[2:])
    padded: NDArray[np.uint8] = np.pad(
        flat, [(0, 0), (0, size[0] - flat.shape[1]), (0, size[1] - flat.shape[2]), (0, 0)]
    )
    return padded
