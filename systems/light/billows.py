"""Billows: a block of noise that repeats every way, of which the sides and tops of clouds are made.

It is Worley's noise upside down, round heaps with creases between, of a few sorts, each finer and weaker than the one
before (Worley, A Cellular Texture Basis Function, 1996; on clouds, Schneider, The Real-Time Volumetric Cloudscapes of
Horizon: Zero Dawn, 2015). Each texel tells too how that rises along its axes: so light knows where a heap faces.
"""

from functools import cache
from hashlib import blake2b
from importlib.resources import files
from itertools import product

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.gl.functions import NUMBERS, functions_of
from ...engine.kept import DIGEST, keep, kept
from .repeating import CLOUDS_SIDE

SIDE = 64
"""Texels along a side."""

SORTS, SHARE = (2, 4, 8, 16), 0.55
"""Heaps in a row of each sort, and how high those of a sort are, of those that are twice as wide."""

STEEPEST = 8.0
"""The steepest that a texel can tell of, along an axis: noise that rises by 1 on that part of a side."""

SEED = 0x62696C6C
"""All clouds are of one block: what it is like where they stand follows from the scene's own map of them."""

LEVELS = 5
"""Levels of its mip-maps, of which the last is 4 texels wide, as many as there are heaps of the second sort."""

SUFFIX, MOST = ".billows", 2
"""What the file is called that it is kept in, and how many are."""

IN_A_ROW = 9
"""Blocks in a row along a side of the clouds' square, as long as the columns of `BLOCK` in `clouding.glsl` are."""

GLSL = {"BILLOWS_STEEPEST": STEEPEST, "BILLOWS_TEXELS": float(SIDE), "BILLOWS_SIDE": CLOUDS_SIDE / IN_A_ROW}


def noise() -> Floats:
    """Return the noise, from 0 in all but the deepest creases to 1 on all but the highest heaps, (SIDE,) * 3."""
    random = np.random.default_rng(SEED)
    field = sum(SHARE**number * _heaps(count, random) for number, count in enumerate(SORTS))
    low, high = np.quantile(field, (0.005, 0.995))
    return np.asarray(np.clip((field - low) / (high - low), 0.0, 1.0), np.float32)


def _heaps(count: int, random: np.random.Generator) -> Floats:
    """Return how near each texel is to the next of points, one in each cube of so many in a row: 0 in a point.

    It falls by 1 for a cube's side, and repeats.
    """
    own, side = random.random((3, count, count, count), np.float32), SIDE // count
    at = (np.arange(side, dtype=np.float32) + 0.5) / side
    nearest = np.full((count, side) * 3, np.inf, np.float32)
    for way in product((-1, 0, 1), repeat=3):
        points = np.roll(own, tuple(-each for each in way), (1, 2, 3))
        down, across, along = (((points[axis] + np.float32(way[axis]))[..., None] - at) ** 2 for axis in range(3))
        square = down.transpose(0, 3, 1, 2)[..., None, :, None] + across.transpose(0, 1, 3, 2)[:, None, :, :, :, None]
        square = square + along[:, None, :, None]
        np.minimum(nearest, square, out=nearest)
    return -np.sqrt(nearest.reshape((SIDE,) * 3))


@cache
def billow_levels() -> tuple[NDArray[np.uint8], ...]:
    """Return the noise, and how it rises along x, y and z, as four channels: shape (SIDE, SIDE, SIDE, 4) and halves.

    The axes go from last to first, as textures have them.
    """
    made = []
    for level, texels in enumerate(np.split(_kept(), _ENDS)):
        made.append(texels.reshape((SIDE >> level,) * 3 + (4,)))
    return tuple(made)


_ENDS = np.cumsum([4 * (SIDE >> level) ** 3 for level in range(LEVELS - 1)])


def _kept() -> NDArray[np.uint8]:
    """Return all levels one after the other, from the disk where they were made before: it takes a quarter second."""
    digest = blake2b(np.__version__.encode(), digest_size=DIGEST // 2)
    digest.update((files("tallgrass.systems") / "light/billows.py").read_bytes())
    key = digest.hexdigest()
    told = kept(key + SUFFIX, key)
    if told is not None:
        return np.frombuffer(told, np.uint8)
    texels = np.concatenate([each.ravel() for each in _made()])
    keep(key + SUFFIX, key, texels.tobytes(), most=MOST)
    return texels


def _made() -> list[NDArray[np.uint8]]:
    field, made = noise(), []
    for level in range(LEVELS):
        side = SIDE >> level
        rises = [(np.roll(field, -1, axis) - np.roll(field, 1, axis)) * (0.5 * side) for axis in (2, 1, 0)]
        told = np.stack([field, *(0.5 + 0.5 * np.clip(each / STEEPEST, -1.0, 1.0) for each in rises)], axis=-1)
        made.append(np.rint(255.0 * told).astype(np.uint8))
        field = field.reshape((side // 2, 2) * 3).mean(axis=(1, 3, 5))
    return made


def billows_texture(ctx: moderngl.Context) -> moderngl.Texture3D:
    """Return `billow_levels` as a texture that repeats; it is read from one level at a time."""
    made = billow_levels()
    texture = ctx.texture3d((SIDE,) * 3, 4, made[0])
    gl, target = functions_of(ctx), NUMBERS["TEXTURE_3D"]
    gl.glBindTexture(target, texture.glo)
    for level, texels in enumerate(made[1:], 1):
        size, given = (len(texels),) * 3, (NUMBERS["RGBA"], NUMBERS["UNSIGNED_BYTE"])
        gl.glTexImage3D(target, level, NUMBERS["RGBA8"], *size, 0, *given, texels.ctypes.data)
    gl.glTexParameteri(target, NUMBERS["TEXTURE_MAX_LEVEL"], len(made) - 1)
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture
