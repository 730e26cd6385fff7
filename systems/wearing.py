"""Wearing: grass grows thinner each time that a presser which wears it off goes over it."""

from collections.abc import Iterable
from math import atan2, hypot

from ..components.footprint import Footprint
from ..components.pose import Pose
from ..components.presser import Presser
from ..engine.terrain.record import Density
from .mow.sown import wear

STEP = 1.0
"""Length of way that is worn at a time, in radii."""

JUMP = 5.0
"""Distance beyond which a move in one frame is a jump [m], which wears nothing off."""


class Wearing:
    """The ways of all pressers that wear grass off, as far as they are worn."""

    def __init__(self) -> None:
        self._worn: dict[int, tuple[float, float]] = {}
        """Place (x, z) [m] up to which each entity's way is worn."""

    def go(self, pressers: Iterable[tuple[int, Presser, Pose]], density: Density, /) -> None:
        """Thin the grass on the ways that all wearing `pressers` have gone since the last call."""
        there = dict[int, tuple[float, float]]()
        for entity, presser, pose in pressers:
            x, z = self._worn.get(entity, (pose.x, pose.z))
            half = max(abs(x) for x, _ in presser.corners) if presser.corners else presser.radius
            step, far = STEP * half, hypot(pose.x - x, pose.z - z)
            if far > JUMP:
                x, z, far = pose.x, pose.z, 0.0
            while far >= step:
                ahead = (pose.x - x) / far, (pose.z - z) / far
                own = Footprint(corners=((-half, -step), (half, -step), (half, 0.0), (-half, 0.0)))
                wear(density, own, Pose(x, z, atan2(ahead[0], -ahead[1])), presser.wear)
                x, z, far = x + step * ahead[0], z + step * ahead[1], far - step
            there[entity] = x, z
        self._worn = there
