"""Textures made from what was grown and from the terrain."""

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.noise import noise_grid, noise_table
from ...engine.terrain.record import Density, Terrain
from ...engine.terrain.sample import slope_at
from ..grow.record import Growth

FINEST_MAP = 1024
"""Samples along a side of the maps laid over the terrain."""

_ROWS = 32
"""Rows of a map worked on at a time: few enough to stay in the processor's own memory."""

Floats = NDArray[np.float32]


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


def _map_shape(size: tuple[float, float]) -> tuple[int, int]:
    """Return rows and columns of a map over a terrain of `size` [m]: about one sample per metre."""
    columns, rows = (int(np.clip(np.ceil(side), 16, FINEST_MAP)) for side in size)
    return rows, columns


def tone_map(terrain: Terrain, *, seed: int) -> NDArray[np.uint8]:
    """Return the terrain's slope (x, z) and two slow noises, each as 0.5 + 0.5 n, shape (rows, columns, 4)."""
    rows, columns = _map_shape(terrain.size)
    (width, depth), (left, far) = terrain.size, terrain.origin
    x = (left + (np.arange(columns) + 0.5) / columns * width).astype(np.float32)
    z = (far + (np.arange(rows) + 0.5) / rows * depth).astype(np.float32)
    packed, slow = np.empty((rows, columns, 4), np.uint8), _slow_noise(x, z, seed)
    for start in range(0, rows, _ROWS):
        some = slice(start, start + _ROWS)
        place = np.stack(np.meshgrid(x, z[some]), axis=-1)
        slope = slope_at(terrain, place.reshape(-1, 2)).reshape(place.shape)
        values = np.concatenate([slope, slow[some]], axis=-1)
        packed[some] = np.clip(np.round((0.5 + 0.5 * values) * 255.0), 0, 255)
    return packed


def _slow_noise(x: Floats, z: Floats, seed: int) -> Floats:
    wide, close = (
        noise_grid(noise_table(seed, stream)[..., :2], x / np.float32(wave), z / np.float32(wave))
        for stream, wave in ((16, 23.0), (17, 6.0))
    )
    return 0.6 * wide + 0.4 * close


def tone_texture(ctx: moderngl.Context, terrain: Terrain, *, seed: int) -> moderngl.Texture:
    """Return `tone_map` as a texture over the terrain."""
    return _laid_over(ctx, tone_map(terrain, seed=seed))


def density_texture(ctx: moderngl.Context, density: Density) -> moderngl.Texture:
    """Return the kinds' densities as the channels of a texture over the terrain."""
    kinds, rows, columns = density.maps.shape
    packed = np.zeros((rows, columns, 4), np.uint8)
    packed[..., :kinds] = np.round(np.moveaxis(density.maps, 0, -1) * 255.0)
    return _laid_over(ctx, packed)


def _laid_over(ctx: moderngl.Context, texels: NDArray[np.uint8]) -> moderngl.Texture:
    rows, columns, _ = texels.shape
    texture = ctx.texture((columns, rows), 4, np.ascontiguousarray(texels).tobytes())
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
