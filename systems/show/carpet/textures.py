"""The carpet's images, and their changes in the wind, as textures."""

from collections.abc import Generator, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Floats
from ....engine.gl.mipmaps import PIECE, mipmapping, stack_for
from ....engine.gl.stream import released_unless_finished
from ....engine.gl.texture import interpolated
from ...grow.record import Growth
from .grow import carpet_of


def sending_carpet(ctx: moderngl.Context, growths: Sequence[Growth]) -> Generator[None, None, moderngl.TextureArray]:
    """Return all carpet images as layers, ordered by form, model, slope and direction; send them a piece at a time."""
    by_model = [carpet_of(model).texels for growth in growths for model in growth.models]
    images = [texels.reshape(-1, *texels.shape[2:]) for texels in by_model]
    layers, (rows, columns) = image_count(growths), images[0].shape[1:3]
    if stack_for(ctx, layers) > 1:
        texture = yield from mipmapping(ctx, [_whole(np.concatenate(images))])
        texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        return texture
    texture = ctx.texture_array((columns, rows, layers), 4)
    piece, layer = max(PIECE // images[0][0].nbytes, 1), 0
    with released_unless_finished(texture):
        for of_model in images:
            for first in range(0, len(of_model), piece):
                part = np.ascontiguousarray(of_model[first : first + piece])
                texture.write(part, viewport=(0, 0, layer, columns, rows, len(part)))
                layer += len(part)
                yield
    texture.build_mipmaps()
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
    """Return `Carpet.bent` of all kinds, averaged over models and padded by a channel, (kinds, slopes, bends, 4)."""
    tables = np.stack([np.mean([carpet_of(model).bent for model in growth.models], axis=0) for growth in growths])
    return np.pad(tables, ((0, 0), (0, 0), (0, 0), (0, 1)))


def bent_texture(ctx: moderngl.Context, texels: NDArray[np.float16]) -> moderngl.TextureArray:
    """Return a table of `bents_of` as a texture: kinds are layers, slopes rows, bends columns."""
    layers, rows, columns, _ = texels.shape
    return interpolated(ctx.texture_array((columns, rows, layers), 4, texels.tobytes(), dtype="f2"))
