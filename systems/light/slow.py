"""Slow noises over the terrain: what light varies with from place to place."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.noise import noise_grid, noise_table

FINEST_MAP = 1024
"""Samples along a side of the maps laid over the terrain."""

_ROWS = 32
"""Rows of a map worked on at a time: few enough to stay in the processor's own memory."""


def map_shape(size: tuple[float, float], /) -> tuple[int, int]:
    """Return rows and columns of a map over a terrain of `size` [m]: about one sample per metre."""
    columns, rows = (int(np.clip(np.ceil(side), 16, FINEST_MAP)) for side in size)
    return rows, columns


def slow_map(size: tuple[float, float], origin: tuple[float, float], /, *, seed: int) -> NDArray[np.uint8]:
    """Return two slow noises n over a terrain of a size that begins there [m], each as 0.5 + 0.5 n.

    It has shape (rows, columns, 2), and may be called on another thread.
    """
    rows, columns = map_shape(size)
    (width, depth), (left, far) = size, origin
    x = (left + (np.arange(columns) + 0.5) / columns * width).astype(np.float32)
    z = (far + (np.arange(rows) + 0.5) / rows * depth).astype(np.float32)
    packed = np.empty((rows, columns, 2), np.uint8)
    for start in range(0, rows, _ROWS):
        some = slice(start, start + _ROWS)
        packed[some] = np.clip(np.round((0.5 + 0.5 * _slow_noise(x, z[some], seed)) * 255.0), 0, 255)
    return packed


def _slow_noise(x: Floats, z: Floats, seed: int) -> Floats:
    wide, close = (
        noise_grid(noise_table(seed, stream)[..., :2], x / np.float32(wave), z / np.float32(wave))
        for stream, wave in ((16, 23.0), (17, 6.0))
    )
    return 0.6 * wide + 0.4 * close


def laid_over(ctx: moderngl.Context, texels: NDArray[np.uint8]) -> moderngl.Texture:
    """Return a map (rows, columns, channels) as a texture over the terrain."""
    rows, columns, channels = texels.shape
    texture = ctx.texture((columns, rows), channels, np.ascontiguousarray(texels).tobytes(), alignment=1)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
