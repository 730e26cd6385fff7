"""Drawing a whole frame: ground, sky and carpet, then strips and blades from far to near."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial

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
from .frame.feature import Feature, Part, doing
from .holding import READY_ROWS, Holding
from .receive.received import numbers_of, write_messages
from .show.blades.draw import BladePainter
from .show.blades.plant import record_of
from .show.representation import RepresentationPainter
from .site import Site
from .wind.blow import ReceiverArrays, mean_yaw
from .winds import Winds

WHOLE = Asked()

REHEARSED = 0.75
"""Part of the pixels, across and up, with which a frame that is held to its time is rehearsed: any below 1 will do."""


class Painter(Holding):
    """Draws what one GL context holds of a site."""

    def __init__(
        self, ctx: moderngl.Context, features: Sequence[Feature], winds: Winds, *, linear: bool = False
    ) -> None:
        super().__init__(ctx, features, winds, linear=linear)
        self.smaller, self.stopwatch = Smaller(ctx, floats=linear), Stopwatch(ctx)
        self._hand_over = early_flush(ctx)
        self.draw_calls = self.blades = 0
        """Of the last frame; and the blades that were sent as geometry."""
        self._outlook: Outlook | None = None
        self._first: dict[str, list[int]] = {}

    def preparing(self, site: Site, look: Callable[[], None], /) -> Iterator[None]:
        """Make all that a game may come to need, `steps` of them, with winds of all kinds that there are.

        `look` lets somebody look where nobody has looked yet: what is drawn then is rehearsed.
        """
        for part in self.parts:
            part.settle(site, self.record)
            part.make_ready(site)
            yield
        self._winds = self.winds.samples()
        self.smaller.make_ready()
        self.received.reserve(READY_ROWS)
        yield
        before = self.painters
        yield from self._settling(site)
        if before is self.painters:
            yield from self._making_ready(site)
        if self._outlook is None:
            look()
            yield
        yield from self._rehearsing()

    def _rehearsing(self) -> Iterator[None]:
        """Draw the last frame where no pixel is, part by part, as if there were more in it, and as `hold` draws it."""
        every = [*self.parts, *self.painters.values()]
        alone = [[each] for each in doing(Part, "rehearse", every)]
        whole = Asked(is_deep=True)
        plain = [replace(whole, parts=frozenset({part})) for part in ("sky", "ground", "grass")]
        more = [*((some, whole, 1.0) for some in (*alone, every)), *((some, whole, REHEARSED) for some in ([], every))]
        assert self._outlook is not None
        assert self._outlook.view is not None
        for some, asked, scale in [*(([], part, 1.0) for part in (*plain, WHOLE, whole)), *more]:
            before = self.record.copy()
            for each in some:
                each.rehearse(self.record)
            self.draw(self._outlook.view, asked, scale=scale, hidden=True)
            self.record[:] = before
            yield

    def blade_painter(self, segments: int) -> BladePainter:
        """Return a painter of opaque blades with this many segments, in any order."""
        assert self.site is not None
        return BladePainter(self.ctx, self.block, segments, UNITS, record_of(self.site.growths))

    def write(self, outlook: Outlook) -> None:
        """Send what a viewer is shown."""
        self.record["beside_sun"] = 0.0
        self.record["anything_open"] = _is_open(outlook, self.site)
        for part in self._doing["send"]:
            part.send(outlook, self.record)
        counts = {name: painter.receivers(outlook) for name, painter in self.painters.items()}
        laid = iter(self.received.lay([count for each in counts.values() for count in each]))
        self._first = {name: [next(laid) for _ in each] for name, each in counts.items()}
        self._outlook = outlook
        self.blades = 0
        for painter in self.painters.values():
            self.blades += painter.write(outlook, self._first)

    def _hear(self, target: moderngl.Framebuffer, asked: Asked) -> int:
        """Let all receivers that are seen hear the wind; return the number of draw calls."""
        outlook, air, site = self._outlook, self.air, self.site
        if outlook is None or site is None:
            return 0
        if "grass" not in asked.parts:
            with aside(self.ctx, target):
                return self._prepare()
        scene, blown = site.scene, outlook.noted(Blown, Blown())
        yaw = mean_yaw(scene.wind)
        air.write(blown.winds, time=blown.time, seed=scene.seed, mixing=scene.mixing, yaw=yaw)
        air.tell(partial(_receivers, outlook, site), self.quarantine, numbers=partial(numbers_of, outlook, self._first))
        with aside(self.ctx, target):
            calls = self._prepare()
            air.use()
            for painter in self.painters.values():
                calls += painter.hear()
            heard = self.coarsest.heard()
            for part in self._doing["breathe"]:
                calls += part.breathe(heard)
            write_messages(self.received, outlook, self._first, site.ground)
            self.received.texture.use(UNITS["received"])
        return calls

    def _prepare(self) -> int:
        """Draw what is read in this frame; return the number of draw calls. Here and below, generators cost a frame."""
        calls = 0
        for part in self._doing["prepare"]:
            calls += part.prepare()
        return calls

    def draw(
        self,
        view: View,
        asked: Asked = WHOLE,
        *,
        blades: Iterable[BladePainter] | None = None,
        scale: float = 1.0,
        hidden: bool = False,
    ) -> None:
        """Draw what is `asked` for of the frame into the framebuffer that the host has bound.

        With `blades`, these alone stand on the ground and the carpet. Of the host's pixels, `scale` times as many are
        drawn, across and up; none at all where it is `hidden`.
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
        self, view: View, target: moderngl.Framebuffer, asked: Asked, blades: Iterable[BladePainter] | None
    ) -> None:
        self._tell(view, target, asked)
        self.draw_calls = self._hear(target, asked) if blades is None else 0
        if "sky" in asked.parts:
            with aside(self.ctx, target):
                self.draw_calls += sum(part.look_up() for part in self._doing["look_up"])
        self._draw_land(target, asked)
        if "grass" in asked.parts:
            self._draw_carpet(target, view, all_soft=blades is not None)
        self._hand_over()
        if "grass" in asked.parts and blades is None:
            self._draw_grass(target, is_deep=asked.is_deep)
        elif blades is not None:
            self.ctx.enable_only(moderngl.DEPTH_TEST)
            self.draw_calls += sum(painter.draw() for painter in blades)

    def cast(self, view: View, outlook: Outlook) -> None:
        """Write the depth of what a viewer was shown last into what the host has bound, as it is seen from a light.

        Grass is made out as that sees it: strips hide as much as their blades do.
        """
        self.write(outlook)
        with guest(self.ctx, view) as target:
            self._tell(view, target, WHOLE)
            self.draw_calls = self._hear(target, WHOLE)
            self.record["eye"] = outlook.viewer.eye  # the mesh lies as the viewer has it
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
        """Let all receivers that the last frame showed hear the winds once more; return the number of draw calls.

        That is all of the animation that a frame has besides its systems, and draws nothing.
        """
        with guest(self.ctx) as host:
            self._tell(view, host, WHOLE)
            return self._hear(host, WHOLE)

    def _tell(self, view: View, target: moderngl.Framebuffer, asked: Asked) -> None:
        """Tell all shaders of the frame."""
        aim(self.record, view, target.viewport[2:], ends=depth_ends())
        confine(self.record, asked)
        self.block.write(self.record)
        for part in self._doing["use"]:
            part.use()

    def _draw_land(self, target: moderngl.Framebuffer, asked: Asked) -> None:
        """Draw all that is opaque, and the sky behind it."""
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        if "ground" in asked.parts:
            self.draw_calls += self.coarsest.draw_ground(alone="grass" not in asked.parts)
        if "grass" in asked.parts:
            solid = self._doing["draw_solid"]
            solid = solid if asked.over_hosts else [*self.painters.values(), *solid]
            for each in solid:
                self.draw_calls += each.draw_solid()
        if "sky" in asked.parts:
            target.depth_mask = False
            for part in self._doing["draw_behind"]:
                self.draw_calls += part.draw_behind()

    def _draw_carpet(self, target: moderngl.Framebuffer, view: View, *, all_soft: bool) -> None:
        """Draw what lies on the land, and soft edges before it: all of them, or those beyond grass that stands."""
        target.depth_mask = False
        self._blend()
        is_parted = any(part.soft_left() is not None for part in self._doing["soft_left"])
        carpet = self.coarsest
        self.draw_calls += self._culled(view, partial(carpet.draw_dense if is_parted else carpet.draw, target))
        target.depth_mask = True
        for part in self._doing["draw_soft"]:
            among_grass = not all_soft and part.soft_left() is not None
            self.draw_calls += part.draw_soft(self._reach() if among_grass else 0.0)
        if is_parted:  # thin grass over a crest lets trees behind it through
            target.depth_mask = False
            self.draw_calls += self._culled(view, partial(carpet.draw_thin, target))
            target.depth_mask = True

    def _culled(self, view: View, draw: Callable[[], int]) -> int:
        """Draw without hillsides that face away, which the hill hides; return the number of draw calls."""
        mirrored = is_mirrored(view)
        if mirrored is not None:
            self.ctx.cull_face = "front" if mirrored else "back"
            self.ctx.enable(moderngl.CULL_FACE)
        calls = draw()
        self.ctx.disable(moderngl.CULL_FACE)
        return calls

    def _reach(self) -> float:
        """Return how far off grass stands that is drawn from far to near [m]."""
        return max(each.farthest for each in self.painters.values())

    def _draw_grass(self, target: moderngl.Framebuffer, *, is_deep: bool) -> None:
        """Draw what stands on the land, the coarser representations first."""
        self._blend()
        target.depth_mask = False
        for painter in list(self.painters.values())[-2::-1]:
            for part in self._doing["soft_left"]:
                self.draw_calls += _among(painter, part)
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
        """Give everything back to the context."""
        super().release()
        release_all(self.smaller, self.stopwatch)


def _is_open(outlook: Outlook, site: Site | None) -> bool:
    """Return whether grass is missing that is dense on the map: over holes, or where a game has cleared patches."""
    patches = outlook.patches
    has_holes = site is not None and site.ground.terrain.holes is not None
    return has_holes or bool((patches.alive & ~patches.grows).any())


def _receivers(outlook: Outlook, site: Site) -> ReceiverArrays:
    """Return all receivers of what a viewer is shown."""
    return receivers_shown(outlook, site.growths, patch=site.ground.patch, margin=site.margin)


def _among(painter: RepresentationPainter, part: Part) -> int:
    """Draw what a part has left of soft edges, and before each the grass behind it; return the number of draw calls."""
    calls, left = 0, part.soft_left()
    while left is not None:
        calls += painter.draw_beyond(left) + part.draw_soft(left)
        left = part.soft_left()
    return calls
