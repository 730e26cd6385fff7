"""Textures whose mip levels are computed here, on the CPU.

So they are the same with every driver. And a software rasteriser would compile a program for each texture shape, which
takes longer than averaging.
"""

from collections.abc import Generator, Sequence
from typing import TypeVar

import moderngl
import numpy as np

from ...components.arrays import Bytes
from .functions import ENUMS, functions_of
from .limits import limits_of
from .stream import released_unless_finished

Made = TypeVar("Made")

PIECE = 1 << 21
"""Size of an upload where a frame must not wait [bytes]."""

_FORMATS = {1: ("R8", "RED"), 2: ("RG8", "RG"), 3: ("RGB8", "RGB"), 4: ("RGBA8", "RGBA")}


def levels(texels: Bytes, /) -> list[Bytes]:
    """Return all mip levels of layers (layers, rows, columns, ...), down to one texel."""
    found = [np.ascontiguousarray(texels)]
    while max(found[-1].shape[1:3]) > 1:
        found.append(halved(found[-1]))
    return found


def stack_for(ctx: moderngl.Context, layers: int, /) -> int:
    """Return how many layers to stack in each layer of a texture array for all to fit: OpenGL guarantees 256 layers."""
    return -(-layers // limits_of(functions_of(ctx)).layers)


def stacked(made: list[Bytes], stack: int, /) -> list[Bytes]:
    """Return mip levels (layers, rows, columns, ...) with layers stacked along their rows, down to one row of each.

    There are `stack` layers in each. If the number of rows is no power of two, they are padded, so that no texel of a
    level covers two layers, and levels are made anew.
    """
    rows = made[0].shape[1]
    padded_rows = 1 << (rows - 1).bit_length()
    if rows < padded_rows:
        made = levels(np.pad(made[0], [(0, 0), (0, padded_rows - rows), *[(0, 0)] * (made[0].ndim - 2)]))
    missing = -len(made[0]) % stack
    padded = [np.pad(each, [(0, missing), *[(0, 0)] * (each.ndim - 1)]) for each in made[: padded_rows.bit_length()]]
    return [each.reshape(len(each) // stack, stack * each.shape[1], *each.shape[2:]) for each in padded]


def mipmapped(ctx: moderngl.Context, made: list[Bytes], /) -> moderngl.TextureArray:
    """Return a texture array of mip levels, each (layers, rows, columns, channels), or without the last axis for one.

    Each layer of the texture holds `stack_for` of the layers; `lib/layered.glsl` reads it.
    """
    return at_once(mipmapping(ctx, made))


def at_once(steps: Generator[None, None, Made]) -> Made:
    """Run all steps of a generator, and return its result."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            made: Made = end.value
            return made


def mipmapping(ctx: moderngl.Context, made: list[Bytes], /) -> Generator[None, None, moderngl.TextureArray]:
    """Do what `mipmapped` does in steps of about `PIECE` bytes, or of one layer; the first also allocates."""
    stack = stack_for(ctx, len(made[0]))
    if stack > 1:
        made = stacked(made, stack)
    layers, rows, columns, channels = (*made[0].shape, 1)[:4]
    texture = ctx.texture_array((columns, rows, layers), channels, alignment=1)
    stored, given = (ENUMS[name] for name in _FORMATS[channels])
    gl, target = functions_of(ctx), ENUMS["TEXTURE_2D_ARRAY"]
    gl.glBindTexture(target, texture.glo)
    for level, texels in enumerate(made[1:], 1):
        size = texels.shape[2], texels.shape[1], layers
        gl.glTexImage3D(target, level, stored, *size, 0, given, ENUMS["UNSIGNED_BYTE"], None)
    gl.glTexParameteri(target, ENUMS["TEXTURE_MAX_LEVEL"], len(made) - 1)
    texture.filter = (moderngl.NEAREST_MIPMAP_NEAREST, moderngl.LINEAR)
    with released_unless_finished(texture):
        for level, texels in enumerate(made):
            each = max(PIECE // texels[0].nbytes, 1)
            for first in range(0, layers, each):
                part = texels[first : first + each]
                size = texels.shape[2], texels.shape[1], len(part)
                gl.glBindTexture(target, texture.glo)
                gl.glPixelStorei(ENUMS["UNPACK_ALIGNMENT"], 1)
                data = part.ctypes.data
                gl.glTexSubImage3D(target, level, 0, 0, first, *size, given, ENUMS["UNSIGNED_BYTE"], data)
                if level == 0 or first + each < layers:
                    yield
    return texture


def mipmapped_image(ctx: moderngl.Context, made: Sequence[Bytes], /) -> moderngl.Texture:
    """Return a texture of an image's mip levels, each (rows, columns, channels), down to one texel.

    It is sampled from the nearest level: to interpolate between two levels costs twice as much.
    """
    rows, columns, channels = made[0].shape
    texture = ctx.texture((columns, rows), channels, made[0], alignment=1)
    stored, given = (ENUMS[name] for name in _FORMATS[channels])
    gl, target = functions_of(ctx), ENUMS["TEXTURE_2D"]
    gl.glBindTexture(target, texture.glo)
    gl.glPixelStorei(ENUMS["UNPACK_ALIGNMENT"], 1)
    for level, texels in enumerate(made[1:], 1):
        rows, columns = texels.shape[:2]
        gl.glTexImage2D(target, level, stored, columns, rows, 0, given, ENUMS["UNSIGNED_BYTE"], texels.ctypes.data)
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture


def halved(texels: Bytes, /) -> Bytes:
    """Return layers (layers, rows, columns, ...) of half the size: rounded means of 2 x 2 texels.

    An odd last row or column is left out.
    """
    whole = texels.astype(np.uint16)
    for axis in (1, 2):
        count = whole.shape[axis]
        first, second = (whole[(slice(None),) * axis + (slice(k, count - 1 + k, 2),)] for k in (0, 1))
        whole = first + second if count > 1 else 2 * whole
    return ((whole + 2) >> 2).astype(np.uint8)
