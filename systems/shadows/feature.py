"""The feature of a game's shadow maps: it binds them and writes them into the frame block."""

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
from ...engine.gl.stream import release_all
from ...engine.gl.texture import is_released
from ...engine.gl.units import BORROWED
from ..around.outlook import Outlook
from ..frame.block import MAPS, FrameBlock
from ..frame.feature import Feature, Part, Start

log = logging.getLogger("tallgrass")

UNITS = {f"map_{number}": unit for number, unit in enumerate(BORROWED)}
"""Texture unit of each map's sampler. The units belong to the host and are restored."""


class Shadows(Feature):
    """Feature: shadow maps that a game has handed in."""

    def __init__(self, start: Start, /) -> None:
        self.maps: tuple[ShadowMap, ...] = ()

    def hand_in(self, maps: Iterable[ShadowMap], origin: tuple[float, float, float], /) -> None:
        """Use these maps from the next frame on; raise TypeError for other things, ValueError for too many.

        Their matrices are for a world with the scene's origin at `origin`.
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
        """Return the part that binds the maps."""
        return ShadowPart(ctx, self)


class ShadowPart(Part):
    """Binds the maps with sampler objects, which override the textures' own state."""

    def __init__(self, ctx: moderngl.Context, shadows: Shadows) -> None:
        self._ctx, self._shadows, self._gl = ctx, shadows, functions_of(ctx)
        self._samplers = [
            ctx.sampler(repeat_x=False, repeat_y=False, filter=(moderngl.LINEAR, moderngl.LINEAR), compare_func=passes)
            for passes in ("<=", ">=")
        ]
        self._bound: list[tuple[ShadowMap, bool]] = []
        """Maps of this frame, each with whether its depth is reversed."""
        self._none = ctx.depth_texture((1, 1))
        self._most = 0
        """Largest number of maps so far. With fewer, as by night, `_none` takes the free units: drivers recompile
        programs when a shadow sampler's unit holds another sort of texture."""
        self._reported: set[int] = set()
        """GL names of textures whose release has been logged."""

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Set one map."""
        record["maps_shown"] = 1.0

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Write the matrices and biases of the maps whose textures exist."""
        sun = np.asarray(record["sun"][0], np.float64)
        present = [each for each in self._shadows.maps if self._is_there(each)]
        self._bound = [(each, is_reversed_depth(each.matrix, sun)) for each in present]
        self._most = max(self._most, len(self._bound))
        record["maps_shown"] = len(self._bound)
        for into, (each, _) in zip(record["maps"][0], self._bound, strict=False):
            into["clip_of"], into["bias"] = guest_clip(each.matrix).T.reshape(16), each.bias

    def _is_there(self, given: ShadowMap) -> bool:
        """Return whether a map's texture exists in GL; log a released one once."""
        number = texture_number(given.texture)
        is_gone = is_released(given.texture, number, self._gl)
        if is_gone and number not in self._reported:
            self._reported.add(number)
            log.warning("texture %d of a shadow map has been released: the prairie is drawn without it", number)
        return not is_gone

    def use(self) -> None:
        """Bind the maps for this frame."""
        for unit, (each, is_reversed) in zip(BORROWED, self._bound, strict=False):
            borrow(unit, texture_number(each.texture))
            self._samplers[is_reversed].use(unit)
        for unit in BORROWED[len(self._bound) : self._most]:
            borrow(unit, self._none.glo)
            self._samplers[False].use(unit)

    def release(self) -> None:
        """Release samplers and the stand-in texture."""
        release_all(*self._samplers, self._none)


def is_reversed_depth(matrix: Doubles, sun: Doubles, /) -> bool:
    """Return whether depth in a map with this matrix grows toward the sun, as reversed depth does."""
    depth, far = matrix[2, :3] @ sun, matrix[3, :3] @ sun
    middle = np.linalg.lstsq(matrix, np.array((0.0, 0.0, 0.5, 1.0)))[0] if far else np.array((0.0, 0.0, 0.0, 1.0))
    return bool(depth * (matrix[3] @ middle) > far * (matrix[2] @ middle))
