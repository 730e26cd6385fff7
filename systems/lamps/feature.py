"""The feature of lamps and shades: entities of a game, and lamps of the scene."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import moderngl
import numpy as np

from ...components.arrays import Point
from ...components.lamp import Lamp
from ...components.pose import Pose
from ...components.shade import Shade
from ...engine.declared.lamp import LampOnPath
from ...engine.terrain.sample import height_at
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Start
from ..space.grown import Grown
from .card import LampPart, Lit


class Lamps(Feature):
    """Feature: entities of one world with a `Lamp` and a `Pose`, or a `Shade`, and lamps that the scene declares."""

    samplers = ("listed",)

    def __init__(self, start: Start, /) -> None:
        self._world, self._grown = start.world, start.grown
        self.shining: list[Lit] = []
        """Lamps of this frame, with their poses."""

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Take over a scene that was read again."""
        self._grown = grown

    def step(self, viewer: str, eye: Point, /, *, time: float) -> None:
        """Collect all lamps with their poses at a time [s]."""
        declared = self._grown.scene.lamps
        self.shining = self._games() + (self._scenes(declared, time) if declared else [])

    def _games(self) -> list[Lit]:
        """Return the lamps of a game's entities."""
        lamps = [(entity, lamp, self._world.find(entity, Pose)) for entity, lamp in self._world.all(Lamp)]
        stands = self._world.standing([(entity, pose) for entity, _, pose in lamps], "the lamp", high=True)
        return [(lamp, pose) for (_, lamp, pose), is_there in zip(lamps, stands, strict=True) if pose and is_there]

    def _scenes(self, declared: Sequence[LampOnPath], time: float) -> list[Lit]:
        """Return the scene's lamps at a time [s], at their heights above the ground."""
        poses = [lamp.pose(time=time) for lamp in declared]
        grounds = height_at(self._grown.ground.terrain, np.array([(pose.x, pose.z) for pose in poses], np.float32))
        heights = [float(ground) + lamp.height for ground, lamp in zip(grounds, declared, strict=True)]
        return [
            (lamp.lamp(), replace(pose, y=height)) for lamp, pose, height in zip(declared, poses, heights, strict=True)
        ]

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> LampPart:
        """Return the part that uploads lamps and shades."""
        return LampPart(ctx, units["listed"], lambda: self.shining, self._shades)

    def _shades(self) -> tuple[list[Shade], float]:
        """Return a game's shades, and the height of the lowest ground [m]."""
        shades = [shade for _, shade in self._world.all(Shade)]
        return shades, self._grown.ground.terrain.span[0] if shades else 0.0
