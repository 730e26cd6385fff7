"""Staging: the grass of another site is uploaded piece by piece while the present one is drawn."""

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass, field

from ..components.wind import WindPrimitive
from ..engine.gl.background import BackgroundCompiler
from ..engine.gl.stream import release_all
from .show.representation import Canvas, Representation, RepresentationPainter
from .site import Site, same_settings
from .wind.card import CardWinds


@dataclass(slots=True, eq=False)
class Staged:
    """The part of another site's grass that is in GL so far."""

    representations: Sequence[Representation]
    defines: dict[str, str | int]
    """Defines of the programs that draw it."""

    steps: Generator[None, None, None] = field(default_factory=lambda: (None for _ in ()))
    """Uploads the rest, a piece a step."""

    air: CardWinds | None = None
    """Winds for painters of its own; None if the present painters will draw it."""

    painters: dict[str, RepresentationPainter] = field(default_factory=dict)
    """Its own painters by the names of their representations; empty if the present painters will draw it."""

    def making(
        self,
        canvas: Canvas,
        compiler: BackgroundCompiler,
        winds: Sequence[WindPrimitive],
        ready: Callable[[], Iterator[None]] | None,
        /,
    ) -> Generator[None, None, None]:
        """Make its own painters, one program at a time, each once the driver has compiled it in the background.

        Then take the steps that `ready` returns, if it is given.
        """
        for representation in self.representations:
            self.painters[representation.name] = painter = representation.painter(canvas)
            yield
            yield from compiler.compile_in_turn(painter.texts())
            yield from painter.making()
        canvas.air.meet(winds)
        if ready is not None:
            yield from ready()

    def release(self) -> None:
        """Release everything that has not been taken over; what the present painters hold is theirs to release."""
        self.steps.close()
        release_all(*self.painters.values(), self.air)


def kind_defines(site: Site, /) -> dict[str, str | int]:
    """Return the defines that depend on a site's kinds of grass."""
    return {name: value for each in site.representations for name, value in each.defines(site).items()}


def kinds_changed(site: Site, before: Site, /) -> bool:
    """Return whether `kind_defines` may differ between two sites."""
    same = site.growths is before.growths and site.coming is before.coming
    return not same or site.own_segments != before.own_segments


def grass_changed(site: Site, before: Site, /) -> bool:
    """Return whether the grass that representations draw differs between two sites."""
    if site is before:
        return False
    return not (site.growths == before.growths and site.coming == before.coming and same_settings(site, before))
