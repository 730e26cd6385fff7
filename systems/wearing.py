"""Wearing: where those go that wear grass off, less of it grows each time."""

from collections.abc import Iterable
from math import atan2, hypot

from ..components.footprint import Footprint
from ..components.pose import Pose
from ..components.presser import Presser
from ..engine.terrain.record import Density
from .mow.sown import wear

STEP = 1.0
"""How far somebody goes until what lies under that way is worn, in radii."""

JUMP = 5.0
"""Who is farther away all at once has jumped [m], and wore off nothing."""


class Wearing:
    """How far each of those has worn its way who wear grass off."""

    def __init__(self) -> None:
        self._worn: dict[int, tuple[float, float]] = {}
        """Up to where, (x, z) [m], by entity."""

    def go(self, pressers: Iterable[tuple[int, Presser, Pose]], density: Density, /) -> None:
        """Wear off what lies on the ways that these, all who do, have gone since they were seen last."""
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
