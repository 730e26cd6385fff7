"""Textures made from what was grown and from the terrain."""

from collections.abc import Mapping, Sequence

import moderngl
import numpy as np

from ...components.arrays import Floats
from ...engine.memo import while_it_lives
from ...engine.terrain.record import Density
from ..grow.record import NOTHING, Growth


@while_it_lives
def posture_table(growth: Growth, /) -> Floats:
    """Return what `posture_texture` has of a kind, shape (variants, rows, points, 4)."""
    place = growth.postures.shape.astype(np.float32)
    return np.concatenate([place, np.gradient(place, axis=2)], axis=-1, dtype=np.float32)


def posture_texture(
    ctx: moderngl.Context, growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING
) -> moderngl.TextureArray:
    """Return all kinds' posture tables, one layer per form and variant; columns are points, rows are indices.

    A texel holds a point's place and the blade's direction there, each (along the bending direction, up).
    """
    forms = [*growths, *(coming.get(kind, growth) for kind, growth in enumerate(growths) if coming)]
    table = np.concatenate([posture_table(growth) for growth in forms])
    layers, rows, points, _ = table.shape
    texture = ctx.texture_array((points, rows, layers), 4, table.tobytes(), dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


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
