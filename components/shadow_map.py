"""A game's own shadow map of the sun."""

from dataclasses import dataclass
from reprlib import repr as shortened
from typing import Any

import numpy as np

from .arrays import Doubles
from .footprint import is_between
from .immutable import immutable

FARTHEST_BIAS = 100.0
"""Greatest bias of a shadow map [m]."""


@immutable
@dataclass(frozen=True, slots=True, eq=False)
class ShadowMap:
    """A game's own shadow map: a depth texture that it draws from the sun.

    Raises TypeError for anything but a depth texture, ValueError for a bad matrix or bias.
    """

    texture: Any
    """A 2D depth texture of moderngl or pyglet, or its number in GL. Its filters and compare mode do not matter."""

    matrix: Any
    """Matrix from the world to the map's clip space: projection @ view, (4, 4), or pyglet's `Mat4`."""

    bias: float = 0.05
    """Distance by which places are moved towards the sun, against self-shadowing, 0 to 100 [m]."""

    def __post_init__(self) -> None:
        """Raise TypeError and ValueError as above."""
        texture_number(self.texture, "a shadow map's texture is a 2D depth texture")
        if getattr(self.texture, "depth", True) is False:
            raise TypeError(f"a shadow map's texture is a depth texture, not one of colours: {shortened(self.texture)}")
        object.__setattr__(self, "matrix", _matrix(self.matrix))
        if not is_between(0.0, self.bias, FARTHEST_BIAS):
            raise ValueError(f"a shadow map's bias is from 0 to {FARTHEST_BIAS:g} m, not {shortened(self.bias)}")


def texture_number(texture: object, what: str = "a texture is a 2D one", /) -> int:
    """Return the number in GL of a game's 2D texture; raises TypeError for anything else, as it is not `what`."""
    held = (getattr(texture, name, None) for name in ("glo", "id", "value"))  # moderngl's, pyglet's, or a `c_uint`
    number = next((found for found in held if found is not None), texture)
    is_other = type(texture).__name__ in {"TextureArray", "TextureCube", "Texture3D"}
    if not isinstance(number, int) or isinstance(number, bool) or number < 1 or is_other:
        raise TypeError(f"{what} of moderngl or pyglet, or its number in GL, not {shortened(texture)}")
    return number


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
