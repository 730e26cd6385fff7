"""What one GL context holds of a site, and how it comes to another site piece by piece."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import TypeVar

import moderngl

from ..components.wind import WindPrimitive
from ..engine.gl.background import BackgroundCompiler, compiles_in_background
from ..engine.gl.stream import release_all
from .features import UNITS
from .frame.block import FrameBlock
from .frame.feature import Feature, Part, doing
from .receive.received import ROW, Received
from .show.representation import Canvas, RepresentationPainter
from .site import Site
from .staged import Staged, are_alike, are_other_kinds, is_other_grass, special_of
from .wind.card import CardWinds
from .winds import Winds

Sort = TypeVar("Sort", bound=Part)

READY_ROWS = 512
"""Rows of receivers that there is room for once a game has prepared: half a million, in 8 MiB."""

AHEAD = True
"""Whether a live prairie has all programs before they are needed, so that none keeps a player waiting later."""

IN_A_FRAME = (
    "settle", "defines", "send", "use", "prepare", "breathe", "draw_solid", "look_up", "draw_behind", "draw_soft",
    "soft_left",
)  # fmt: skip
"""Methods of parts that a frame calls."""


class Holding:
    """Everything that one GL context holds of a site."""

    def __init__(
        self, ctx: moderngl.Context, features: Sequence[Feature], winds: Winds, *, linear: bool = False
    ) -> None:
        self.ctx, self.winds, self.quarantine = ctx, winds, winds.quarantine
        self.block, self.received = FrameBlock(ctx), Received(ctx)
        self.record = self.block.record
        self.record["writes_raw"] = linear
        self.parts = [each.part(ctx, self.block, UNITS) for each in features]
        self._doing = {name: doing(Part, name, self.parts) for name in IN_A_FRAME}
        self.painters: dict[str, RepresentationPainter] = {}
        """Those of the representations by their names, from the finest."""
        self.air: CardWinds
        self.site: Site | None = None
        self._staged: Staged | None = None
        self._beside = BackgroundCompiler(ctx)
        self._later: Iterator[None] = iter(())
        """Makes programs that no frame has drawn with yet, a piece a frame."""
        self._special: dict[str, str | int] = {}
        """What shaders are told of what is special about any kind of grass."""
        self._winds: Sequence[WindPrimitive] | None = None
        """One of each kind that it is ready for; None where no game has prepared."""

    @property
    def coarsest(self) -> RepresentationPainter:
        """The painter of the coarsest representation, which lies on the land."""
        return list(self.painters.values())[-1]

    def part(self, kind: type[Sort], /) -> Sort:
        """Return what is held of the feature whose parts are of a class."""
        return next(each for each in self.parts if isinstance(each, kind))

    def settle(self, site: Site) -> None:
        """Take over a site, and what has changed since the frame before; what has not stays in GL as it is."""
        for _ in self._settling(site):
            pass
        next(self._later, None)

    def steps(self, site: Site) -> int:
        """Return how many steps `preparing` takes at most."""
        times = 2 if compiles_in_background(self.ctx) else 1
        return 2 * len(self.parts) + 11 + sum(6 + times * each.programs for each in site.representations)

    def _making_ready(
        self, site: Site, air: CardWinds | None = None, painters: Mapping[str, RepresentationPainter] | None = None
    ) -> Iterator[None]:
        """Make room and programs for whatever winds will blow."""
        assert self._winds is not None
        painters = self.painters if painters is None else painters
        yield from self._beside.compile_together(chain.from_iterable(painter.texts() for painter in painters.values()))
        for painter in painters.values():
            yield from painter.making()
            painter.make_ready(site)
            yield
        air, winds = air or self.air, [*site.scene.wind, *self._winds]
        yield from self._making_for_winds(winds, air, painters)
        air.make_room(winds, receivers=READY_ROWS * ROW)

    def _making_for_winds(
        self, winds: Sequence[WindPrimitive], air: CardWinds, painters: Mapping[str, RepresentationPainter]
    ) -> Iterator[None]:
        """Make programs for winds of the kinds of these, and yield after each."""
        yield from air.expecting(winds)
        for painter in painters.values():
            yield from painter.making_for_winds()
        air.stand_ready()

    def _settling(self, site: Site) -> Iterator[None]:
        """Do what `settle` does, bit by bit; where that is left off, it begins anew the next time."""
        before = self.site
        for part in self._doing["settle"]:
            part.settle(site, self.record)
        if before is None or are_other_kinds(site, before):
            self._special = special_of(site)
        defines = dict(self._special)
        for part in self._doing["defines"]:
            defines |= part.defines()
        is_other = before is None or defines != self.block.defines or is_other_grass(site, before)
        if not is_other and site is before:
            return
        is_made = before is not None and is_other and self._stands_ready(site, before, defines)
        if is_made:
            while not self.stage(site):
                yield
            self._take(site)
        elif is_other:
            self.site = None
            yield from self._growing(site, defines)
        self.site = site
        for painter in self.painters.values():
            painter.settle(site, self.record)
        self.air.meet(site.scene.wind)
        if is_other and not is_made:
            yield from self._making_what_comes(site)

    def _making_what_comes(self, site: Site) -> Iterator[None]:
        """Make what later frames will need: all that a game has asked for, or what no card makes beside frames."""
        if self._winds is not None:
            yield from self._making_ready(site)
        elif not compiles_in_background(self.ctx):
            yield from self._later  # at once, as each program would hold a frame up

    def _fits(self, site: Site, before: Site) -> bool:
        """Return whether the programs that there are draw the grass of another site too."""
        return are_alike(site, before) and self._defines_of(site) == self.block.defines and all(
            each.name in self.painters and self.painters[each.name].fits(each) for each in site.representations
        )  # fmt: skip

    def _defines_of(self, site: Site) -> dict[str, str | int]:
        """Return what the programs of another site's grass are told."""
        return {name: told for name, told in self.block.defines.items() if name not in self._special} | special_of(site)

    def _stands_ready(self, site: Site, before: Site, defines: dict[str, str | int]) -> bool:
        """Return whether a site's grass is being brought into GL already, or can be beside what there is."""
        staged = self._staged
        if staged is not None and staged.representations is site.representations and staged.defines == defines:
            return True
        return defines == self.block.defines and self._fits(site, before)

    def stage(self, site: Site, /) -> bool:
        """Bring a piece of another site's grass into GL beside what is drawn; return whether all of it is there."""
        if self.site is None:
            return True  # it is brought there when it is drawn
        if self._staged is None or self._staged.representations is not site.representations:
            self._staged = staged = Staged(site.representations, self._defines_of(site))
            if self._fits(site, self.site):
                staged.steps = self._staging(site)
            else:
                staged.air = air = CardWinds(self.ctx, UNITS, site.growths)
                ready: Callable[[], Iterator[None]] | None = None
                if self._winds is not None:
                    ready = partial(self._making_ready, site, air, staged.painters)
                elif AHEAD and self.quarantine.live:
                    ready = partial(self._making_for_winds, self._kinds(site), air, staged.painters)
                staged.steps = staged.making(self._canvas(site, air), self._beside, site.scene.wind, ready)
        return next(self._staged.steps, "over") == "over"

    def _staging(self, site: Site) -> Iterator[None]:
        for each in site.representations:
            yield from self.painters[each.name].staging(site.representations)

    def _take(self, site: Site) -> None:
        """Draw from now on what was staged of a site."""
        staged, self._staged = self._staged, None
        assert staged is not None
        if staged.air is None:
            for painter in self.painters.values():
                painter.restock()
            self.air.regrow(site.growths)
            return
        self._let_go()
        self.block.defines, self.painters, self.air = staged.defines, staged.painters, staged.air

    def _growing(self, site: Site, defines: dict[str, str | int]) -> Iterator[None]:
        """Bring the grass into GL, a representation at a time."""
        self._let_go()
        self.block.defines = defines
        self.air = CardWinds(self.ctx, UNITS, site.growths)
        canvas = self._canvas(site, self.air)
        is_ahead, is_beside = AHEAD and self.quarantine.live, compiles_in_background(self.ctx)
        for each in site.representations:
            self.painters[each.name] = made = each.painter(canvas)
            yield
            if is_ahead and not is_beside:
                yield from made.making()
        if is_ahead:
            self._later = self._making_later(site)

    def _give_up(self) -> None:
        """Make no more of what no frame has drawn with."""
        self._beside.release()
        self._later = iter(())

    def _let_go(self) -> None:
        """Give back all that draws grass: there is none before the first frame, nor where that failed."""
        self._give_up()
        grass, self.painters = [*self.painters.values()], {}
        release_all(*grass, *([vars(self).pop("air")] if "air" in vars(self) else []))

    def _making_later(self, site: Site) -> Iterator[None]:
        """Have the driver make what no frame has drawn with yet, and then make it, which takes a moment by then.

        In the end make what receivers hear other winds with than there are now.
        """
        makers: list[RepresentationPainter | Part] = [*self.painters.values(), *self.parts]
        yield  # what the first frame draws with is made for it
        yield from self._beside.compile_in_turn(chain.from_iterable(each.texts() for each in makers))
        for each in makers:
            yield from each.making()
        if self._winds is None:
            yield from self._making_for_winds(self._kinds(site), self.air, self.painters)

    def _kinds(self, site: Site) -> list[WindPrimitive]:
        """Return winds of all kinds that there are."""
        return [*site.scene.wind, *self.winds.samples()]

    def _canvas(self, site: Site, air: CardWinds) -> Canvas:
        return Canvas(
            self.ctx, self.block, UNITS, site.scene.seed, site.transitions, air, self.received, site.reach,
            site.representations,
        )  # fmt: skip

    def release(self) -> None:
        """Give everything back to the context."""
        self._let_go()
        release_all(*self.parts, self.received, self.block, self._staged)
