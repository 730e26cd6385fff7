"""Motion of the window's viewer: pure functions from held keys to its position."""

import math
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ...engine.camera import Camera, Heights, forward

Move = Literal["ahead", "back", "left", "right", "up", "down", "run"]
"""Motion that a held key asks for."""

EYE = 1.7
"""Height of a walker's eye above the ground [m]."""

LOWEST = 0.3
"""Least height of a flyer's eye above the ground [m]."""

WALK, RUN, FLY, FLY_FAST = 1.5, 5.0, 8.0, 32.0
"""Speeds [m/s]."""

REACTION = 0.12
"""Time constant with which the velocity approaches the one asked for [s]."""

LANDING = 0.25
"""Time constant with which a landing flyer approaches a walker's height [s]."""

MARGIN = 0.5
"""Least distance from the edge of the terrain [m]."""

STEEPEST = math.radians(89.0)
"""Steepest look up or down [rad]."""


@dataclass(frozen=True, slots=True)
class Walker:
    """The viewer, on foot or in flight."""

    position: tuple[float, float, float]
    """Position of the eye (x, y, z) [m]."""

    yaw: float = 0.0
    """Yaw: 0 looks down -z, positive turns right [rad]."""

    pitch: float = 0.0
    """Pitch: positive looks up [rad]."""

    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Velocity (x, y, z) [m/s]; on foot y is not used."""

    flying: bool = False
    """Whether it flies instead of walking."""

    def camera(self, view: float) -> Camera:
        """Return the camera at its eye with a vertical angle of view [rad]."""
        return Camera(self.position, self.yaw, self.pitch, view)


@dataclass(frozen=True, slots=True)
class Ground:
    """The ground of a walker."""

    height_at: Heights
    """Returns heights of the ground [m] at ground positions (n, 2)."""

    size: tuple[float, float]
    """Width (x) and depth (z) of the terrain, centred on the origin [m]."""

    top_at: Heights
    """Returns heights of the grass's top [m] at ground positions (n, 2)."""

    def height(self, x: float, z: float) -> float:
        """Return the height of the ground at one place [m]."""
        return float(self.height_at(np.array([[x, z]], np.float32))[0])


def start(camera: Camera, ground: Ground, /) -> Walker:
    """Return the walker that takes over from a camera: on foot, or in flight where the camera stands high up."""
    x, z, _, _ = on_terrain(camera.position[0], camera.position[2], ground)
    floor = ground.height(x, z)
    flying = camera.position[1] > floor + 2.0 * EYE
    y = camera.position[1] if flying else floor + EYE
    return Walker((x, y, z), camera.yaw, _bounded(camera.pitch), flying=flying)


def turned(walker: Walker, /, *, right: float, up: float) -> Walker:
    """Return the walker after it has turned its head by two angles [rad]."""
    yaw = math.remainder(walker.yaw + right, math.tau)
    return replace(walker, yaw=yaw, pitch=_bounded(walker.pitch + up))


def asked_velocity(walker: Walker, held: AbstractSet[Move], /) -> tuple[float, float, float]:
    """Return the velocity (x, y, z) [m/s] that the held keys ask for; opposite keys cancel, diagonals are no faster."""
    across = ("right" in held) - ("left" in held)
    along = ("ahead" in held) - ("back" in held)
    rise = (("up" in held) - ("down" in held)) if walker.flying else 0
    ahead = forward(walker.yaw, walker.pitch if walker.flying else 0.0)
    right = (math.cos(walker.yaw), 0.0, math.sin(walker.yaw))
    wish = [along * ahead[i] + across * right[i] + rise * (i == 1) for i in range(3)]
    length = math.hypot(*wish)
    if length < 1e-9:
        return 0.0, 0.0, 0.0
    slow, fast = (FLY, FLY_FAST) if walker.flying else (WALK, RUN)
    speed = (fast if "run" in held else slow) / length
    return wish[0] * speed, wish[1] * speed, wish[2] * speed


def moved(walker: Walker, held: AbstractSet[Move], dt: float, ground: Ground, /) -> Walker:
    """Return the walker after `dt` [s] of the held keys, with eased speed, on the terrain.

    The result does not depend on how the time is cut into frames, as long as the keys and the look stay.
    """
    shifts, speeds = zip(
        *(_eased(v, ask, dt) for v, ask in zip(walker.velocity, asked_velocity(walker, held), strict=True)),
        strict=True,
    )
    x0, y0, z0 = walker.position
    x, z, free_x, free_z = on_terrain(x0 + shifts[0], z0 + shifts[2], ground)
    floor = ground.height(x, z)
    if walker.flying:
        y = max(y0 + shifts[1], floor + LOWEST)
    else:
        above = y0 - ground.height(x0, z0)
        y = floor + EYE + (above - EYE) * math.exp(-dt / LANDING)
    velocity = (speeds[0] * free_x, speeds[1] * walker.flying, speeds[2] * free_z)
    return replace(walker, position=(x, y, z), velocity=velocity)


def toggled(walker: Walker, /) -> Walker:
    """Return the walker taking off or landing."""
    return replace(walker, flying=not walker.flying)


def settled(walker: Walker, ground: Ground, /) -> Walker:
    """Return the walker moved onto another ground, at the nearest place that is on the terrain and not below it."""
    x, z, _, _ = on_terrain(walker.position[0], walker.position[2], ground)
    floor = ground.height(x, z)
    y = max(walker.position[1], floor + LOWEST) if walker.flying else floor + EYE
    return replace(walker, position=(x, y, z))


def on_terrain(x: float, z: float, ground: Ground, /) -> tuple[float, float, bool, bool]:
    """Return the place on the terrain nearest to (x, z) [m], and whether x and whether z are unchanged."""
    wide, deep = (max(0.0, side / 2.0 - MARGIN) for side in ground.size)
    inside_x, inside_z = max(-wide, min(wide, x)), max(-deep, min(deep, z))
    return inside_x, inside_z, inside_x == x, inside_z == z


def _eased(velocity: float, asked: float, dt: float) -> tuple[float, float]:
    """Return displacement [m] and velocity [m/s] after `dt` [s] of exponential approach to the asked velocity."""
    left = math.exp(-dt / REACTION)
    return asked * dt + (velocity - asked) * REACTION * (1.0 - left), asked + (velocity - asked) * left


def _bounded(pitch: float) -> float:
    return max(-STEEPEST, min(STEEPEST, pitch))
