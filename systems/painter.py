"""Drawing a whole frame: ground, sky and carpet, then strips and blades from far to near."""

from collections.abc import Iterable, Sequence
from functools import partial

import moderngl

from ..components.body import Body
from ..components.shade import Shade
from ..engine.camera import View, is_mirrored
from ..engine.gl.guest import aside, guest
from ..engine.gl.rasteriser import handing_over
from ..engine.gl.smaller import Smaller
from ..engine.gl.stopwatch import Stopwatch
from ..engine.gl.stream import release_all
from ..engine.gl.units import FIRST_UNIT
from .around.outlook import Outlook
from .blow import receivers_shown
from .bodies.cast import cast, nearest
from .bodies.draw import BodyPainter, shade_of
from .frame.block import FrameBlock, aim
from .land.maps import density_texture, height_texture, posture_texture
from .land.record import frame_record
from .light.daylight import Daylight
from .light.draw import SAMPLERS as LIGHTS
from .light.draw import LightPainter
from .light.repeating import drifted
from .light.shine import shine, toward_sun
from .light.shining import Shining
from .mow.card import SAMPLERS as MOWING
from .mow.card import CardMown
from .mow.mown import Mown
from .press.card import SAMPLERS as PRESSING
from .press.card import CardPress
from .press.lie import recoveries
from .receive.ask import numbers_of, write_messages
from .receive.received import Received
from .show.blades.draw import BladePainter, own_segment_defines
from .show.blades.organs import any_teeth
from .show.blades.plant import record_of
from .show.carpet.painter import CarpetPainter
from .show.registry import REPRESENTATIONS
from .show.representation import Canvas, RepresentationPainter
from .site import Site
from .wind.blow import mean_yaw
from .wind.card import SAMPLERS as WINDS
from .wind.card import CardWinds
from .wind.quarantine import Quarantine

SHARED = ("postures", "density", "heights", "received", *MOWING, *(name for name in LIGHTS if name != "sky"))
"""The samplers that are no representation's own. The sky's is free again once the sky is drawn."""

LAST_UNIT = FIRST_UNIT + 15
"""The last texture unit that every OpenGL has."""


def _units() -> dict[str, int]:
    """Return the texture unit of each sampler: those read only before drawing, or only by blades, share with others."""
    asked = {name for each in REPRESENTATIONS for name in each.asked}
    drawn = [name for each in REPRESENTATIONS for name in each.samplers]
    throughout = [*SHARED, *(name for name in drawn if name in asked)]
    first = [*throughout, *(name for name in drawn if name not in asked)]
    before = [*WINDS, *sorted(asked - set(throughout)), *PRESSING]
    units = {name: unit for unit, name in enumerate(first, FIRST_UNIT)}
    units["sky"] = units["images"]
    return units | {name: LAST_UNIT - number for number, name in enumerate(before)}


UNITS = _units()
"""The texture unit of each sampler."""

OVER = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)


class Painter:
    """Everything that one GL context holds of a site, and the drawing of it."""

    def __init__(
        self,
        ctx: moderngl.Context,
        site: Site,
        quarantine: Quarantine,
        mown: Mown,
        shining: Shining,
        *,
        linear: bool = False,
    ) -> None:
        self.ctx, self.quarantine, self.linear = ctx, quarantine, linear
        self.block = FrameBlock(ctx)
        self.received = Received(ctx)
        self.air: CardWinds
        self.press, self.mown = CardPress(ctx), CardMown(ctx)
        self.textures: dict[str, moderngl.Texture | moderngl.TextureArray] = {}
        self.light = LightPainter(ctx, self.block, UNITS)
        self.bodies: BodyPainter | None = None
        self.smaller, self.stopwatch = Smaller(ctx, floats=linear), Stopwatch(ctx)
        self.painters: dict[str, RepresentationPainter] = {}
        self._hand_over = handing_over(ctx)
        self.draw_calls = 0
        self.site, self._mown, self._shining = site, mown, shining
        self._lit: Daylight | None = None
        self._leaps = 0
        self._outlook: Outlook | None = None
        self._first: dict[str, list[int]] = {}
        self._lay(site)
        self._learn_of_mowing()
        self._grow(site)
        self._read(site)

    @property
    def carpet(self) -> CarpetPainter:
        """The painter of ground and carpet."""
        painter = self.painters["carpet"]
        assert isinstance(painter, CarpetPainter)
        return painter

    def change(self, site: Site) -> None:
        """Draw another site from now on, that of a scene read again; what has not changed stays in GL as it is."""
        before, self.site = self.site, site
        same_seed = site.scene.seed == before.scene.seed
        if site.ground.terrain is not before.ground.terrain or not same_seed:
            self._lay(site)
        elif site.ground.density is not before.ground.density:
            self._sow(site)
        same_grass = site.growths == before.growths and site.quality == before.quality and site.reach == before.reach
        if not (same_grass and same_seed and site.own_segments == before.own_segments):
            self._grow_anew()
        self.carpet.stand_on(site.ground)
        self._read(site)

    def shine(self) -> None:
        """Take over the light as it is by now."""
        now, light = self._shining, self._shining.light
        if now.leaps != self._leaps:
            self.light.lie.leap()
        if now.daylight is not self._lit:
            shine(self.record, light, now.daylight, list(self.site.scene.grass.values()))
            self.light.shine(now.daylight, toward=toward_sun(light), clouds=light.clouds)
        self._leaps, self._lit = now.leaps, now.daylight

    def mow(self) -> None:
        """Take over what has been cut and grown; programs know of it from the first cut on."""
        if self._learn_of_mowing():
            self._grow_anew()
            self.air.meet(self.site.scene.wind)

    def _learn_of_mowing(self) -> bool:
        """Send what has been cut and grown; return whether programs have to be made anew, to know of it."""
        begun = self.mown.write(self._mown, tallest=self.site.tallest)
        if begun:
            self.block.defines["MOWN"] = 1
        return begun

    def _grow_anew(self) -> None:
        release_all(*self.painters.values(), self.air)
        self._grow(self.site)

    def _read(self, site: Site) -> None:
        """Take over what a scene says of its light and its winds."""
        self.record = frame_record(site.scene, site.growths, site.ground.terrain, site.quality.patch, raw=self.linear)
        self.record["zenith"][:, 3] = site.tallest
        self._lit = None
        self.air.meet(site.scene.wind)
        self.press.stand(site.growths, recoveries(site.scene))

    def _lay(self, site: Site) -> None:
        """Bring the ground into GL."""
        self.light.lay(site.ground.terrain, seed=site.scene.seed)
        self._put("heights", height_texture(self.ctx, site.ground.terrain))
        self._sow(site)

    def _sow(self, site: Site) -> None:
        """Bring into GL where each kind grows."""
        self._put("density", density_texture(self.ctx, site.ground.density))

    def _put(self, name: str, texture: moderngl.Texture | moderngl.TextureArray) -> None:
        if name in self.textures:
            self.textures[name].release()
        self.textures[name] = texture

    def _grow(self, site: Site) -> None:
        """Bring the grass into GL; shaders are told how many kinds there are, and of what is special about any."""
        self.block.defines["KINDS"] = len(site.growths)
        for name in ("FOLDS", "TOOTHED", "OWN_SEGMENTS", "MOST_OWN_SEGMENTS"):
            self.block.defines.pop(name, None)
        self.block.defines.update(own_segment_defines(site.own_segments))
        if any(kind.profile == "fold" for kind in site.scene.grass.values()):
            self.block.defines["FOLDS"] = 1
        if any_teeth(site.growths):
            self.block.defines["TOOTHED"] = 1
        self._put("postures", posture_texture(self.ctx, site.growths))
        self.air = CardWinds(self.ctx, UNITS, site.growths)
        canvas = Canvas(
            self.ctx, self.block, UNITS, site.scene.seed, site.transitions, self.air, self.received, site.reach,
            site.representations,
        )  # fmt: skip
        self.painters = {each.name: each.painter(canvas) for each in site.representations}

    def blade_painter(self, segments: int) -> BladePainter:
        """Return a painter of opaque blades with this many segments, in any order."""
        return BladePainter(self.ctx, self.block, segments, UNITS, record_of(self.site.growths))

    def write(self, outlook: Outlook, bodies: Sequence[Body], shades: Sequence[Shade] = ()) -> int:
        """Send what a viewer is shown, what flies and what casts shadows; return how many blades stand as geometry."""
        cast(
            self.record, nearest([*map(shade_of, bodies), *shades], outlook.viewer.eye),
            drifted(self.site.scene.wind, outlook.viewer.time),
        )  # fmt: skip
        if self.bodies is None and bodies:
            self.bodies = BodyPainter(self.ctx, self.block)
        if self.bodies is not None:
            self.bodies.write(bodies)
        counts = {name: painter.receivers(outlook) for name, painter in self.painters.items()}
        laid = iter(self.received.lay([count for each in counts.values() for count in each]))
        self._first = {name: [next(laid) for _ in each] for name, each in counts.items()}
        self._outlook = outlook
        return sum(painter.write(outlook, self._first) for painter in self.painters.values())

    def _hear(self, target: moderngl.Framebuffer) -> int:
        """Let all receivers that are seen hear the wind; return the number of draw calls."""
        outlook, air, site = self._outlook, self.air, self.site
        if outlook is None:
            return 0
        scene = site.scene
        to = mean_yaw(scene.wind)
        air.write(outlook.winds, time=outlook.blown_at, seed=scene.seed, mixing=scene.mixing, to=to)
        air.tell(
            partial(receivers_shown, outlook, site.growths, patch=site.ground.patch, margin=site.margin),
            self.quarantine, numbers=partial(numbers_of, outlook, self._first),
        )  # fmt: skip
        self.press.write(outlook.trodden)
        self.press.texture.use(UNITS["pressed"])
        with aside(self.ctx, target):
            calls = self.light.prepare() + sum(painter.hear() for painter in self.painters.values())
            write_messages(self.received, outlook, self._first, site.ground)
            self.received.texture.use(UNITS["received"])
        return calls

    def draw_carpet_everywhere(self, view: View, outlook: Outlook) -> None:
        """Draw the carpet everywhere, at half the height of the grass, into the framebuffer that is bound."""
        self.carpet.lay_everywhere(outlook, height=0.5)
        self.draw(view, blades=[])
        self.carpet.lay_as_always()

    def draw(self, view: View, *, blades: Iterable[BladePainter] | None = None, scale: float = 1.0) -> None:
        """Draw the frame into the framebuffer that the host has bound.

        With `blades`, these alone stand on the ground and the carpet. Of the host's pixels, `scale` times as many are
        drawn, across and up.
        """
        ctx = self.ctx
        with guest(ctx) as host, self.smaller.instead_of(host, scale) as target:
            self._tell(view, target)
            self.draw_calls = self._hear(target) if blades is None else 0
            self._draw_land(target, view)
            self._hand_over()
            if blades is None:
                self._draw_grass(target)
            else:
                ctx.enable_only(moderngl.DEPTH_TEST)
                self.draw_calls += sum(painter.draw() for painter in blades)

    def hear(self, view: View) -> int:
        """Let all receivers that the last frame showed hear the winds once more; return the number of draw calls.

        That is all of the animation that a frame has besides its systems, and draws nothing.
        """
        with guest(self.ctx) as host:
            self._tell(view, host)
            return self._hear(host)

    def _tell(self, view: View, target: moderngl.Framebuffer) -> None:
        """Tell all shaders of the frame."""
        aim(self.record, view, target.viewport[2:])
        self.block.write(self.record)
        for name, texture in self.textures.items():
            texture.use(UNITS[name])
        self.light.use()
        self.mown.use(UNITS["mown"])
        self.press.texture.use(UNITS["pressed"])

    def _draw_land(self, target: moderngl.Framebuffer, view: View) -> None:
        """Draw all that is opaque, the sky, and the carpet, on which bodies have their soft outlines."""
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        self.draw_calls += sum(painter.draw_solid() for painter in self.painters.values())
        if self.bodies is not None:
            self.draw_calls += self.bodies.draw()
        target.depth_mask = False
        self.draw_calls += self.light.draw()
        self._blend()
        mirrored = is_mirrored(view)
        if mirrored is not None:  # hillsides that face away are hidden by the hill
            self.ctx.cull_face = "front" if mirrored else "back"
            self.ctx.enable(moderngl.CULL_FACE)
        self.draw_calls += self.carpet.draw(target)
        self.ctx.disable(moderngl.CULL_FACE)
        target.depth_mask = True
        if self.bodies is not None:
            self.draw_calls += self.bodies.draw_border()

    def _draw_grass(self, target: moderngl.Framebuffer) -> None:
        """Draw what stands on the land, the coarsest representation first."""
        self._blend()
        target.depth_mask = False
        for name, painter in reversed(self.painters.items()):
            if name != "carpet":
                self.draw_calls += painter.draw(target)
                self._hand_over()

    def _blend(self) -> None:
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = OVER

    def release(self) -> None:
        """Give everything back to the context."""
        if self.bodies is not None:
            self.bodies.release()
        release_all(*self.painters.values(), self.air, self.received, self.block, self.light, self.press, self.mown)
        release_all(self.smaller, self.stopwatch)
        release_all(*self.textures.values())
