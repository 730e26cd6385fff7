"""The feature of mowing: what a game has cut, sown and cleared."""

from collections.abc import Mapping

import moderngl

from ..around.outlook import Outlook
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Start
from ..space.grown import Grown
from .card import PlotsPart
from .mown import Mown
from .sown import carry_over


class Mowing(Feature):
    """Feature: the map of cut heights, and the changed densities."""

    samplers = ("plots",)

    def __init__(self, start: Start, /) -> None:
        self.mown = Mown(start.grown.ground.terrain)

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Carry over what is cut, sown and cleared to another terrain, or other kinds and painted densities."""
        self.mown.change(grown.ground.terrain)
        if grown.ground.density is not before.ground.density:
            names = list(before.scene.grass)
            old_kinds = [names.index(name) if name in names else None for name in grown.scene.grass]
            carry_over(before.ground.density, grown.ground.density, old_kinds)

    def look(self, outlook: Outlook, /) -> None:
        """Note the map of cut heights in the outlook."""
        outlook.note(self.mown)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> PlotsPart:
        """Return the part that uploads both maps."""
        return PlotsPart(ctx, units["plots"], self.mown)
