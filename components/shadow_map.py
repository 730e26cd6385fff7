"""What a game knows of the sun's shadows."""

from dataclasses import dataclass
from reprlib import repr as shortened
from typing import Any

import numpy as np

from .arrays import Doubles
from .footprint import is_between

FARTHEST_BIAS = 100.0
"""How much nearer to the sun places are taken at most than they are [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class ShadowMap:
    """A shadow map of a game's: what is nearest to the sun, in a depth texture that the game draws.

    Raises TypeError for anything but a depth texture, ValueError for a bad matrix or bias.
    """

    texture: Any
    """A 2D depth texture: moderngl's, pyglet's, or its number in GL. Its filters and its compare mode do not count."""

    matrix: Any
    """World to the map's clip space, as it was drawn: projection @ view, (4, 4), or pyglet's `Mat4`."""

    bias: float = 0.05
    """How much nearer to the sun places are taken than they are, so that nothing shades itself, 0 to 100 [m]."""

    def __post_init__(self) -> None:
        """Raise TypeError and ValueError as above."""
        texture_number(self.texture)
        object.__setattr__(self, "matrix", _matrix(self.matrix))
        if not is_between(0.0, self.bias, FARTHEST_BIAS):
            raise ValueError(f"a shadow map's bias is from 0 to {FARTHEST_BIAS:g} m, not {shortened(self.bias)}")


def texture_number(texture: object, /) -> int:
    """Return a texture's number in GL; raises TypeError for what is no depth texture."""
    number = held_number(texture)
    if not isinstance(number, int) or isinstance(number, bool) or number < 1:
        raise TypeError(
            "a shadow map's texture is a depth texture of moderngl or pyglet, or its number in GL, "
            f"not {shortened(texture)}"
        )
    if getattr(texture, "depth", True) is False or type(texture).__name__ in {
        "TextureArray",
        "TextureCube",
        "Texture3D",
    }:
        raise TypeError(
            f"a shadow map's texture is a 2D depth texture, not one of colours or layers: {shortened(texture)}"
        )
    return number


def held_number(texture: object, /) -> object:
    """Return the number that a texture of moderngl or pyglet holds, or a `c_uint`; anything else as it is."""
    held = (getattr(texture, name, None) for name in ("glo", "id", "value"))
    return next((found for found in held if found is not None), texture)


def _matrix(matrix: object) -> Doubles:
    """Return a matrix for column vectors, (4, 4); raises ValueError for anything else."""
    try:
        array = np.asarray(matrix, np.float64)
    except (TypeError, ValueError):
        array = np.zeros(0)
    if array.shape == (16,):  # pyglet's, column by column
        array = array.reshape(4, 4).T
    if array.shape != (4, 4):
        raise ValueError(f"a shadow map's matrix is 4x4, not {shortened(matrix)}")
    if not np.isfinite(array).all():
        raise ValueError("a shadow map's matrix is finite numbers, not NaN or infinity")
    return array
