"""The saucer that the window's viewer flies: its motion by held keys, its tilt, its camera and its blast."""

import math
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

import numpy as np

from ..components.body import Body
from ..components.pose import Pose
from ..engine.camera import Camera, ahead, forward
from ..systems.bodies.fly import foot, lean, level
from ..systems.prairie import Prairie
from ..systems.wind.blast import Blast, Shape
from .studio.walker import Ground, Move, Walker, on_terrain, settled

CRUISE, FAST = 8.0, 20.0
"""Speeds ahead [m/s]; backwards it has half of them."""

TURN = 1.1
"""Rate of turning [rad/s]."""

TURNING, POWER, GLIDE, TRAIL = 0.25, 0.55, 0.75, 0.4
"""Time constants with which turning, power, velocity and the trailing camera approach their targets [s]."""

DISTANCE, OVER = 11.0, 0.3
"""Distance of the camera from the point that it looks at, and height of that point above the saucer's middle [m].
The grass that the jet presses down stays in the picture."""

CLEAR = 1.0
"""Least height of the camera above the ground [m]."""

LOWEST_LOOK, HIGHEST_LOOK = -1.2, 0.4
"""Lowest and highest pitch of the camera [rad]."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_AT, _WEIGHT = (_NODES + 1.0) / 2.0, _WEIGHTS / 2.0

BLAST = Blast(outline=Shape(disc=3.5))
"""Wind of the saucer's jet."""


@dataclass(frozen=True, slots=True)
class Saucer:
    """A saucer that the viewer flies, and the camera that follows it."""

    place: tuple[float, float, float]
    """Position of its middle (x, y, z) [m]."""

    yaw: float = 0.0
    """Heading: 0 is -z, positive turns right; not wrapped at a full turn [rad]."""

    velocity: tuple[float, float] = (0.0, 0.0)
    """Velocity along x and z [m/s]."""

    turning: float = 0.0
    """Rate of the heading, positive to the right [rad/s]."""

    power: float = 0.0
    """Speed ahead that the velocity approaches [m/s]."""

    trail: float = 0.0
    """Heading of the trailing camera [rad]."""

    aside: float = 0.0
    """Angle by which the viewer looks to the right of the camera's heading [rad]."""

    pitch: float = -0.3
    """Pitch of the camera, positive from below [rad]."""


def launched(x: float, z: float, yaw: float, ground: Ground, /) -> Saucer:
    """Return a saucer that hovers at the nearest place of the terrain to (x, z) [m], with the camera behind it."""
    return put(Saucer((x, 0.0, z), yaw, trail=yaw), ground)


def put(saucer: Saucer, ground: Ground, /) -> Saucer:
    """Return the saucer at the nearest place over this terrain, at its height above the grass."""
    x, z, _, _ = on_terrain(saucer.place[0], saucer.place[2], ground)
    return replace(saucer, place=(x, level(x, z, ground.top_at), z))


def looked(saucer: Saucer, /, *, right: float, up: float) -> Saucer:
    """Return the saucer after the viewer has turned the look around it by two angles [rad]."""
    aside = math.remainder(saucer.aside + right, math.tau)
    return replace(saucer, aside=aside, pitch=max(LOWEST_LOOK, min(HIGHEST_LOOK, saucer.pitch + up)))


def flown(saucer: Saucer, held: AbstractSet[Move], dt: float, ground: Ground, /) -> Saucer:
    """Return the saucer after `dt` [s] of the held keys, over the terrain and at its height above the grass.

    Turning and power approach the values asked for exponentially, the velocity approaches the power along the heading,
    and the camera approaches the heading. The integration is exact, so that for constant keys the result does not
    depend on the frames into which time is cut.
    """
    asked, turn = _asked(held)
    times = _AT * dt
    yaw = saucer.yaw + turn * times + (saucer.turning - turn) * TURNING * -np.expm1(-times / TURNING)
    power = asked + (saucer.power - asked) * np.exp(-times / POWER)
    pull = power * np.stack([np.sin(yaw), -np.cos(yaw)])
    fresh = np.exp((times - dt) / GLIDE)
    remaining = math.exp(-dt / GLIDE)
    start = np.array(saucer.velocity)
    velocity = start * remaining + dt / GLIDE * (pull * fresh) @ _WEIGHT
    shift = start * GLIDE * (1.0 - remaining) + dt * (pull * (1.0 - fresh)) @ _WEIGHT
    trail = saucer.trail * math.exp(-dt / TRAIL) + dt / TRAIL * float((yaw * np.exp((times - dt) / TRAIL)) @ _WEIGHT)
    x, z, free_x, free_z = on_terrain(saucer.place[0] + float(shift[0]), saucer.place[2] + float(shift[1]), ground)
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
    """Return the body to draw: it banks into turns, and lowers its nose to accelerate."""
    ahead = forward(saucer.yaw, 0.0)
    x, z = ((saucer.power * ahead[axis] - saucer.velocity[i]) / GLIDE for i, axis in enumerate((0, 2)))
    nose, bank = lean(saucer.velocity, (x, z), saucer.yaw)
    return Body(saucer.place, saucer.yaw, nose, bank)


def jet(saucer: Saucer, ground: Ground, /) -> Pose:
    """Return the pose at which its jet meets the ground: displaced by its height times the tangent of its tilt."""
    return foot(body(saucer), ground.height_at)


def chase(saucer: Saucer, view: float, ground: Ground, /) -> Camera:
    """Return the camera behind and above the saucer, above the ground, with a vertical angle of view [rad]."""
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
    """A saucer in flight: an entity of the prairie with a body, a blast and a pose.

    It begins ahead of the walker who boards it, so that the camera behind it begins about where the walker stood.
    """

    def __init__(self, prairie: Prairie, walker: Walker, ground: Ground) -> None:
        (x, _, z), yaw = walker.position, walker.yaw
        self.saucer = launched(*ahead((x, z), yaw, DISTANCE), yaw, ground)
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
        """Remove the saucer, and return its pilot as a walker on the ground below, with the same direction of view."""
        self._prairie.remove(self._entity)
        x, y, z = self.saucer.place
        return settled(Walker((x, y, z), self.camera(1.0, ground).yaw), ground)

    def _follow(self, ground: Ground) -> None:
        self._prairie.move(self._entity, jet(self.saucer, ground))
        self._prairie.world.add(self._entity, body(self.saucer))
