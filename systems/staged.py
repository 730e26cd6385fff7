"""The grass of another site, on its way into GL beside what is drawn."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

from ..components.wind import WindPrimitive
from ..engine.gl.background import BackgroundCompiler
from ..engine.gl.stream import release_all
from .frame.block import FrameBlock
from .show.representation import Canvas, Representation, RepresentationPainter
from .site import Site
from .wind.card import CardWinds


@dataclass(slots=True, eq=False)
class Staged:
    """What there is of it so far."""

    representations: Sequence[Representation]
    defines: dict[str, str | int]
    """What programs are told that draw it."""

    steps: Iterator[None] = field(default_factory=lambda: iter(()))
    """What brings the rest into GL."""

    air: CardWinds | None = None
    """Of painters of its own; None where those that there are will draw it."""

    painters: dict[str, RepresentationPainter] = field(default_factory=dict)

    def making(
        self,
        canvas: Canvas,
        beside: BackgroundCompiler,
        winds: Sequence[WindPrimitive],
        ready: Callable[[], Iterator[None]] | None,
        /,
    ) -> Iterator[None]:
        """Make painters of its own, as it needs other programs: one of these at a time, after the driver has beside.

        Then do what `ready` returns, if a game has prepared.
        """
        block = canvas.block
        for each in self.representations:
            with _told(block, self.defines):
                self.painters[each.name] = painter = each.painter(canvas)
            yield
            yield from _telling(block, self.defines, beside.compile_in_turn(painter.texts()))
            yield from _telling(block, self.defines, painter.making())
        with _told(block, self.defines):
            canvas.air.meet(winds)
        if ready is not None:
            yield from _telling(block, self.defines, ready())

    def release(self) -> None:
        """Give everything back that nobody has taken over."""
        release_all(*self.painters.values(), self.air)


@contextmanager
def _told(block: FrameBlock, defines: dict[str, str | int]) -> Iterator[None]:
    """Let programs that are made meanwhile be told something else."""
    before, block.defines = block.defines, defines
    try:
        yield
    finally:
        block.defines = before


def _telling(block: FrameBlock, defines: dict[str, str | int], steps: Iterator[None]) -> Iterator[None]:
    while True:
        with _told(block, defines):
            if next(steps, "over") == "over":
                return
        yield


def special_of(site: Site, /) -> dict[str, str | int]:
    """Return what shaders are told of what is special about any kind of a site's grass."""
    return {name: told for each in site.representations for name, told in each.defines(site).items()}


def are_alike(site: Site, before: Site, /) -> bool:
    """Return whether two sites differ in nothing that painters are made of but what has grown of their kinds."""
    same = site.quality == before.quality and site.reach == before.reach and site.scene.seed == before.scene.seed
    return same and len(site.growths) == len(before.growths)


def are_other_kinds(site: Site, before: Site, /) -> bool:
    """Return whether what is special about any kind may be something else."""
    same = site.growths is before.growths and site.coming is before.coming
    return not same or site.own_segments != before.own_segments


def is_other_grass(site: Site, before: Site, /) -> bool:
    """Return whether what representations draw is made of something else."""
    if site is before:
        return False
    return not (site.growths == before.growths and site.coming == before.coming and are_alike(site, before))
