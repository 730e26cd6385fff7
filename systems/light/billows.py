"""Billows: a tileable 3D noise that shapes the sides and tops of clouds.

It is inverted Worley noise, round heaps with creases between, in a few octaves, each finer and weaker than the last
(Worley, A Cellular Texture Basis Function, 1996; on clouds, Schneider, The Real-Time Volumetric Cloudscapes of Horizon:
Zero Dawn, 2015). Each texel also holds the gradient of the noise, from which a heap is lit.
"""

from functools import cache
from math import prod

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.gl.functions import ENUMS, functions_of
from ...engine.kept import MEGABYTE, code_hash, keep, kept
from .repeating import CLOUDS_SIDE, heaps

SIDE = 64
"""Texels along a side of the block."""

OCTAVES, GAIN = (2, 4, 8, 16), 0.5 ** (1 / 3)
"""Heaps along a side in each octave; amplitude of an octave, relative to the octave before.

Eddies half as large stir air half as much to the third root (Kolmogorov, The Local Structure of Turbulence, 1941)."""

STEEPEST = 8.0
"""Largest gradient component that a texel can hold [1 / side]."""

SEED = 0x62696C6C
"""Seed of the noise. All scenes share one block; the scene's cloud map decides which parts of it show."""

LEVELS = 5
"""Number of mip levels. The last is 4 texels wide, the number of heaps in the second octave."""

SUFFIX, ROOM = ".billows", 4 * MEGABYTE
"""Suffix of cache files, and room for them: each has a megabyte [bytes]."""

BLOCKS = 9
"""Blocks along a side of the cloud map's square: the length of the columns of `BLOCK` in `clouding.glsl`."""

GLSL = {"BILLOWS_STEEPEST": STEEPEST, "BILLOWS_TEXELS": float(SIDE), "BILLOWS_SIDE": CLOUDS_SIDE / BLOCKS}


def billow_noise() -> Floats:
    """Return the noise, scaled to [0, 1] about a mean of 0.5, and clipped where 1 % is farther off, (SIDE,) * 3."""
    random = np.random.default_rng(SEED)
    points = (random.random((3, count, count, count), np.float32) for count in OCTAVES)
    field = sum(GAIN**number * heaps(each, SIDE) for number, each in enumerate(points))
    field = field - np.mean(field)
    return np.asarray(0.5 + 0.5 * np.clip(field / np.quantile(np.abs(field), 0.99), -1.0, 1.0), np.float32)


@cache
def billow_levels() -> tuple[NDArray[np.uint8], ...]:
    """Return the mip levels of the noise and its gradient along x, y and z, shapes (SIDE, SIDE, SIDE, 4), halved each.

    The array's axes are z, y, x, as in textures. They come from the cache where possible: making them takes a quarter
    second.
    """
    key, shapes = code_hash("systems/light/billows.py"), [(SIDE >> level,) * 3 + (4,) for level in range(LEVELS)]
    texels = kept(key, SUFFIX)
    if texels is None:
        made = b"".join(each.tobytes() for each in _computed_levels())
        keep(key, SUFFIX, made, room=ROOM)
        texels = memoryview(made)
    parts = np.split(np.frombuffer(texels, np.uint8), np.cumsum([prod(shape) for shape in shapes])[:-1])
    return tuple(part.reshape(shape) for part, shape in zip(parts, shapes, strict=True))


def _computed_levels() -> list[NDArray[np.uint8]]:
    """Return the mip levels, finest first, as `billow_levels` does."""
    field, levels = billow_noise(), []
    for level in range(LEVELS):
        side = SIDE >> level
        slopes = [(np.roll(field, -1, axis) - np.roll(field, 1, axis)) * (0.5 * side) for axis in (2, 1, 0)]
        texels = np.stack([field, *(0.5 + 0.5 * np.clip(each / STEEPEST, -1.0, 1.0) for each in slopes)], axis=-1)
        levels.append(np.rint(255.0 * texels).astype(np.uint8))
        field = field.reshape((side // 2, 2) * 3).mean(axis=(1, 3, 5))
    return levels


def billows_texture(ctx: moderngl.Context) -> moderngl.Texture3D:
    """Return `billow_levels` as a repeating texture, sampled from the nearest mip level."""
    levels = billow_levels()
    texture = ctx.texture3d((SIDE,) * 3, 4, levels[0])
    gl, target = functions_of(ctx), ENUMS["TEXTURE_3D"]
    gl.glBindTexture(target, texture.glo)
    for level, texels in enumerate(levels[1:], 1):
        size, formats = (len(texels),) * 3, (ENUMS["RGBA"], ENUMS["UNSIGNED_BYTE"])
        gl.glTexImage3D(target, level, ENUMS["RGBA8"], *size, 0, *formats, texels.ctypes.data)
    gl.glTexParameteri(target, ENUMS["TEXTURE_MAX_LEVEL"], len(levels) - 1)
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture
