"""The carpet's images, and their changes in the wind, as textures."""

from collections.abc import Generator, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Floats
from ....engine.gl.mipmaps import mipmapping, stack_for
from ....engine.gl.texture import interpolated
from ...grow.record import Growth
from .grow import carpet_of
from .levels import seen_levels


def sending_carpet(ctx: moderngl.Context, growths: Sequence[Growth]) -> Generator[None, None, moderngl.TextureArray]:
    """Return all carpet images as layers, ordered by form, model, slope and direction; send them a piece at a time."""
    layers, layer = image_count(growths), 0
    resampled = _whole if stack_for(ctx, layers) > 1 else np.asarray
    made: list[Bytes] = []
    for carpet in (carpet_of(model) for growth in growths for model in growth.models):
        for images, slope in zip(carpet.texels, carpet.slope.tolist(), strict=True):
            levels = seen_levels(resampled(images), slope)
            made = made or [np.empty((layers, *level.shape[1:]), np.uint8) for level in levels]
            for whole, level in zip(made, levels, strict=True):
                whole[layer : layer + len(level)] = level
            layer += len(images)
            yield
    texture = yield from mipmapping(ctx, made)
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture


def image_count(growths: Sequence[Growth], /) -> int:
    """Return the number of images of all growths."""
    return sum(int(np.prod(carpet_of(model).texels.shape[:2])) for growth in growths for model in growth.models)


def _whole(images: Bytes) -> Bytes:
    """Return images (layers, side, side, 4) resampled to sides of a power of two, as they repeat beyond their edges."""
    side = images.shape[1]
    whole = 1 << (side - 1).bit_length()
    nearest = np.arange(whole) * side // whole
    return np.ascontiguousarray(images[:, nearest][:, :, nearest])


def bents_of(growths: Sequence[Growth], /) -> Floats:
    """Return `Carpet.bent` of all kinds, averaged over models, (kinds, slopes, bends, 4)."""
    return np.stack([np.mean([carpet_of(model).bent for model in growth.models], axis=0) for growth in growths])


def bent_texture(ctx: moderngl.Context, texels: NDArray[np.float16]) -> moderngl.TextureArray:
    """Return a table of `bents_of` as a texture: kinds are layers, slopes rows, bends columns."""
    layers, rows, columns, _ = texels.shape
    return interpolated(ctx.texture_array((columns, rows, layers), 4, texels.tobytes(), dtype="f2"))
