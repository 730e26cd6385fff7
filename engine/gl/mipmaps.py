"""Textures whose mip-maps are made here.

So they are the same with every driver; and a software one would have to compile a program for each shape of texture
first, which takes longer than the averages do.
"""

from collections.abc import Generator, Sequence
from typing import TypeVar

import moderngl
import numpy as np

from ...components.arrays import Bytes
from .functions import NUMBERS, functions_of
from .limits import limits_of

Made = TypeVar("Made")

PIECE = 1 << 21
"""Bytes that are sent at a time where a frame must not wait."""

_FORMATS = {1: ("R8", "RED"), 2: ("RG8", "RG"), 3: ("RGB8", "RGB"), 4: ("RGBA8", "RGBA")}


def levels(texels: Bytes, /) -> list[Bytes]:
    """Return layers (layers, rows, columns, ...) and their halves, down to one texel."""
    found = [np.ascontiguousarray(texels)]
    while max(found[-1].shape[1:3]) > 1:
        found.append(halved(found[-1]))
    return found


def stack_for(ctx: moderngl.Context, layers: int, /) -> int:
    """Return how many layers have to lie in one for a texture to have room for all: OpenGL promises 256 alone."""
    return -(-layers // limits_of(functions_of(ctx)).layers)


def stacked(texels: Bytes, stack: int, /) -> list[Bytes]:
    """Return `levels` of layers of which `stack` lie in one, each on top of the one before, down to one row of each.

    Their rows are as many as the next power of two, so that none shares a texel with another.
    """
    rows = texels.shape[1]
    whole = 1 << (rows - 1).bit_length()
    padded = np.pad(texels, [(0, -len(texels) % stack), (0, whole - rows), *[(0, 0)] * (texels.ndim - 2)])
    made = levels(padded)[: whole.bit_length()]
    return [each.reshape(len(each) // stack, stack * each.shape[1], *each.shape[2:]) for each in made]


def mipmapped(ctx: moderngl.Context, made: list[Bytes], /) -> moderngl.TextureArray:
    """Return a texture of `levels` of layers (layers, rows, columns, 4), or of one channel without the last axis.

    There are `stack_for` of them in each layer of the texture; `lib/layered.glsl` reads it.
    """
    return at_once(mipmapping(ctx, made))


def at_once(steps: Generator[None, None, Made]) -> Made:
    """Do all steps of something, and return what it makes."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            made: Made = end.value
            return made


def mipmapping(ctx: moderngl.Context, made: list[Bytes], /) -> Generator[None, None, moderngl.TextureArray]:
    """Do what `mipmapped` does a piece at a time: no piece is more than `PIECE` bytes, or a layer, after the first."""
    stack = stack_for(ctx, len(made[0]))
    if stack > 1:
        made = stacked(made[0], stack)
    layers, rows, columns, channels = (*made[0].shape, 1)[:4]
    texture = ctx.texture_array((columns, rows, layers), channels, alignment=1)
    stored, given = (NUMBERS[name] for name in _FORMATS[channels])
    gl, target = functions_of(ctx), NUMBERS["TEXTURE_2D_ARRAY"]
    gl.glBindTexture(target, texture.glo)
    for level, texels in enumerate(made[1:], 1):
        size = texels.shape[2], texels.shape[1], layers
        gl.glTexImage3D(target, level, stored, *size, 0, given, NUMBERS["UNSIGNED_BYTE"], None)
    gl.glTexParameteri(target, NUMBERS["TEXTURE_MAX_LEVEL"], len(made) - 1)
    texture.filter = (moderngl.NEAREST_MIPMAP_NEAREST, moderngl.LINEAR)
    for level, texels in enumerate(made):
        each = max(PIECE // texels[0].nbytes, 1)
        for first in range(0, layers, each):
            part = texels[first : first + each]
            size = texels.shape[2], texels.shape[1], len(part)
            gl.glBindTexture(target, texture.glo)
            gl.glPixelStorei(NUMBERS["UNPACK_ALIGNMENT"], 1)
            data = part.ctypes.data
            gl.glTexSubImage3D(target, level, 0, 0, first, *size, given, NUMBERS["UNSIGNED_BYTE"], data)
            if level == 0 or first + each < layers:
                yield
    return texture


def mipmapped_image(ctx: moderngl.Context, made: Sequence[Bytes], /) -> moderngl.Texture:
    """Return a texture of one image at all its levels, each (rows, columns, channels), down to one texel.

    It is read from one level at a time: who reads two and mixes them pays for two.
    """
    rows, columns, channels = made[0].shape
    texture = ctx.texture((columns, rows), channels, made[0], alignment=1)
    stored, given = (NUMBERS[name] for name in _FORMATS[channels])
    gl, target = functions_of(ctx), NUMBERS["TEXTURE_2D"]
    gl.glBindTexture(target, texture.glo)
    gl.glPixelStorei(NUMBERS["UNPACK_ALIGNMENT"], 1)
    for level, texels in enumerate(made[1:], 1):
        rows, columns = texels.shape[:2]
        gl.glTexImage2D(target, level, stored, columns, rows, 0, given, NUMBERS["UNSIGNED_BYTE"], texels.ctypes.data)
    texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
    return texture


def halved(texels: Bytes, /) -> Bytes:
    """Return the means of two by two texels (layers, rows, columns, ...), rounded; an odd last one is left out."""
    whole = texels.astype(np.uint16)
    for axis in (1, 2):
        count = whole.shape[axis]
        first, second = (whole[(slice(None),) * axis + (slice(k, count - 1 + k, 2),)] for k in (0, 1))
        whole = first + second if count > 1 else 2 * whole
    return ((whole + 2) >> 2).astype(np.uint8)
