"""Drawing of the sky, and writing of the light into the frame block."""

from collections.abc import Mapping, Sequence
from math import cos, radians, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.declared.grass import GrassKind
from ...engine.declared.light import Light
from ...engine.gl.stream import release_all
from ...engine.gl.texture import interpolated
from ...engine.terrain.record import Terrain
from ..around.outlook import Outlook
from ..frame.block import FrameBlock, joined
from ..frame.feature import Part
from ..space.grown import Grown
from .clouds import clouds_of
from .cloudscape import Cloudscape
from .daylight import Daylight
from .lie import LieMap
from .materials import grain, pigment, side_contrast
from .repeating import drifted, repeating_texture
from .shining import Shining
from .sky import COLUMNS, ROWS
from .stars import Stars
from .sun import sun_at

GRID_COLUMNS, GRID_ROWS = 48, 48
"""Columns and rows of the grid over the picture at whose corners the sky map is sampled."""

GRID: dict[str, str | int] = {"ACROSS": GRID_COLUMNS, "UP": GRID_ROWS}


class LightPart(Part):
    """Holds the stars, the maps of sky, clouds and litter, and the terrain's slope and horizon maps; draws the sky."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], shining: Shining) -> None:
        self.ctx, self._units, self._shining = ctx, units, shining
        self._grown: Grown | None = None
        self._lit: Daylight | None = None
        self._leaps = 0
        program = joined(ctx, block, units, "systems/light/sky.vert", "systems/light/sky.frag", GRID)
        self._array = ctx.vertex_array(program, [])
        self._sky = interpolated(ctx.texture((COLUMNS, ROWS), 3, dtype="f4"))
        self._clouds, self._stars = Cloudscape(ctx, block, units), Stars(ctx, block, units)
        self._repeating: moderngl.Texture | None = None
        self.lie = LieMap(ctx, block, units)
        self._toward = 0.0, -1.0

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Set a cloud cover and a light of stars, so that rehearsals draw clouds and stars."""
        record["cloud_edge"], record["starlight"] = 0.5, 1.0

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Take over a changed terrain or seed, and the present light."""
        before, self._grown = self._grown, grown
        self._clouds.coarse = grown.quality.coarse
        if before is not grown and not (
            before and before.ground.terrain is grown.ground.terrain and before.scene.seed == grown.scene.seed
        ):
            self._lay(grown.ground.terrain, seed=grown.scene.seed)
        x, z = record["terrain_origin"][0].tolist()
        record["lie_origin"] = self.lie.follow((x, z))
        shining, light = self._shining, self._shining.light
        if shining.leaps != self._leaps:
            self.lie.leap()
        if shining.daylight is not self._lit or before is not grown:
            write_light(record, light, shining.daylight, list(grown.scene.grass.values()))
            self._stars.shine(light, shining.daylight, record)
            self._toward = toward_sun(light)
        if shining.daylight is not self._lit:
            self._sky.write(shining.daylight.sky.map.astype(np.float32))
        self._leaps, self._lit = shining.leaps, shining.daylight

    def _lay(self, terrain: Terrain, *, seed: int) -> None:
        """Make the maps of a terrain and a seed."""
        self.lie.lay(terrain, seed=seed)
        release_all(self._repeating)
        self._repeating = repeating_texture(self.ctx, seed=seed)
        self._clouds.lay(seed=seed)
        self._stars.lay(seed=seed)

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Write the clouds' drift."""
        assert self._grown is not None
        record[0]["clouds_drift"] = drifted(self._grown.scene.wind, outlook.viewer.time)

    def use(self) -> None:
        """Bind all textures but the sky map, whose unit others use until `draw_behind`."""
        assert self._repeating is not None
        self.lie.use()
        self._repeating.use(self._units["repeating"])

    def prepare(self) -> int:
        """Update the terrain's slope and horizon maps; return the number of draw calls."""
        return self.lie.prepare(self._toward)

    def prepare_behind(self) -> int:
        """Draw the clouds' picture; return the number of draw calls."""
        return self._clouds.draw()

    def draw_behind(self) -> int:
        """Draw the sky, and the stars by night, behind everything else; return the number of draw calls."""
        self._sky.use(self._units["sky"])
        self._clouds.use()
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=2 * (GRID_COLUMNS + 1), instances=GRID_ROWS)
        return 1 + self._stars.draw()

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self._array, self._array.program, self._sky, self._clouds, self._stars, self.lie, self._repeating)


def write_light(record: NDArray[np.void], declared: Light, light: Daylight, kinds: Sequence[GrassKind], /) -> None:
    """Write `light`, which a scene `declared`, and what depends on it in kinds of grass, into the frame block."""
    row = record[0]
    row["sun"], row["sunlight"], row["skylight"] = light.direction, light.sun, light.down
    row["cloud_edge"], row["haze_density"] = clouds_of(declared.clouds).edge, 1.0 / declared.haze
    row["exposure"], row["lamplight"], row["cloudlight"] = light.exposure, light.lamplight, light.clouds
    row["groundlight"] = light.sky.ground
    row["zenith"] = light.sky.map[-1].mean(axis=0)
    row["horizon"][:, :3] = light.sky.horizon
    row["toward_sun"] = toward_sun(declared)
    row["soil"] = pigment(declared.ground)
    for index, kind in enumerate(kinds):
        row["kinds"]["grain_c"][index], row["kinds"]["grain_s"][index] = grain(kind, light)
        row["kinds"]["apart"][index] = side_contrast(kind, light)


def toward_sun(light: Light, /) -> tuple[float, float]:
    """Return the horizontal direction (x, z) to the sun, unit length."""
    azimuth = radians(sun_at(light)[0])
    return sin(azimuth), -cos(azimuth)
