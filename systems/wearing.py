"""Wearing: grass grows thinner each time that a presser which wears it off goes over it."""

from collections.abc import Iterable
from math import hypot

from ..components.arrays import Place
from ..components.pose import Pose
from ..components.presser import Presser
from ..engine.terrain.plots import CELL
from ..engine.terrain.record import Density
from .mow.worn import Step, wear
from .press.trail import FASTEST, JUMP

STEP, LEAST_STEP = 1.0, CELL
"""Length of way that is worn at a time, in radii, and at least [m]: shorter steps would wear cells more than once."""


class Wearing:
    """The ways of all pressers that wear grass off, as far as they are worn."""

    def __init__(self, worn: dict[int, Place] | None = None) -> None:
        self.worn: dict[int, Place] = worn or {}
        """Place (x, z) [m] up to which each entity's way is worn."""

    def go(self, pressers: Iterable[tuple[int, Presser, Pose]], density: Density, /, *, elapsed: float) -> None:
        """Thin the grass on the ways that all wearing `pressers` have gone since the last call, `elapsed` [s] ago.

        Who has jumped treads on nothing between, and wears nothing off.
        """
        there, steps = dict[int, Place](), list[Step]()
        farthest = JUMP + FASTEST * elapsed
        for entity, presser, pose in pressers:
            x, z = self.worn.get(entity, (pose.x, pose.z))
            half = max(abs(x) for x, _ in presser.corners) if presser.corners else presser.radius
            step, far = max(STEP * half, LEAST_STEP), hypot(pose.x - x, pose.z - z)
            if far > farthest + step:  # a part of the last step may still be to wear
                x, z, far = pose.x, pose.z, 0.0
            while far >= step:
                ahead = (pose.x - x) / far, (pose.z - z) / far
                steps.append(Step(x, z, *ahead, half, step, presser.wear))
                x, z, far = x + step * ahead[0], z + step * ahead[1], far - step
            there[entity] = x, z
        self.worn = there
        wear(density, steps)
