"""Textures made from what was grown and from the terrain."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.noise import noise_grid, noise_table
from ...engine.terrain.record import Density, Terrain
from ..grow.record import Growth

FINEST_MAP = 1024
"""Samples along a side of the maps laid over the terrain."""

_ROWS = 32
"""Rows of a map worked on at a time: few enough to stay in the processor's own memory."""


def posture_texture(ctx: moderngl.Context, growths: list[Growth]) -> moderngl.TextureArray:
    """Return all kinds' posture tables, one layer per kind and variant; columns are points, rows are indices.

    A texel holds a point's place and the blade's direction there, each (along the bending direction, up).
    """
    place = np.concatenate([growth.postures.shape for growth in growths]).astype(np.float32)
    table = np.concatenate([place, np.gradient(place, axis=2)], axis=-1).astype(np.float32)
    layers, rows, points, _ = table.shape
    texture = ctx.texture_array((points, rows, layers), 4, table.tobytes(), dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def height_texture(ctx: moderngl.Context, terrain: Terrain) -> moderngl.Texture:
    """Return the elevation map, for exact fetches."""
    rows, columns = terrain.heights.shape
    texture = ctx.texture((columns, rows), 1, np.ascontiguousarray(terrain.heights).tobytes(), dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def map_shape(size: tuple[float, float], /) -> tuple[int, int]:
    """Return rows and columns of a map over a terrain of `size` [m]: about one sample per metre."""
    columns, rows = (int(np.clip(np.ceil(side), 16, FINEST_MAP)) for side in size)
    return rows, columns


def slow_map(terrain: Terrain, *, seed: int) -> NDArray[np.uint8]:
    """Return two slow noises n over the terrain, each as 0.5 + 0.5 n, shape (rows, columns, 2)."""
    rows, columns = map_shape(terrain.size)
    (width, depth), (left, far) = terrain.size, terrain.origin
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


def density_texture(ctx: moderngl.Context, density: Density) -> moderngl.TextureArray:
    """Return the kinds' densities as a texture over the terrain: each layer's channels are those of four kinds."""
    kinds, rows, columns = density.maps.shape
    packed = np.zeros((-(-kinds // 4), rows, columns, 4), np.uint8)
    for kind, values in enumerate(density.maps):
        packed[kind // 4, ..., kind % 4] = np.round(values * 255.0)
    texture = ctx.texture_array((columns, rows, len(packed)), 4, packed.tobytes(), alignment=1)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def laid_over(ctx: moderngl.Context, texels: NDArray[np.uint8]) -> moderngl.Texture:
    """Return a map (rows, columns, channels) as a texture over the terrain."""
    rows, columns, channels = texels.shape
    texture = ctx.texture((columns, rows), channels, np.ascontiguousarray(texels).tobytes(), alignment=1)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
