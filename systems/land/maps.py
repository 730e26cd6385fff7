"""Textures made from what was grown and from the terrain."""

from collections.abc import Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.terrain.part import Part
from ...engine.terrain.record import Density, Terrain
from ..grow.record import NOTHING, Growth

HOLE = 1
"""The bit of a height's that says whether there is a hole: it is worth a few millionths of the height."""

GLSL = {"HOLE": HOLE}


def posture_texture(
    ctx: moderngl.Context, growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING
) -> moderngl.TextureArray:
    """Return all kinds' posture tables, one layer per form and variant; columns are points, rows are indices.

    A texel holds a point's place and the blade's direction there, each (along the bending direction, up).
    """
    forms = [*growths, *(coming.get(kind, growth) for kind, growth in enumerate(growths) if coming)]
    place = np.concatenate([growth.postures.shape for growth in forms]).astype(np.float32)
    table = np.concatenate([place, np.gradient(place, axis=2)], axis=-1).astype(np.float32)
    layers, rows, points, _ = table.shape
    texture = ctx.texture_array((points, rows, layers), 4, table.tobytes(), dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def height_texture(ctx: moderngl.Context, terrain: Terrain) -> moderngl.Texture:
    """Return the elevation map, for exact fetches. The last bit of a height says whether there is a hole."""
    rows, columns = terrain.heights.shape
    texture = ctx.texture((columns, rows), 1, _heights_of(terrain, Part(0, 0, rows, columns)), dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def send_heights(texture: moderngl.Texture, terrain: Terrain, /, *, since: int) -> None:
    """Send what has changed of a terrain's heights since there were `since` changes."""
    rows, columns = terrain.heights.shape
    changed = terrain.changes.since(since)
    for part in [Part(0, 0, rows, columns)] if changed is None else changed:
        texture.write(_heights_of(terrain, part), viewport=(part.column, part.row, part.columns, part.rows))


def _heights_of(terrain: Terrain, part: Part) -> NDArray[np.uint32]:
    """Return the bits of a part's heights (rows, columns): the last of each is 1 where there is a hole."""
    bits = np.ascontiguousarray(terrain.heights[part.slices]).view(np.uint32) & ~np.uint32(HOLE)
    if terrain.holes is not None:
        bits |= terrain.holes[part.slices]
    return bits


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
