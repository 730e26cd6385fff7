"""Mowing: what a game has cut of a prairie."""

from collections.abc import Mapping
from typing import Self

import moderngl

from ..around.outlook import Outlook
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Start
from ..space.grown import Grown
from .card import MownPart
from .mown import Mown


class Mowing(Feature):
    """How high grass is left to stand."""

    samplers = ("mown",)

    def __init__(self, mown: Mown) -> None:
        self.mown = mown

    @classmethod
    def begin(cls, start: Start, /) -> Self:
        """Return it with nothing cut."""
        return cls(Mown(start.grown.ground.terrain))

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Leave cut what was cut at a place."""
        del before, time
        self.mown.change(grown.ground.terrain)

    def look(self, outlook: Outlook, /) -> None:
        """Note what is cut."""
        outlook.note(self.mown)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> MownPart:
        """Return the map of it."""
        del block
        return MownPart(ctx, units["mown"], self.mown)
