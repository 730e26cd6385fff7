"""The saucer that the viewer of the window flies: where it is and how it leans, by what is pressed, and its blast."""

import math
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

import numpy as np

from ..components.body import Body
from ..components.pose import Pose
from ..engine.camera import Camera, forward
from ..systems.bodies.fly import foot, lean, level
from ..systems.prairie import Prairie
from ..systems.wind.blast import Blast, Shape
from .studio.walker import Ground, Move, Walker, on_terrain, settled

CRUISE, FAST = 8.0, 20.0
"""Speeds ahead [m/s]; back it is half as fast."""

TURN = 1.1
"""How fast it turns [rad/s]."""

TURNING, POWER, GLIDE, TRAIL = 0.25, 0.55, 0.75, 0.4
"""Times in which turning, power, velocity and the camera behind come within 1/e of what they are drawn to [s]."""

DISTANCE, OVER = 11.0, 0.3
"""The camera's distance from the point that it looks at, and how far that is above the saucer's middle [m]: so far
that the grass that the jet presses down is in the picture."""

CLEAR = 1.0
"""Least height of the camera above the ground [m]."""

LOWEST_LOOK, HIGHEST_LOOK = -1.2, 0.4
"""How far the camera may look down and up at the saucer [rad]."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_AT, _WEIGHT = (_NODES + 1.0) / 2.0, _WEIGHTS / 2.0

BLAST = Blast(outline=Shape(disc=3.5))
"""What its jet does to the grass."""


@dataclass(frozen=True, slots=True)
class Saucer:
    """A saucer that the viewer flies, and the camera that follows it."""

    place: tuple[float, float, float]
    """Its middle (x, y, z) [m]."""

    yaw: float = 0.0
    """Heading: 0 is -z, positive turns right; it goes on beyond a full turn [rad]."""

    velocity: tuple[float, float] = (0.0, 0.0)
    """Along x and z [m/s]."""

    turning: float = 0.0
    """How fast the heading turns right [rad/s]."""

    power: float = 0.0
    """The speed ahead that its jet would bring it to [m/s]."""

    trail: float = 0.0
    """The heading that the camera has come round to [rad]."""

    aside: float = 0.0
    """How far the viewer looks to the right of that [rad]."""

    pitch: float = -0.3
    """How steeply the camera looks at it, positive from below [rad]."""


def launched(x: float, z: float, yaw: float, ground: Ground, /) -> Saucer:
    """Return a saucer that hovers at the place of the terrain nearest to (x, z) [m], with the camera behind it."""
    return put(Saucer((x, 0.0, z), yaw, trail=yaw), ground)


def put(saucer: Saucer, ground: Ground, /) -> Saucer:
    """Return the saucer where it is, but over this terrain and at its height above the grass."""
    x, z, _, _ = on_terrain(saucer.place[0], saucer.place[2], ground)
    return replace(saucer, place=(x, level(x, z, ground.top_at), z))


def looked(saucer: Saucer, /, *, right: float, up: float) -> Saucer:
    """Return the saucer after the viewer has turned the look around it by two angles [rad]."""
    aside = math.remainder(saucer.aside + right, math.tau)
    return replace(saucer, aside=aside, pitch=max(LOWEST_LOOK, min(HIGHEST_LOOK, saucer.pitch + up)))


def flown(saucer: Saucer, held: AbstractSet[Move], dt: float, ground: Ground, /) -> Saucer:
    """Return the saucer after `dt` [s] of the held keys, over the terrain and at its height above the grass.

    Turning and power approach what is asked for exponentially, the velocity approaches the power along the heading,
    and the camera the heading. All this is integrated exactly, so that the result does not depend on how time is cut
    into frames as long as the keys stay.
    """
    asked, turn = _asked(held)
    at = _AT * dt
    yaw = saucer.yaw + turn * at + (saucer.turning - turn) * TURNING * -np.expm1(-at / TURNING)
    power = asked + (saucer.power - asked) * np.exp(-at / POWER)
    pull = power * np.stack([np.sin(yaw), -np.cos(yaw)])
    fresh = np.exp((at - dt) / GLIDE)
    left = math.exp(-dt / GLIDE)
    start = np.array(saucer.velocity)
    velocity = start * left + dt / GLIDE * (pull * fresh) @ _WEIGHT
    way = start * GLIDE * (1.0 - left) + dt * (pull * (1.0 - fresh)) @ _WEIGHT
    trail = saucer.trail * math.exp(-dt / TRAIL) + dt / TRAIL * float((yaw * np.exp((at - dt) / TRAIL)) @ _WEIGHT)
    x, z, free_x, free_z = on_terrain(saucer.place[0] + float(way[0]), saucer.place[2] + float(way[1]), ground)
    slower = math.exp(-dt / TURNING)
    return replace(
        saucer,
        place=(x, level(x, z, ground.top_at), z),
        yaw=saucer.yaw + turn * dt + (saucer.turning - turn) * TURNING * (1.0 - slower),
        velocity=(float(velocity[0]) * free_x, float(velocity[1]) * free_z),
        turning=turn + (saucer.turning - turn) * slower,
        power=asked + (saucer.power - asked) * math.exp(-dt / POWER),
        trail=trail,
    )


def body(saucer: Saucer, /) -> Body:
    """Return what is drawn of it: it banks into turns, and lowers its nose to go faster."""
    ahead = forward(saucer.yaw, 0.0)
    x, z = ((saucer.power * ahead[axis] - saucer.velocity[i]) / GLIDE for i, axis in enumerate((0, 2)))
    nose, bank = lean(saucer.velocity, (x, z), saucer.yaw)
    return Body(saucer.place, saucer.yaw, nose, bank)


def jet(saucer: Saucer, ground: Ground, /) -> Pose:
    """Return where its jet meets the ground: displaced by its height times the tangent of its tilt."""
    return foot(body(saucer), ground.height_at)


def chase(saucer: Saucer, view: float, ground: Ground, /) -> Camera:
    """Return the camera behind and above it, with a vertical angle of view [rad]; it stays above the ground."""
    yaw, pitch = saucer.trail + saucer.aside, saucer.pitch
    ahead = forward(yaw, pitch)
    x, y, z = (saucer.place[i] + OVER * (i == 1) - DISTANCE * ahead[i] for i in range(3))
    floor = ground.height(x, z) + CLEAR
    if y < floor:
        y, pitch = floor, math.atan2(saucer.place[1] + OVER - floor, DISTANCE * math.cos(pitch))
    return Camera((x, y, z), math.remainder(yaw, math.tau), pitch, view)


def _asked(held: AbstractSet[Move]) -> tuple[float, float]:
    """Return the speed ahead [m/s] and the turning [rad/s] that the held keys ask for."""
    speed = FAST if "run" in held else CRUISE
    along = ("ahead" in held) - 0.5 * ("back" in held) if ("ahead" in held) != ("back" in held) else 0.0
    return along * speed, (("right" in held) - ("left" in held)) * TURN


class Flight:
    """A saucer in flight: one entity of the prairie that has a body, a blast and a pose.

    It sets out ahead of who boards it, so that the camera behind it starts about where that one stood.
    """

    def __init__(self, prairie: Prairie, walker: Walker, ground: Ground) -> None:
        (x, _, z), yaw = walker.position, walker.yaw
        self.saucer = launched(x + DISTANCE * math.sin(yaw), z - DISTANCE * math.cos(yaw), yaw, ground)
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
