"""The shadow maps of a game: which there are, and binding them."""

import logging
from collections.abc import Iterable, Mapping
from dataclasses import replace
from reprlib import repr as shortened

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...components.shadow_map import ShadowMap, texture_number
from ...engine.gl.functions import functions_of
from ...engine.gl.guest import borrow, guest_clip
from ...engine.gl.units import BORROWED
from ..around.outlook import Outlook
from ..frame.block import MAPS, FrameBlock
from ..frame.feature import Feature, Part

log = logging.getLogger("tallgrass")

UNITS = {f"map_{number}": unit for number, unit in enumerate(BORROWED)}
"""The texture unit of each map: they are a host's, and given back in the end."""


class Shadows(Feature):
    """What a game has handed in."""

    def __init__(self) -> None:
        self.maps: tuple[ShadowMap, ...] = ()

    def hand_in(self, maps: Iterable[ShadowMap], origin: tuple[float, float, float], /) -> None:
        """Let these count from the next frame on; raises TypeError for other things, ValueError for too many.

        Their matrices are of a world in which the scene's origin is at `origin`.
        """
        try:
            handed = tuple(maps)
        except TypeError:
            raise TypeError(f"shadow maps come in a list, as [ShadowMap(...)], not as {shortened(maps)}") from None
        for each in handed:
            if not isinstance(each, ShadowMap):
                raise TypeError(f"shadow maps are made as ShadowMap(texture, matrix), unlike {shortened(each)}")
        if len(handed) > MAPS:
            raise ValueError(f"there is room for {MAPS} shadow maps, not for {len(handed)}")
        moved = np.eye(4)
        moved[:3, 3] = origin
        self.maps = tuple(replace(each, matrix=each.matrix @ moved) for each in handed)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> "ShadowPart":
        """Return what binds them."""
        del block, units
        return ShadowPart(ctx, self)


class ShadowPart(Part):
    """Binds the maps, each read as a sampler of its own says, so that a texture's own state does not count."""

    def __init__(self, ctx: moderngl.Context, shadows: Shadows) -> None:
        self._ctx, self._shadows, self._gl = ctx, shadows, functions_of(ctx)
        self._samplers = [
            ctx.sampler(repeat_x=False, repeat_y=False, filter=(moderngl.LINEAR, moderngl.LINEAR), compare_func=passes)
            for passes in ("<=", ">=")
        ]
        self._bound: list[tuple[ShadowMap, bool]] = []
        """Each with whether its depth is reversed."""
        self._none = ctx.depth_texture((1, 1))
        self._most = 0
        """How many there have been. Where there are fewer now, as by night, `_none` stands in for the others: drivers
        compile programs anew where what they may read as a shadow map is another sort of texture."""
        self._told: set[int] = set()

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that there is one."""
        record["maps_shown"] = 1.0

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Write where the maps lie, of those whose textures are there."""
        del outlook
        sun = np.asarray(record["sun"][0], np.float64)
        self._bound = [(each, nears(each.matrix, sun)) for each in self._shadows.maps if self._is_there(each)]
        self._most = max(self._most, len(self._bound))
        record["maps_shown"] = len(self._bound)
        for into, (each, _) in zip(record["maps"][0], self._bound, strict=False):
            into["clip_of"], into["bias"] = guest_clip(each.matrix).T.reshape(16), each.bias

    def _is_there(self, given: ShadowMap) -> bool:
        texture, number = given.texture, texture_number(given.texture)
        is_gone = isinstance(getattr(texture, "mglo", None), moderngl.InvalidObject) or not self._gl.glIsTexture(number)
        if is_gone and number not in self._told:
            self._told.add(number)
            log.warning("texture %d of a shadow map has been released: the prairie is drawn without it", number)
        return not is_gone

    def use(self) -> None:
        """Bind them for this frame."""
        for unit, (each, is_reversed) in zip(BORROWED, self._bound, strict=False):
            borrow(unit, texture_number(each.texture))
            self._samplers[is_reversed].use(unit)
        for unit in BORROWED[len(self._bound) : self._most]:
            borrow(unit, self._none.glo)
            self._samplers[False].use(unit)

    def release(self) -> None:
        """Give the samplers back."""
        for each in self._samplers:
            each.release()
        self._none.release()


def nears(matrix: Doubles, sun: Doubles, /) -> bool:
    """Return whether depth grows toward the sun in a map of this matrix: so it does where depth is reversed."""
    depth, far = matrix[2, :3] @ sun, matrix[3, :3] @ sun
    middle = np.linalg.lstsq(matrix, np.array((0.0, 0.0, 0.5, 1.0)))[0] if far else np.array((0.0, 0.0, 0.0, 1.0))
    return bool(depth * (matrix[3] @ middle) > far * (matrix[2] @ middle))
