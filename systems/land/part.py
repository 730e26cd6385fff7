"""The feature of the land: textures of heights, densities and postures, and its values in the frame block."""

from collections.abc import Mapping, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.gl.stream import release_all
from ...engine.gl.texture import interpolated
from ...engine.memo import while_it_lives
from ...engine.terrain.record import Density
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Part
from ..grow.record import NOTHING, Growth
from ..space.grown import Grown
from .heights import Heights
from .record import write_land


@while_it_lives
def posture_table(growth: Growth, /) -> Floats:
    """Return a kind's posture table as `posture_texture` holds it, shape (variants, rows, points, 4)."""
    place = growth.postures.shape.astype(np.float32)
    return np.concatenate([place, np.gradient(place, axis=2)], axis=-1, dtype=np.float32)


def posture_texture(
    ctx: moderngl.Context, growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING
) -> moderngl.TextureArray:
    """Return all kinds' posture tables as a texture array: columns are points, rows posture indices, layers variants.

    While any kind is `coming`, a second set of layers follows, in which those kinds have their coming growths. A texel
    holds a point's position and the blade's tangent there, each as (along the bending direction, up).
    """
    forms = [*growths, *(coming.get(kind, growth) for kind, growth in enumerate(growths) if coming)]
    table = np.concatenate([posture_table(growth) for growth in forms])
    layers, rows, points, _ = table.shape
    return interpolated(ctx.texture_array((points, rows, layers), 4, table.tobytes(), dtype="f4"))


def density_texture(ctx: moderngl.Context, density: Density) -> moderngl.TextureArray:
    """Return the kinds' densities over the terrain as a texture array; a layer's channels hold four kinds."""
    kinds, rows, columns = density.maps.shape
    packed = np.zeros((-(-kinds // 4), rows, columns, 4), np.uint8)
    for kind, values in enumerate(density.maps):
        packed[kind // 4, ..., kind % 4] = np.round(values * 255.0)
    return interpolated(ctx.texture_array((columns, rows, len(packed)), 4, packed.tobytes(), alignment=1))


class Land(Feature):
    """Feature: the ground and the kinds of grass on it."""

    samplers = ("postures", "density", "heights")

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> "LandPart":
        """Return the part that holds the land's textures."""
        return LandPart(ctx, units)


class LandPart(Part):
    """Holds the textures of heights, densities and postures, and writes the land into the frame block."""

    def __init__(self, ctx: moderngl.Context, units: Mapping[str, int]) -> None:
        self.ctx, self._units = ctx, units
        self.textures: dict[str, moderngl.Texture | moderngl.TextureArray] = {}
        self._grown: Grown | None = None
        self._heights: Heights | None = None
        self._kinds: Mapping[str, str | int] = {}

    def settle(self, grown: Grown, record: NDArray[np.void], /) -> None:
        """Upload a changed terrain, density or kind, and changed heights."""
        before, self._grown = self._grown, grown
        terrain = grown.ground.terrain
        if self._heights is None or self._heights.terrain is not terrain:
            release_all(self._heights)
            self._heights = Heights(self.ctx, terrain)
        elif self._heights.follow():
            record["terrain_origin"] = self._heights.origin
        if before is grown:
            return
        if before is None or before.ground.density.maps is not grown.ground.density.maps:
            self._put("density", density_texture(self.ctx, grown.ground.density))
        if before is None or (before.growths, before.coming) != (grown.growths, grown.coming):
            self._put("postures", posture_texture(self.ctx, grown.growths, grown.coming))
        write_land(record, grown)
        record["terrain_origin"] = self._heights.origin
        folds = any(kind.profile == "fold" for kind in grown.scene.grass.values())
        ground = grown.ground
        special = {"FOLDS": folds, "SLOPED": bool(ground.density.slopes), "MIRRORED": terrain.mirrored}
        self._kinds = {"KINDS": len(grown.growths), **{name: 1 for name, is_so in special.items() if is_so}}

    def defines(self) -> Mapping[str, str | int]:
        """Return the GLSL defines: number of kinds, whether any is folded, terrain sloped or mirrored."""
        return self._kinds

    def use(self) -> None:
        """Bind all textures."""
        assert self._heights is not None
        self._heights.texture.use(self._units["heights"])
        for name, texture in self.textures.items():
            texture.use(self._units[name])

    def _put(self, name: str, texture: moderngl.Texture | moderngl.TextureArray) -> None:
        """Replace a texture by its sampler's name."""
        if name in self.textures:
            self.textures[name].release()
        self.textures[name] = texture

    def release(self) -> None:
        """Release all textures."""
        release_all(*self.textures.values(), self._heights)
