"""Mowing: what a game has cut, sown and cleared of a prairie."""

from collections.abc import Mapping
from typing import Self

import moderngl

from ..around.outlook import Outlook
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Start
from ..space.grown import Grown
from .card import PlotsPart
from .mown import Mown
from .sown import carry_over


class Mowing(Feature):
    """How high grass is left to stand, and where it has been sown and cleared."""

    samplers = ("plots",)

    def __init__(self, mown: Mown) -> None:
        self.mown = mown

    @classmethod
    def begin(cls, start: Start, /) -> Self:
        """Return it with nothing cut."""
        return cls(Mown(start.grown.ground.terrain))

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Leave cut, sown and cleared what was so at a place."""
        del time
        self.mown.change(grown.ground.terrain)
        if grown.ground.density is not before.ground.density:
            then = list(before.scene.grass)
            was = [then.index(name) if name in then else None for name in grown.scene.grass]
            carry_over(before.ground.density, grown.ground.density, was)

    def look(self, outlook: Outlook, /) -> None:
        """Note what is cut."""
        outlook.note(self.mown)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> PlotsPart:
        """Return the maps of it."""
        del block
        return PlotsPart(ctx, units["plots"], self.mown)
