"""The saucer that the viewer of the window flies over a prairie, and its blast."""

from collections.abc import Set as AbstractSet
from math import cos, sin

from ..engine.camera import Camera
from ..systems.prairie import Prairie
from ..systems.wind.blast import Blast, Shape
from .saucer import DISTANCE, body, chase, flown, jet, launched, looked, put
from .studio.walker import Ground, Move, Walker, settled

BLAST = Blast(outline=Shape(disc=3.5))
"""What its jet does to the grass."""


class Flight:
    """A saucer in flight: one entity of the prairie that has a body, a blast and a pose.

    It sets out ahead of who boards it, so that the camera behind it starts about where that one stood.
    """

    def __init__(self, prairie: Prairie, walker: Walker, ground: Ground) -> None:
        x, _, z = walker.position
        self.saucer = launched(x + DISTANCE * sin(walker.yaw), z - DISTANCE * cos(walker.yaw), walker.yaw, ground)
        self._prairie = prairie
        self._entity = prairie.add(BLAST, pose=jet(self.saucer, ground), name="saucer")
        self._follow(ground)

    def step(self, held: AbstractSet[Move], dt: float, ground: Ground) -> None:
        """Fly on by `dt` [s] of the held keys, with the blast."""
        self.saucer = flown(self.saucer, held, dt, ground)
        self._follow(ground)

    def look(self, *, right: float, up: float) -> None:
        """Turn the look around the saucer by two angles [rad]."""
        self.saucer = looked(self.saucer, right=right, up=up)

    def camera(self, view: float, ground: Ground) -> Camera:
        """Return the camera that follows it."""
        return chase(self.saucer, view, ground)

    def settle(self, ground: Ground) -> None:
        """Fly on at the same place over other ground."""
        self.saucer = put(self.saucer, ground)
        self._follow(ground)

    def leave(self, ground: Ground) -> Walker:
        """Take the saucer away and return who stood in it: on the ground below, and looking the same way."""
        self._prairie.remove(self._entity)
        x, y, z = self.saucer.place
        return settled(Walker((x, y, z), self.camera(1.0, ground).yaw), ground)

    def _follow(self, ground: Ground) -> None:
        self._prairie.move(self._entity, jet(self.saucer, ground))
        self._prairie.world.add(self._entity, body(self.saucer))
