"""Drawing what light comes from: the sky, and over the terrain a map of how it lies to the sun."""

from collections.abc import Mapping

import moderngl
import numpy as np

from ...engine.gl.stream import release_all
from ...engine.terrain.record import Terrain
from ..frame.block import FrameBlock, joined
from .daylight import Daylight
from .lie import LieMap
from .repeating import repeating_texture
from .sky import COLUMNS, ROWS

SAMPLERS = ("lie", "repeating", "sky")
"""What programs read of it. `sky` is read by the sky alone."""

ACROSS, UP = 48, 48
"""Squares across and up the picture, at whose corners the sky's colour is looked up."""

GRID: dict[str, str | int] = {"ACROSS": ACROSS, "UP": UP}


class LightPainter:
    """Holds the sky's colours, clouds and litter, and how the terrain lies to the sun; draws the sky."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx, self._units = ctx, units
        self._skies = tuple(
            joined(ctx, block, units, "systems/light/sky.vert", "systems/light/sky.frag", GRID | clouds)
            for clouds in ({}, {"CLOUDS": 1})
        )
        self._arrays = [ctx.vertex_array(each, []) for each in self._skies]
        self._sky = _sky_texture(ctx)
        self._repeating: moderngl.Texture | None = None
        self.lie = LieMap(ctx, block, units)
        self._toward = 0.0, -1.0
        self._cloudy = False

    def lay(self, terrain: Terrain, *, seed: int) -> None:
        """Take over another terrain, or another seed."""
        self.lie.lay(terrain, seed=seed)
        if self._repeating is not None:
            self._repeating.release()
        self._repeating = repeating_texture(self.ctx, seed=seed)

    def shine(self, light: Daylight, /, *, toward: tuple[float, float], clouds: float) -> None:
        """Take over another light; `toward` is the direction over the ground that its sun stands in (x, z)."""
        self._sky.write(light.sky.map.astype(np.float32))
        self._toward, self._cloudy = toward, clouds > 0.0

    def use(self) -> None:
        """Bind what programs read, but for the sky's own: its unit is another's until it is drawn."""
        assert self._repeating is not None
        self.lie.use()
        self._repeating.use(self._units["repeating"])

    def prepare(self) -> int:
        """Draw what is due of how the terrain lies to the sun; return the number of draw calls."""
        return self.lie.prepare(self._toward)

    def draw(self) -> int:
        """Draw the sky behind all that has been drawn; return the number of draw calls."""
        self._sky.use(self._units["sky"])
        self._arrays[self._cloudy].render(moderngl.TRIANGLE_STRIP, vertices=2 * (ACROSS + 1), instances=UP)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._arrays, *self._skies, self._sky, self.lie)
        if self._repeating is not None:
            self._repeating.release()


def _sky_texture(ctx: moderngl.Context) -> moderngl.Texture:
    """Return a texture for the map of the sky."""
    texture = ctx.texture((COLUMNS, ROWS), 3, dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
