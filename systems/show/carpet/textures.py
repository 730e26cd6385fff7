"""The carpet's images, and what becomes of them in the wind, as textures."""

from collections.abc import Sequence

import moderngl
import numpy as np

from ....components.arrays import Bytes
from ....engine.gl.mipmaps import mipmapped, stack_for
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
    if stack_for(ctx, layers) > 1:
        texture = mipmapped(ctx, [_whole(images)])
        texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        return texture
    texture = ctx.texture_array((columns, rows, layers), 4, np.ascontiguousarray(images).tobytes())
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture


def image_count(growths: Sequence[Growth], /) -> int:
    """Return how many images there are."""
    return sum(int(np.prod(carpet_of(model).texels.shape[:2])) for growth in growths for model in growth.models)


def _whole(images: Bytes) -> Bytes:
    """Return images (layers, side, side, 4) with sides of a power of two: they go on beyond their edges."""
    side = images.shape[1]
    whole = 1 << (side - 1).bit_length()
    nearest = np.arange(whole) * side // whole
    return np.ascontiguousarray(images[:, nearest][:, :, nearest])


def bent_texture(ctx: moderngl.Context, growths: Sequence[Growth]) -> moderngl.TextureArray:
    """Return `Carpet.bent` of all kinds, a layer each: bends are columns, slopes rows, and models taken in the mean."""
    tables = np.stack([np.mean([carpet_of(model).bent for model in growth.models], axis=0) for growth in growths])
    layers, rows, columns, _ = tables.shape
    texels = np.pad(tables, ((0, 0), (0, 0), (0, 0), (0, 1))).astype(np.float16)
    texture = ctx.texture_array((columns, rows, layers), 4, texels.tobytes(), dtype="f2")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
