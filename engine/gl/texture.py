"""Textures by how shaders read them: texel by texel, or interpolated and clamped at the edges."""

from typing import TypeVar

import moderngl

from .functions import Functions

Texture = TypeVar("Texture", moderngl.Texture, moderngl.TextureArray)


def by_texel(texture: Texture, /) -> Texture:
    """Let shaders read single texels of a texture; return it."""
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def interpolated(texture: Texture, /) -> Texture:
    """Let shaders read a texture interpolated between texels, and clamped at its edges; return it."""
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def is_released(texture: object, number: int, gl: Functions, /) -> bool:
    """Return whether a game's texture, or number of one in GL, names nothing that is there any more."""
    return isinstance(getattr(texture, "mglo", None), moderngl.InvalidObject) or not gl.glIsTexture(number)
