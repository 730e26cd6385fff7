"""Drawing a whole frame: ground, sky and carpet, then strips and blades from far to near."""

from collections.abc import Iterable, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from ..components.body import Body
from ..engine.camera import View
from ..engine.gl.guest import FIRST_UNIT, guest
from ..engine.gl.shaders import program
from ..engine.gl.stream import release_all
from .bodies.draw import BodyPainter
from .field import Field
from .frame.block import FrameBlock, aim, frame_record
from .frame.maps import density_texture, height_texture, posture_texture, tone_texture
from .show.blades.draw import CORES, EDGES, BladePainter
from .show.blades.gather import gather_blades
from .show.carpet.draw import RAISED, GroundPainter, finest_spacing, ground_tiles, within
from .show.carpet.textures import carpet_texture
from .around.appearance import BORDER
from .show.morph.draw import MorphPainter
from .show.seen import Seen
from .show.strips.draw import StripPainter
from .show.strips.gather import gather_strips, runs
from .show.strips.textures import strip_stock

NAMES = (
    "postures", "tone", "density", "heights", "images", "shares", "air", "atlas", "ranks", "strips", "edges", "targets",
)  # fmt: skip
UNITS = {name: unit for unit, name in enumerate(NAMES, FIRST_UNIT)}
"""The texture unit of each sampler."""

PARTED = 1
"""Distance up to which blades hide one another by depth [patch sides]."""

OVER = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)


class Painter:
    """Everything that one GL context holds of a field, and the drawing of it."""

    def __init__(self, ctx: moderngl.Context, field: Field) -> None:
        self.ctx = ctx
        self.block = FrameBlock(ctx)
        self.textures: dict[str, moderngl.Texture | moderngl.TextureArray] = {}
        self.sky = program(ctx, "systems/frame/sky.vert", "systems/frame/sky.frag")
        self.block.join(self.sky)
        self.sky_array = ctx.vertex_array(self.sky, [])
        self.bodies: BodyPainter | None = None
        self.draw_calls = 0
        self.runs: list[tuple[int, int, int, bool]] = []
        self.field = field
        self._lay(field)
        self._grow(field)
        self._light(field)

    def change(self, field: Field) -> None:
        """Draw another field from now on, one that was laid again; what has not changed stays in GL as it is."""
        before, self.field = self.field, field
        same_seed = field.scene.seed == before.scene.seed
        same_terrain = field.terrain is before.terrain and same_seed
        if not (same_terrain and field.density is before.density):
            self._lay(field)
        if not (same_seed and field.stock is before.stock and field.quality == before.quality):
            self._release_grass()
            self._grow(field)
        if self.bodies is not None and field.scene.light != before.scene.light:
            self.bodies.release()
            self.bodies = None
        self._light(field)

    def _light(self, field: Field) -> None:
        self._spacing = finest_spacing(field.terrain, field.quality.patch)
        self.record = frame_record(field.scene, field.growths, field.terrain, field.quality.patch)

    def _lay(self, field: Field) -> None:
        """Bring the ground into GL."""
        self._put("tone", tone_texture(self.ctx, field.terrain, seed=field.scene.seed))
        self._put("density", density_texture(self.ctx, field.density))
        self._put("heights", height_texture(self.ctx, field.terrain))

    def _put(self, name: str, texture: moderngl.Texture | moderngl.TextureArray) -> None:
        if name in self.textures:
            self.textures[name].release()
        self.textures[name] = texture

    def _grow(self, field: Field) -> None:
        """Bring the grass into GL."""
        self._put("postures", posture_texture(self.ctx, field.growths))
        self._put("images", carpet_texture(self.ctx, field.growths))
        self.ground = GroundPainter(
            self.ctx,
            self.block,
            field.growths,
            UNITS,
            side=field.table.side,
            seed=field.scene.seed,
            patch=field.quality.patch,
        )
        self.strips = [
            StripPainter(self.ctx, self.block, ring, strip_stock(field.growths, number), UNITS)
            for number, ring in enumerate(field.quality.strip_rings)
        ]
        rings, near = field.quality.blade_rings, PARTED * field.quality.patch
        self.blades = [
            self.blade_painter(fine.segments, soft=True, coarser=coarse.segments, near=near)
            for fine, coarse in zip(rings, rings[1:] + rings[-1:], strict=True)
        ]
        self.parted = 1 + sum(ring.to < PARTED for ring in rings[:-1])
        self.morph = MorphPainter(self.ctx, self.block, field, UNITS)

    def _release_grass(self) -> None:
        release_all(*self.blades, *self.strips, self.morph, self.ground)

    def blade_painter(
        self, segments: int, *, soft: bool, coarser: int | None = None, near: float = 0.0
    ) -> BladePainter:
        """Return a painter of blades with this many segments."""
        return BladePainter(self.ctx, self.block, segments, UNITS, soft=soft, coarser=coarser, near=near)

    def write_blades(self, seen: Seen) -> int:
        """Send the blades that are seen; return how many."""
        eye = self.field.sight.eye[0], self.field.sight.eye[2]
        for ring, painter in zip(seen.blades, self.blades, strict=True):
            painter.write(*gather_blades(self.field.blades, ring, eye=eye))
        return sum(painter.blades.count for painter in self.blades) + self.morph.write(self.field, seen)

    def write_strips(self, seen: Seen) -> None:
        """Send the strips that are seen."""
        field, fade = self.field, self.field.transitions.fade
        counts, thin = [], []
        for pool, ring, painter in zip(field.strips, seen.strips, self.strips, strict=True):
            thin.append(bool((pool.least[ring.slots] < 0.995).any()))
            records, count = gather_strips(pool, ring, seen.looks, field.table, field.sight.centre, fade=fade)
            painter.write(records)
            counts.append(count)
        self.runs = runs(seen.strips, counts, thin)

    def write_bodies(self, bodies: Sequence[Body]) -> None:
        """Send what flies over the prairie."""
        if self.bodies is None and bodies:
            self.bodies = BodyPainter(self.ctx, self.block, self.field.scene.light)
        if self.bodies is not None:
            self.bodies.write(bodies)

    def draw_carpet_everywhere(self, view: View) -> None:
        """Draw the carpet everywhere, at half the height of the grass, into the framebuffer that is bound."""
        field = self.field
        tiles = ground_tiles(field.terrain, field.sight.eye, field.sight.cone, spacing=self._spacing)
        self.ground.write(tiles, np.ones(len(tiles), np.bool_))
        self.ground.write_shares(np.ones(len(field.table.progress), np.float32), field.sight.centre)
        self.ground.raise_carpet(0.5)
        self.draw(view, blades=[])
        self.ground.raise_carpet(RAISED)

    def write_ground(self, carpet: NDArray[np.float32] | None) -> None:
        """Send the tiles of the ground, how much carpet lies on each patch, and how the wind bends its grass.

        `carpet` has shape (rows,); without it there is none.
        """
        field, sight = self.field, self.field.sight
        self.ground.blow(field.table.message, field.table.alive & field.table.visible)
        tiles = ground_tiles(field.terrain, sight.eye, sight.cone, spacing=self._spacing)
        near = within(tiles, sight.centre, patch=field.quality.patch, reach=field.reach[1] - int(BORDER) - 1)
        self.ground.write(tiles, np.zeros_like(near) if carpet is None else ~near)
        if carpet is not None:
            self.ground.write_shares(np.where(field.table.alive, carpet, np.float32(1.0)), sight.centre)

    def draw(self, view: View, *, blades: Iterable[BladePainter] | None = None) -> None:
        """Draw the frame into the framebuffer that the host has bound.

        With `blades`, these alone stand on the ground: no strips and no carpet.
        """
        ctx = self.ctx
        with guest(ctx) as target:
            aim(self.record, view, target.viewport[2:])
            self.block.write(self.record)
            for name, texture in self.textures.items():
                texture.use(UNITS[name])
            self._draw_land(target)
            if blades is None:
                self._draw_grass(target)
            else:
                ctx.enable_only(moderngl.DEPTH_TEST)
                self.draw_calls += sum(painter.draw() for painter in blades)

    def _draw_land(self, target: moderngl.Framebuffer) -> None:
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        self.draw_calls = 1 + self.ground.draw_opaque()
        if self.bodies is not None:
            self.draw_calls += self.bodies.draw()
        target.depth_mask = False
        self.sky_array.render(moderngl.TRIANGLES, vertices=3)
        target.depth_mask = True
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = OVER
        self.draw_calls += self.ground.draw_carpet()
        if self.bodies is not None:
            self.draw_calls += self.bodies.draw_border()

    def _draw_grass(self, target: moderngl.Framebuffer) -> None:
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = OVER
        target.depth_mask = False
        self.draw_calls += sum(
            self.strips[ring].draw(first, count, thin=thin) for ring, first, count, thin in self.runs
        )
        self.draw_calls += self.morph.draw()
        near, far = self.blades[: self.parted], self.blades[self.parted :]
        self.draw_calls += sum(painter.draw() for painter in reversed(far))
        # Around the viewer no order is right for every direction: there blades are parted by depth, and then edged.
        target.depth_mask = True
        self.draw_calls += sum(painter.draw(CORES) for painter in near)
        target.depth_mask = False
        self.draw_calls += sum(painter.draw(EDGES) for painter in reversed(near))

    def release(self) -> None:
        """Give everything back to the context."""
        if self.bodies is not None:
            self.bodies.release()
        self._release_grass()
        release_all(self.block, self.sky_array, self.sky, *self.textures.values())
