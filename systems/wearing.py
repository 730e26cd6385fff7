"""Wearing: grass grows thinner each time that a presser which wears it off goes over it."""

from collections.abc import Iterable
from functools import lru_cache
from math import atan2, hypot

from ..components.arrays import Place
from ..components.footprint import Footprint
from ..components.pose import Pose
from ..components.presser import Presser
from ..engine.terrain.plots import CELL
from ..engine.terrain.record import Density
from .mow.sown import wear

STEP, LEAST_STEP = 1.0, CELL
"""Length of way that is worn at a time, in radii, and at least [m]: shorter steps would wear cells more than once."""

JUMP = 5.0
"""Distance beyond which a move in one frame is a jump [m], which wears nothing off."""


class Wearing:
    """The ways of all pressers that wear grass off, as far as they are worn."""

    def __init__(self, worn: dict[int, Place] | None = None) -> None:
        self.worn: dict[int, Place] = worn or {}
        """Place (x, z) [m] up to which each entity's way is worn."""

    def go(self, pressers: Iterable[tuple[int, Presser, Pose]], density: Density, /) -> None:
        """Thin the grass on the ways that all wearing `pressers` have gone since the last call."""
        there = dict[int, Place]()
        for entity, presser, pose in pressers:
            x, z = self.worn.get(entity, (pose.x, pose.z))
            half = max(abs(x) for x, _ in presser.corners) if presser.corners else presser.radius
            step, far = max(STEP * half, LEAST_STEP), hypot(pose.x - x, pose.z - z)
            if far > JUMP:
                x, z, far = pose.x, pose.z, 0.0
            while far >= step:
                ahead = (pose.x - x) / far, (pose.z - z) / far
                wear(density, _step_ahead(half, step), Pose(x, z, atan2(ahead[0], -ahead[1])), presser.wear)
                x, z, far = x + step * ahead[0], z + step * ahead[1], far - step
            there[entity] = x, z
        self.worn = there


@lru_cache(maxsize=64)
def _step_ahead(half: float, step: float) -> Footprint:
    """Return the ground under a step of a presser of half a width [m]."""
    return Footprint(corners=((-half, -step), (half, -step), (half, 0.0), (-half, 0.0)))
