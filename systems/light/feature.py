"""The feature of light: a prairie's sun and sky."""

from collections.abc import Mapping

import moderngl

from ...components.arrays import Point
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Start
from ..space.grown import Grown
from .draw import LightPart
from .shining import Shining


class Lighting(Feature):
    """Feature: sun, sky, clouds, and the terrain's slope and horizon maps."""

    samplers = ("lie", "repeating")
    own = ("sky", "clouds", "billows", "heaps")

    def __init__(self, start: Start, /) -> None:
        self.shining = Shining(start.grown.scene.light, live=start.live)

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Take the light of a scene that was read again, if it has changed."""
        if grown.scene.light != before.scene.light:
            self.shining.declare(grown.scene.light, time=time)

    def step(self, viewer: str, eye: Point, /, *, time: float) -> None:
        """Advance the light to a time [s]."""
        self.shining.step(viewer, time=time)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> LightPart:
        """Return the part that draws the sky and holds the maps of light."""
        return LightPart(ctx, block, units, self.shining)
