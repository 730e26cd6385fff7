"""Drawing a whole frame: ground, sky and carpet, then strips and blades from far to near."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import inf, nextafter

import moderngl

from ..engine.camera import View, is_mirrored, light_from
from ..engine.gl.guest import aside, colourless, depth_ends, guest
from ..engine.gl.rasteriser import early_flush
from ..engine.gl.smaller import OVER, Smaller
from ..engine.gl.stopwatch import Stopwatch
from ..engine.gl.stream import release_all
from .around.asked import Asked
from .around.outlook import Outlook
from .blow import Blown, receivers_shown
from .features import UNITS
from .frame.block import aim, confine
from .frame.feature import Feature, Part, overriding
from .holding import READY_ROWS, Holding
from .receive.received import numbers_of, write_messages
from .show.blades.draw import BladeDrawing
from .show.blades.plant import record_of
from .show.representation import RepresentationPainter
from .site import Site
from .wind.blow import mean_yaw
from .winds import Winds

WHOLE = Asked()

CRESTS_FROM = 100.0
"""Distance from which soft edges are taken to be behind crests with thin grass [m]; nearer ones are before them."""

REHEARSED_SCALE = 0.75
"""Fraction of the pixels, across and up, in the rehearsal of a frame whose time is held; any below 1 will do."""


class Painter(Holding):
    """Draws a site in one GL context."""

    def __init__(self, ctx: moderngl.Context, features: Sequence[Feature], winds: Winds, *, linear: bool) -> None:
        super().__init__(ctx, features, winds, linear=linear)
        self.smaller, self.stopwatch = Smaller(ctx, floats=linear), Stopwatch(ctx)
        self._hand_over = early_flush(ctx)
        self.draw_calls = self.blades = 0
        """Numbers of draw calls, and of blades drawn as geometry, in the last frame."""
        self._outlook: Outlook | None = None
        """Outlook that was uploaded last."""
        self._first: dict[str, list[int]] = {}
        """Indices of the first receivers of each representation's pools, by its name."""

    def preparing(self, site: Callable[[], Site], look: Callable[[], None], /) -> Iterator[None]:
        """Make everything that a game may need, with winds of all kinds, and rehearse a frame, in up to `steps` steps.

        `site` returns the present site. `look` uploads a frame to rehearse, and is called if no viewer has looked yet.
        If other grass is drawn between steps, they begin again.
        """
        steps = self._preparing(site, look)
        while next(steps, "over") != "over":
            before = self.painters
            yield
            if self.painters is not before:
                steps = self._preparing(site, look)

    def _preparing(self, site: Callable[[], Site], look: Callable[[], None]) -> Iterator[None]:
        for part in self.parts:
            part.settle(site(), self.record)
            part.make_ready(site())
            yield
        self._prepared_winds = self.winds.samples()
        self.smaller.make_ready()
        self.received.reserve(READY_ROWS)
        yield
        before = self.painters
        yield from self._settling(site())
        if before is self.painters:
            yield from self._making_ready(site(), self.air, self.painters)
        if self._outlook is None:
            look()
            yield
        yield from self._rehearsing()

    def _release_grass(self) -> None:
        super()._release_grass()
        self._outlook = None  # the next painters have not uploaded it

    def _rehearsing(self) -> Iterator[None]:
        """Draw the last frame without pixels, a step each: parts of it, with more than it has, scaled, and cast."""
        every: list[Part] = [*self.parts, *self.painters.values()]
        single = [[part] for part in overriding(Part, "rehearse", every)]
        deep = Asked(is_deep=True)
        plain = [replace(deep, parts=frozenset({part})) for part in ("sky", "ground", "grass")]
        frames: list[tuple[list[Part], Asked, float]] = [([], asked, 1.0) for asked in (*plain, WHOLE, deep)]
        frames += [(rehearsed, deep, 1.0) for rehearsed in (*single, every)]
        frames += [(rehearsed, deep, REHEARSED_SCALE) for rehearsed in ([], every)]
        assert self._outlook is not None
        assert self._outlook.view is not None
        for rehearsed, asked, scale in frames:
            before = self.record.copy()
            for part in rehearsed:
                part.rehearse(self.record)
            self.draw(self._outlook.view, asked, scale=scale, hidden=True)
            self.record[:] = before
            yield
        self.cast(self._outlook.view, self._outlook, hidden=True)
        yield

    def blade_painter(self, segments: int) -> BladeDrawing:
        """Return a painter of opaque blades with a number of segments, which may come in any order."""
        assert self.site is not None
        return BladeDrawing(self.ctx, self.block, segments, UNITS, record_of(self.site.growths))

    def write(self, outlook: Outlook) -> None:
        """Upload what a viewer is shown."""
        self.record["beside_sun"] = 0.0
        self.record["anything_open"] = _is_open(outlook, self.site)
        for part in self._parts_with["send"]:
            part.send(outlook, self.record)
        counts = {name: painter.receivers(outlook) for name, painter in self.painters.items()}
        first = iter(self.received.allocate([count for pools in counts.values() for count in pools]))
        self._first = {name: [next(first) for _ in pools] for name, pools in counts.items()}
        self._outlook = outlook
        self.blades = 0
        for painter in self.painters.values():
            self.blades += painter.write(outlook, self._first)

    def _hear(self, target: moderngl.Framebuffer, asked: Asked) -> int:
        """Compute the messages of all receivers shown; return the number of draw calls."""
        outlook, air, site = self._outlook, self.air, self.site
        if outlook is None or site is None:
            return 0
        if "grass" not in asked.parts:
            with aside(self.ctx, target):
                return self._prepare()
        scene, blown = site.scene, outlook.noted(Blown, Blown())
        yaw = mean_yaw(scene.wind)
        air.write(blown.winds, time=blown.time, seed=scene.seed, mixing=scene.mixing, yaw=yaw)
        air.tell(
            lambda: receivers_shown(outlook, site.growths, patch=site.ground.patch, margin=site.margin),
            self.quarantine,
            numbers=partial(numbers_of, outlook, self._first),
        )
        with aside(self.ctx, target):
            calls = self._prepare()
            air.use()
            for painter in self.painters.values():
                calls += painter.hear()
            heard = self.coarsest.heard()
            for part in self._parts_with["take_wind"]:
                calls += part.take_wind(heard)
            write_messages(self.received, outlook, self._first, site.ground)
            self.received.texture.use(UNITS["received"])
        return calls

    def _prepare(self) -> int:
        """Draw the textures that this frame reads; return the number of draw calls."""
        # A loop, here and below: sums of generators take noticeably longer
        calls = 0
        for part in self._parts_with["prepare"]:
            calls += part.prepare()
        return calls

    def draw(
        self,
        view: View,
        asked: Asked = WHOLE,
        *,
        blades: Iterable[BladeDrawing] | None = None,
        scale: float = 1.0,
        hidden: bool = False,
    ) -> None:
        """Draw the `asked` parts of the frame into the host's bound framebuffer.

        With `blades`, only these stand on ground and carpet. `scale` times the host's pixels are drawn, across and up;
        none if the frame is `hidden`.
        """
        with guest(self.ctx, view) as host:
            if hidden:
                host.scissor = 0, 0, 0, 0
            is_whole = "sky" in asked.parts
            with self.smaller.instead_of(host, scale, is_whole=is_whole, is_alone=asked.is_alone) as target:
                if hidden:
                    target.scissor = 0, 0, 0, 0
                self._draw(view, target, asked, blades)

    def _draw(
        self, view: View, target: moderngl.Framebuffer, asked: Asked, blades: Iterable[BladeDrawing] | None
    ) -> None:
        self._write_block(view, target, asked)
        self.draw_calls = self._hear(target, asked) if blades is None else 0
        if "sky" in asked.parts:
            with aside(self.ctx, target):
                self.draw_calls += sum(part.prepare_behind() for part in self._parts_with["prepare_behind"])
        self._draw_land(target, asked)
        if "grass" in asked.parts:
            self._draw_carpet(target, view, all_soft=blades is not None, is_deep=asked.is_deep)
        self._hand_over()
        if "grass" in asked.parts and blades is None:
            self._draw_grass(target, is_deep=asked.is_deep)
        elif blades is not None:
            self.ctx.enable_only(moderngl.DEPTH_TEST)
            self.draw_calls += sum(painter.draw() for painter in blades)

    def cast(self, view: View, outlook: Outlook, *, hidden: bool = False) -> None:
        """Write the depth of what a viewer was shown last, as seen from a light, into the host's bound framebuffer.

        Coverage is computed as seen from the light: strips block as much of it as their blades do. If it is `hidden`,
        what was uploaded last is drawn without pixels.
        """
        if not hidden:
            self.write(outlook)
        with guest(self.ctx, view) as target:
            if hidden:
                target.scissor = 0, 0, 0, 0
            self._write_block(view, target, WHOLE)
            self.draw_calls = self._hear(target, WHOLE)
            self.record["eye"] = outlook.viewer.eye  # the carpet's mesh depends on the viewer's eye
            self.block.write(self.record)
            self.ctx.enable_only(moderngl.DEPTH_TEST)
            with colourless(target):
                light = light_from(view, outlook.viewer.eye)
                self.draw_calls += sum(painter.cast(light) for painter in self.painters.values())
            self.record["eye"] = light
            self.block.write(self.record)
            with aside(self.ctx, target):
                self.draw_calls += sum(painter.look_anew() for painter in self.painters.values())
            self.ctx.enable_only(moderngl.DEPTH_TEST)
            with colourless(target):
                self.draw_calls += sum(painter.draw_deep() for painter in self.painters.values())
                self.draw_calls += sum(part.cast(light) for part in self.parts)

    def hear(self, view: View) -> int:
        """Compute the messages of all receivers of the last frame once more; return the number of draw calls.

        This is all of a frame's animation outside of its systems. It draws nothing.
        """
        with guest(self.ctx) as host:
            self._write_block(view, host, WHOLE)
            return self._hear(host, WHOLE)

    def _write_block(self, view: View, target: moderngl.Framebuffer, asked: Asked) -> None:
        """Write the frame block, and bind the textures of all parts."""
        aim(self.record, view, target.viewport[2:], ends=depth_ends())
        confine(self.record, asked)
        self.block.write(self.record)
        for part in self._parts_with["use"]:
            part.use()

    def _draw_land(self, target: moderngl.Framebuffer, asked: Asked) -> None:
        """Draw everything opaque, and the sky behind it."""
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        if "ground" in asked.parts:
            self.draw_calls += self.coarsest.draw_ground(alone="grass" not in asked.parts)
        if "grass" in asked.parts:
            solid = self._parts_with["draw_solid"]
            solid = solid if asked.over_hosts else [*self.painters.values(), *solid]
            for part in solid:
                self.draw_calls += part.draw_solid()
        if "sky" in asked.parts:
            target.depth_mask = False
            for part in self._parts_with["draw_behind"]:
                self.draw_calls += part.draw_behind()

    def _draw_carpet(self, target: moderngl.Framebuffer, view: View, *, all_soft: bool, is_deep: bool) -> None:
        """Draw the carpet, and soft edges in front of it: all of them, or only those beyond standing grass.

        If `is_deep`, it writes depth only where it covers at least half a pixel.
        """
        target.depth_mask = False
        self._blend()
        edged = [part for part in self._parts_with["soft_distance"] if part.soft_distance() is not None]
        carpet, limit, parted = self.coarsest, nextafter(self._reach(), inf), bool(edged) or is_deep
        self.draw_calls += self._draw_culled(view, partial(carpet.draw_dense if parted else carpet.draw, target))
        if parted:  # thin grass on a crest lets trees behind it show through, and most near ones stand in front of it
            self.draw_calls += sum(part.draw_soft(CRESTS_FROM) for part in edged)
            self.draw_calls += self._draw_culled(view, partial(carpet.draw_thin, target))
        target.depth_mask = True
        for part in self._parts_with["draw_soft"]:
            self.draw_calls += part.draw_soft(limit if part in edged and not all_soft else 0.0)

    def _draw_culled(self, view: View, draw: Callable[[], int]) -> int:
        """Draw with back faces culled, which hills hide anyway; return the number of draw calls."""
        mirrored = is_mirrored(view)
        if mirrored is not None:
            self.ctx.cull_face = "front" if mirrored else "back"
            self.ctx.enable(moderngl.CULL_FACE)
        calls = draw()
        self.ctx.disable(moderngl.CULL_FACE)
        return calls

    def _reach(self) -> float:
        """Return the largest distance of grass that is drawn from far to near [m]."""
        return max(painter.farthest for painter in self.painters.values())

    def _draw_grass(self, target: moderngl.Framebuffer, *, is_deep: bool) -> None:
        """Draw strips and blades, the coarser representations first."""
        self._blend()
        target.depth_mask = False
        for painter in list(self.painters.values())[-2::-1]:
            for part in self._parts_with["soft_distance"]:
                self.draw_calls += _draw_among(painter, part)
            self.draw_calls += painter.draw(target)
            self._hand_over()
        if is_deep:
            self.ctx.enable_only(moderngl.DEPTH_TEST)
            target.depth_mask = True
            with colourless(target):
                self.draw_calls += sum(painter.draw_deep() for painter in self.painters.values())

    def _blend(self) -> None:
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = OVER

    def release(self) -> None:
        """Release all GL objects."""
        super().release()
        release_all(self.smaller, self.stopwatch)


def _is_open(outlook: Outlook, site: Site | None) -> bool:
    """Return whether grass may be missing where its map is dense: over holes, or on cleared patches."""
    patches = outlook.patches
    has_holes = site is not None and site.ground.terrain.holes is not None
    return has_holes or bool((patches.alive & ~patches.grows).any())


def _draw_among(painter: RepresentationPainter, part: Part) -> int:
    """Draw a part's remaining soft edges, and before each the grass behind it; return the number of draw calls."""
    calls, left = 0, part.soft_distance()
    while left is not None:
        calls += painter.draw_beyond(left) + part.draw_soft(left)
        left = part.soft_distance()
    return calls
