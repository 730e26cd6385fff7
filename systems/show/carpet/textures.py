"""The carpet's images as a texture."""

from collections.abc import Sequence

import moderngl
import numpy as np

from ...grow.record import Growth
from .grow import carpet_of


def carpet_texture(ctx: moderngl.Context, growths: Sequence[Growth]) -> moderngl.TextureArray:
    """Return all carpet images; kinds, models, slopes and directions are layers, in this order."""
    images = np.concatenate(
        [
            carpet_of(model).texels.reshape(-1, *carpet_of(model).texels.shape[2:])
            for growth in growths
            for model in growth.models
        ]
    )
    layers, rows, columns, _ = images.shape
    texture = ctx.texture_array((columns, rows, layers), 4, np.ascontiguousarray(images).tobytes())
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture
