"""The GL objects of a site in one context, and their exchange for another site's piece by piece."""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import TypeVar

import moderngl

from ..components.wind import WindPrimitive
from ..engine.gl.background import BackgroundCompiler, compiles_in_background
from ..engine.gl.stream import release_all
from .features import UNITS
from .frame.block import FrameBlock
from .frame.feature import Feature, Part, overriding
from .receive.received import ROW, Received
from .show.representation import Canvas, RepresentationPainter
from .site import Site, same_settings
from .staged import Staged, grass_changed, kind_defines, kinds_changed
from .wind.card import CardWinds
from .winds import Winds

OnePart = TypeVar("OnePart", bound=Part)

READY_ROWS = 512
"""Rows of receivers that are allocated when a game prepares: half a million receivers, in 8 MiB."""

AHEAD = True
"""Whether a live prairie makes all programs before they are needed, so that no later frame waits for one."""

IN_A_FRAME = (
    "settle", "defines", "send", "use", "prepare", "take_wind", "draw_solid", "prepare_behind",
    "draw_behind", "draw_soft", "soft_distance",
)  # fmt: skip
"""Methods of parts that frames call."""


class Holding:
    """All GL objects of a site in one context."""

    def __init__(self, ctx: moderngl.Context, features: Sequence[Feature], winds: Winds, *, linear: bool) -> None:
        self.ctx, self.winds, self.quarantine = ctx, winds, winds.quarantine
        self.block, self.received = FrameBlock(ctx), Received(ctx)
        self.record = self.block.record
        self.record["writes_raw"] = linear
        self.parts = [each.part(ctx, self.block, UNITS) for each in features]
        self._parts_with = {name: overriding(Part, name, self.parts) for name in IN_A_FRAME}
        self.painters: dict[str, RepresentationPainter] = {}
        """Painters by the names of their representations, from the finest."""
        self.air: CardWinds
        self.site: Site | None = None
        self._staged: Staged | None = None
        self._compiler = BackgroundCompiler(ctx)
        self._deferred: Iterator[None] = iter(())
        """Makes programs that no frame has drawn with yet, a piece a frame."""
        self._kind_defines: dict[str, str | int] = {}
        """Defines that depend on the kinds of grass."""
        self._prepared_winds: Sequence[WindPrimitive] | None = None
        """A wind of each kind that programs are made for; None if no game has prepared."""

    @property
    def coarsest(self) -> RepresentationPainter:
        """The painter of the coarsest representation, which lies on the land."""
        return list(self.painters.values())[-1]

    def part(self, kind: type[OnePart], /) -> OnePart:
        """Return the part of a class."""
        return next(part for part in self.parts if isinstance(part, kind))

    def settle(self, site: Site) -> None:
        """Take over a site and all its changes since the frame before; unchanged GL objects are kept."""
        for _ in self._settling(site):
            pass
        next(self._deferred, None)

    def steps(self, site: Site) -> int:
        """Return the maximum number of steps that `preparing` takes."""
        times = 2 if compiles_in_background(self.ctx) else 1
        return 2 * len(self.parts) + 12 + sum(6 + times * each.programs for each in site.representations)

    def _making_ready(
        self, site: Site, air: CardWinds, painters: Mapping[str, RepresentationPainter]
    ) -> Iterator[None]:
        """Make the programs and allocate the buffers for all winds that may blow."""
        assert self._prepared_winds is not None
        texts = chain.from_iterable(painter.texts() for painter in painters.values())
        yield from self._compiler.compile_together(texts)
        for painter in painters.values():
            yield from painter.making()
            painter.make_ready(site)
            yield
        winds = [*site.scene.wind, *self._prepared_winds]
        yield from self._making_for_winds(winds, air, painters)
        air.make_room(winds, receivers=READY_ROWS * ROW)

    def _making_for_winds(
        self, winds: Sequence[WindPrimitive], air: CardWinds, painters: Mapping[str, RepresentationPainter]
    ) -> Iterator[None]:
        """Make the programs for winds of the same kinds as `winds`, and yield after each."""
        yield from air.expecting(winds)
        for painter in painters.values():
            yield from painter.making_for_winds()
        air.stand_ready()

    def _settling(self, site: Site) -> Iterator[None]:
        """Do what `settle` does step by step; if it is left unfinished, the next call starts again."""
        before = self.site
        for part in self._parts_with["settle"]:
            part.settle(site, self.record)
        if before is None or kinds_changed(site, before):
            self._kind_defines = kind_defines(site)
        defines = dict(self._kind_defines)
        for part in self._parts_with["defines"]:
            defines |= part.defines()
        has_changed = before is None or defines != self.block.defines or grass_changed(site, before)
        if not has_changed and site is before:
            return
        is_staged = before is not None and has_changed and self._can_stage(site, before, defines)
        if is_staged:
            while not self.stage(site):
                yield
            self._take_staged(site)
        elif has_changed:
            self.site = None
            yield from self._uploading(site, defines)
        self.site = site
        for painter in self.painters.values():
            painter.settle(site, self.record)
        self.air.meet(site.scene.wind)
        if has_changed and not is_staged:
            yield from self._making_for_later(site)

    def _making_for_later(self, site: Site) -> Iterator[None]:
        """Make the programs of later frames now if a game has prepared, or if nothing compiles in the background."""
        if self._prepared_winds is not None:
            yield from self._making_ready(site, self.air, self.painters)
        elif not compiles_in_background(self.ctx):
            yield from self._deferred  # at once, as each program would hold a frame up

    def _fits(self, site: Site, before: Site) -> bool:
        """Return whether the present programs can also draw the grass of another site."""
        return same_settings(site, before) and self._defines_of(site) == self.block.defines and all(
            each.name in self.painters and self.painters[each.name].fits(each) for each in site.representations
        )  # fmt: skip

    def _defines_of(self, site: Site) -> dict[str, str | int]:
        """Return the defines of programs for another site's grass."""
        others = {name: value for name, value in self.block.defines.items() if name not in self._kind_defines}
        return others | kind_defines(site)

    def _can_stage(self, site: Site, before: Site, defines: dict[str, str | int]) -> bool:
        """Return whether a site's grass is being staged already, or the present programs can draw it."""
        staged = self._staged
        if staged is not None and staged.representations is site.representations and staged.defines == defines:
            return True
        return defines == self.block.defines and self._fits(site, before)

    def stage(self, site: Site, /) -> bool:
        """Upload a piece of another site's grass, which is not drawn yet; return whether all of it is there."""
        if self.site is None:
            return True  # it is uploaded when it is drawn
        if self._staged is None or self._staged.representations is not site.representations:
            release_all(self._staged)
            self._staged = staged = Staged(site.representations, self._defines_of(site))
            if self._fits(site, self.site):
                staged.steps = self._staging(site)
            else:
                staged.air = air = CardWinds(self.ctx, UNITS, [growth.response for growth in site.growths])
                ready: Callable[[], Iterator[None]] | None = None
                if self._prepared_winds is not None:
                    ready = partial(self._making_ready, site, air, staged.painters)
                elif AHEAD and self.quarantine.live:
                    ready = partial(self._making_for_winds, self._winds_of_all_kinds(site), air, staged.painters)
                canvas = self._canvas(site, air, self.block.with_defines(staged.defines))
                staged.steps = staged.making(canvas, self._compiler, site.scene.wind, ready)
        return next(self._staged.steps, "over") == "over"

    def _staging(self, site: Site) -> Generator[None, None, None]:
        stocks = {each.name: each for each in site.representations}
        for name in stocks:
            yield from self.painters[name].staging(stocks)

    def _take_staged(self, site: Site) -> None:
        """Draw the staged grass of a site from now on."""
        staged, self._staged = self._staged, None
        assert staged is not None
        if staged.air is None:
            for painter in self.painters.values():
                painter.restock()
            self.air.regrow([growth.response for growth in site.growths])
            return
        self._release_grass()
        self.block.defines, self.painters, self.air = staged.defines, staged.painters, staged.air

    def _uploading(self, site: Site, defines: dict[str, str | int]) -> Iterator[None]:
        """Upload the grass, a representation at a time."""
        self._release_grass()
        self.block.defines = defines
        self.air = CardWinds(self.ctx, UNITS, [growth.response for growth in site.growths])
        canvas = self._canvas(site, self.air, self.block)
        is_ahead = AHEAD and self.quarantine.live
        for each in site.representations:
            self.painters[each.name] = made = each.painter(canvas)
            yield
            if is_ahead and not compiles_in_background(self.ctx):
                yield from made.making()
        if is_ahead:
            self._deferred = self._making_deferred(site)

    def _release_grass(self) -> None:
        """Release everything that draws grass; some of it is missing before the first frame, and where that failed."""
        self._compiler.release()
        self._deferred = iter(())
        release_all(self._staged)
        self._staged = None  # the painters held what they had staged
        grass, self.painters = [*self.painters.values()], {}
        release_all(*grass, *([vars(self).pop("air")] if "air" in vars(self) else []))

    def _making_deferred(self, site: Site) -> Iterator[None]:
        """Make the programs that no frame has drawn with yet, once the driver has compiled them.

        Last come the programs by which receivers hear kinds of wind that do not blow now.
        """
        makers: list[RepresentationPainter | Part] = [*self.painters.values(), *self.parts]
        yield  # the first frame makes the programs that it draws with
        yield from self._compiler.compile_in_turn(chain.from_iterable(maker.texts() for maker in makers))
        for maker in makers:
            yield from maker.making()
        if self._prepared_winds is None:
            yield from self._making_for_winds(self._winds_of_all_kinds(site), self.air, self.painters)

    def _winds_of_all_kinds(self, site: Site) -> list[WindPrimitive]:
        """Return the scene's winds, and one of each kind."""
        return [*site.scene.wind, *self.winds.samples()]

    def _canvas(self, site: Site, air: CardWinds, block: FrameBlock) -> Canvas:
        return Canvas(
            self.ctx, block, UNITS, site.scene.seed, site.transitions, air, self.received, site.reach,
            site.representations,
        )  # fmt: skip

    def release(self) -> None:
        """Release all GL objects."""
        self._release_grass()
        release_all(*self.parts, self.received, self.block)
