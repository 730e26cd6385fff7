"""Drawing what light comes from, the sky, and what every program knows of that light."""

from collections.abc import Mapping, Sequence
from math import cos, radians, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.declared.grass import GrassKind
from ...engine.declared.light import Light
from ...engine.gl.stream import release_all
from ...engine.terrain.record import Terrain
from ..around.outlook import Outlook
from ..frame.block import FrameBlock, joined
from ..frame.feature import Part
from ..space.grown import Grown
from .clouds import clouds_of
from .cloudscape import Cloudscape
from .daylight import Daylight
from .lie import LieMap
from .materials import apart, grain, pigment
from .repeating import drifted, repeating_texture
from .shining import Shining
from .sky import COLUMNS, ROWS
from .sun import sun_at

ACROSS, UP = 48, 48
"""Squares across and up the picture, at whose corners the sky's colour is looked up."""

GRID: dict[str, str | int] = {"ACROSS": ACROSS, "UP": UP}


class LightPart(Part):
    """Holds the sky's colours, clouds and litter, and how the terrain lies to the sun; draws the sky."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], shining: Shining) -> None:
        self.ctx, self._units, self._shining = ctx, units, shining
        self._grown: Grown | None = None
        self._lit: Daylight | None = None
        self._leaps = 0
        program = joined(ctx, block, units, "systems/light/sky.vert", "systems/light/sky.frag", GRID)
        self._array = ctx.vertex_array(program, [])
        self._sky = _sky_texture(ctx)
        self._clouds = Cloudscape(ctx, block, units)
        self._repeating: moderngl.Texture | None = None
        self.lie = LieMap(ctx, block, units)
        self._toward = 0.0, -1.0

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that there are clouds."""
        record["cloud_edge"] = 0.5

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over another terrain or seed, and the light as it is by now."""
        before, self._grown = self._grown, grown
        self._clouds.coarse = grown.quality.coarse
        if before is not grown and not (
            before and before.ground.terrain is grown.ground.terrain and before.scene.seed == grown.scene.seed
        ):
            self._lay(grown.ground.terrain, seed=grown.scene.seed)
        record["lie_origin"] = self.lie.follow(_pair(record["terrain_origin"][0]))
        now, light = self._shining, self._shining.light
        if now.leaps != self._leaps:
            self.lie.leap()
        if now.daylight is not self._lit or before is not grown:
            shine(record, light, now.daylight, list(grown.scene.grass.values()))
            self._toward = toward_sun(light)
        if now.daylight is not self._lit:
            self._sky.write(now.daylight.sky.map.astype(np.float32))
        self._leaps, self._lit = now.leaps, now.daylight

    def _lay(self, terrain: Terrain, *, seed: int) -> None:
        self.lie.lay(terrain, seed=seed)
        release_all(self._repeating)
        self._repeating = repeating_texture(self.ctx, seed=seed)
        self._clouds.lay(seed=seed)

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Write how far the clouds have drifted."""
        assert self._grown is not None
        record[0]["clouds_drift"] = drifted(self._grown.scene.wind, outlook.viewer.time)

    def use(self) -> None:
        """Bind what programs read, but for the sky's own: its unit is another's until it is drawn."""
        assert self._repeating is not None
        self.lie.use()
        self._repeating.use(self._units["repeating"])

    def prepare(self) -> int:
        """Draw what is due of how the terrain lies to the sun; return the number of draw calls."""
        return self.lie.prepare(self._toward)

    def look_up(self) -> int:
        """Draw the clouds that are seen; return the number of draw calls."""
        return self._clouds.draw()

    def draw_behind(self) -> int:
        """Draw the sky behind all that has been drawn; return the number of draw calls."""
        self._sky.use(self._units["sky"])
        self._clouds.use()
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=2 * (ACROSS + 1), instances=UP)
        return 1

    def release(self) -> None:
        """Give everything back."""
        release_all(self._array, self._array.program, self._sky, self._clouds, self.lie, self._repeating)


def _pair(place: Floats) -> tuple[float, float]:
    x, z = place.tolist()
    return x, z


def _sky_texture(ctx: moderngl.Context) -> moderngl.Texture:
    """Return a texture for the map of the sky."""
    texture = ctx.texture((COLUMNS, ROWS), 3, dtype="f4")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def shine(record: NDArray[np.void], declared: Light, light: Daylight, kinds: Sequence[GrassKind], /) -> None:
    """Write the light that is `declared`, and what it does to the kinds of grass."""
    row = record[0]
    row["sun"], row["sunlight"], row["skylight"] = light.direction, light.sun, light.down
    row["cloud_edge"], row["haze_density"] = clouds_of(declared.clouds).edge, 1.0 / declared.haze
    row["exposure"], row["lamplight"], row["cloudlight"] = light.exposure, light.lamplight, light.clouds
    row["zenith"] = light.sky.map[-1].mean(axis=0)
    row["horizon"][:, :3] = light.sky.horizon
    row["toward_sun"] = toward_sun(declared)
    row["soil"] = pigment(declared.ground)
    for index, kind in enumerate(kinds):
        row["kinds"]["grain_c"][index], row["kinds"]["grain_s"][index] = grain(kind, light)
        row["kinds"]["apart"][index] = apart(kind, light)


def toward_sun(light: Light, /) -> tuple[float, float]:
    """Return the direction over the ground that the sun stands in (x, z)."""
    azimuth = radians(sun_at(light)[0])
    return sin(azimuth), -cos(azimuth)
