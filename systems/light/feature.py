"""Light: the sun and the sky of a prairie."""

from collections.abc import Mapping
from typing import Self

import moderngl

from ..frame.block import FrameBlock
from ..frame.feature import Eye, Feature, Start
from ..space.grown import Grown
from .draw import LightPart
from .shining import Shining


class Lighting(Feature):
    """What shines, and how the terrain lies to it."""

    samplers = ("lie", "repeating")
    own = ("sky", "clouds", "billows", "heaps")

    def __init__(self, shining: Shining) -> None:
        self.shining = shining

    @classmethod
    def begin(cls, start: Start, /) -> Self:
        """Return the light that a scene declares."""
        return cls(Shining(start.grown.scene.light, live=start.live))

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Shine as the scene says by now, if it says something else."""
        if grown.scene.light != before.scene.light:
            self.shining.declare(grown.scene.light, time=time)

    def step(self, viewer: str, eye: Eye, /, *, time: float) -> None:
        """Let the light go on."""
        del eye
        self.shining.step(viewer, time=time)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> LightPart:
        """Return the sky, and the maps that light varies by."""
        return LightPart(ctx, block, units, self.shining)
