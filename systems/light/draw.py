"""Drawing what light comes from: the sky, and over the terrain a map of how it lies to the sun."""

from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.declared.light import Light
from ...engine.gl.stream import release_all
from ...engine.terrain.record import Terrain
from ..frame.block import FrameBlock, joined
from ..frame.maps import laid_over, map_shape, slow_map
from .daylight import daylight
from .repeating import repeating_texture

SAMPLERS = ("lie", "repeating", "sky")
"""What programs read of it. `sky` is read by the sky alone."""

ACROSS, UP = 48, 48
"""Squares across and up the picture, at whose corners the sky's colour is looked up."""

GRID: dict[str, str | int] = {"ACROSS": ACROSS, "UP": UP}

FILLED = "engine/gl/fill.vert"


class LightPainter:
    """Holds the sky's colours, clouds and litter, and how the terrain lies to the sun; draws the sky."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx, self._units = ctx, units
        self._skies = tuple(
            joined(ctx, block, units, "systems/light/sky.vert", "systems/light/sky.frag", GRID | clouds)
            for clouds in ({}, {"CLOUDS": 1})
        )
        self._cast = joined(ctx, block, {**units, "slow": units["lie"]}, FILLED, "systems/light/lie.frag", {})
        self._arrays = [ctx.vertex_array(each, []) for each in (*self._skies, self._cast)]
        self._cloudy = False
        self._textures: dict[str, moderngl.Texture] = {}
        self._due: Terrain | None = None

    def lay(self, terrain: Terrain, *, seed: int) -> None:
        """Take over another terrain, or another seed."""
        self._put("slow", laid_over(self.ctx, slow_map(terrain, seed=seed)))
        rows, columns = map_shape(terrain.size)
        self._put("lie", laid_over(self.ctx, np.zeros((rows, columns, 4), np.uint8)))
        self._put("repeating", repeating_texture(self.ctx, seed=seed))

    def shine(self, light: Light, terrain: Terrain) -> None:
        """Take over another light, or another terrain under it; its shadows are drawn with the next frame."""
        self._put("sky", _sky_texture(self.ctx, daylight(light).sky.map))
        self._due, self._cloudy = terrain, light.clouds > 0.0

    def _put(self, name: str, texture: moderngl.Texture) -> None:
        if name in self._textures:
            self._textures[name].release()
        self._textures[name] = texture

    def use(self) -> None:
        """Bind what programs read, but for the sky's own: its unit is another's until it is drawn."""
        for name in SAMPLERS[:2]:
            self._textures[name].use(self._units[name])

    def prepare(self) -> int:
        """Draw the terrain's shadows where sun or ground have changed; return the number of draw calls."""
        if self._due is None:
            return 0
        self._cast["highest"] = float(self._due.heights.max())
        self._due = None
        target = self.ctx.framebuffer([self._textures["lie"]])
        self._textures["slow"].use(self._units["lie"])
        target.use()
        self._arrays[2].render(moderngl.TRIANGLES, vertices=3)
        target.release()
        self._textures["lie"].use(self._units["lie"])
        return 1

    def draw(self) -> int:
        """Draw the sky behind all that has been drawn; return the number of draw calls."""
        self._textures["sky"].use(self._units["sky"])
        self._arrays[self._cloudy].render(moderngl.TRIANGLE_STRIP, vertices=2 * (ACROSS + 1), instances=UP)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._arrays, *self._skies, self._cast, *self._textures.values())


def _sky_texture(ctx: moderngl.Context, colors: NDArray[np.float64]) -> moderngl.Texture:
    rows, columns, _ = colors.shape
    texture = ctx.texture((columns, rows), 3, colors.astype(np.float32).tobytes(), dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
