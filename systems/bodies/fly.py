"""How a thing that hovers on its jet flies: at what height, how it leans, and where its jet meets the ground."""

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from math import atan2, cos, hypot, pi, sin, tan, tanh
from types import NoneType
from typing import cast

import numpy as np

from ...components.body import Body, Hover, Model
from ...components.pose import Pose
from ...components.wind import WindPrimitive, WindSource
from ...engine.camera import Heights
from ...engine.memo import by_identity
from ...engine.world import World
from ..wind.blow import is_on
from ..wind.quarantine import Quarantine, QuarantinedError

Flat = tuple[float, float]
"""A vector over the ground (x, z)."""

Path = Callable[[float], Pose]
"""Where something is on the ground and where it heads, at a time [s]."""

HOVER = 2.0
"""Height of a saucer's middle above the grass (paper, section 3.3) [m]."""

LOWEST = 1.0
"""Least height of its middle above any grass under it [m]."""

REACH = 3.0
"""How far around the grass is levelled for it, so that it glides over bumps [m]."""

GRAVITY = 9.81
"""[m/s²]."""

DRAG = 0.15
"""How the air holds it back: deceleration for each speed [1/s]."""

STEEPEST = 0.5
"""The tilt that it comes near to and never reaches [rad]."""

GLANCE = 0.3
"""How far before and after an instant a path is looked at [s]."""

_ANGLES = np.arange(8) * (pi / 4)
_AROUND = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)]) * REACH
_UNDER = np.concatenate([np.zeros((1, 2)), 0.5 * _AROUND, _AROUND]).astype(np.float32)


def carried(path: Path, time: float, top_at: Heights, /, *, height: float = HOVER, model: Model = "saucer") -> Body:
    """Return the body that flies along a path, at one time [s] and at a height above the top of the grass [m].

    It leans as the path's velocity and acceleration ask for, taken from differences over `GLANCE`.
    """
    before, here, after = (path(time + shift) for shift in (-GLANCE, 0.0, GLANCE))
    velocity = (after.x - before.x) / (2.0 * GLANCE), (after.z - before.z) / (2.0 * GLANCE)
    gain = (after.x - 2.0 * here.x + before.x) / GLANCE**2, (after.z - 2.0 * here.z + before.z) / GLANCE**2
    nose, bank = lean(velocity, gain, here.yaw)
    y = level(here.x, here.z, top_at, height=height)
    return Body((here.x, y, here.z), here.yaw, nose, bank, model)


def level(x: float, z: float, top_at: Heights, /, *, height: float = HOVER) -> float:
    """Return how high something flies (y) [m] that keeps a height [m] above the grass around (x, z).

    `top_at` says how high the top of the grass is. It is levelled over a disc of radius `REACH`; nothing under that
    disc comes nearer than `LOWEST`.
    """
    top = top_at(np.array([x, z], np.float32) + _UNDER).astype(np.float64)
    mean, most = np.add.reduce(top) / len(top), np.maximum.reduce(top)  # as `mean` and `max`, which are slow for few
    return max(float(mean) + height, float(most) + LOWEST)


def lean(velocity: Flat, gain: Flat, yaw: float, /) -> tuple[float, float]:
    """Return the nose and the bank [rad] of a saucer whose jet pushes it along.

    `velocity` [m/s] and `gain`, the acceleration [m/s²], are along x and z. Its up leans the way in which it is
    pushed, by up to `STEEPEST`.
    """
    push = gain[0] + DRAG * velocity[0], gain[1] + DRAG * velocity[1]
    much = hypot(*push)
    if much < 1e-9:
        return 0.0, 0.0
    tilt = STEEPEST * tanh(atan2(much, GRAVITY) / STEEPEST)
    ahead = (sin(yaw) * push[0] - cos(yaw) * push[1]) / much
    right = (cos(yaw) * push[0] + sin(yaw) * push[1]) / much
    # Nose and bank are turned one after the other: these are the two whose up leans by `tilt` in that direction.
    nose = -atan2(sin(tilt) * ahead, cos(tilt))
    return nose, atan2(sin(tilt) * right, hypot(sin(tilt) * ahead, cos(tilt)))


def foot(body: Body, height_at: Heights, /) -> Pose:
    """Return where the jet of a body meets the ground, which heads as the body does.

    The jet leaves it downwards along its own axis: it is displaced by the height times the tangent of the tilt.
    """
    x, y, z = body.place
    height = y - float(height_at(np.array([[x, z]], np.float32))[0])
    ahead, right = height * tan(body.nose), -height * tan(body.bank) / cos(body.nose)
    c, s = cos(body.yaw), sin(body.yaw)
    return Pose(x + s * ahead + c * right, z - c * ahead + s * right, body.yaw)


def hover_of(source: WindSource, quarantine: Quarantine, /) -> Hover | None:
    """Return what a wind says of the thing that hovers over it; raises QuarantinedError where it fails to."""
    if type(source.primitive).hover is WindPrimitive.hover:
        return None  # most winds leave it at that, and are asked several times a frame
    hover = quarantine.ask(source, "hover", source.primitive.hover)
    quarantine.must_be(source, "hover", hover, Hover, NoneType)
    return hover


def hovering(
    source: WindSource, top_at: Heights, quarantine: Quarantine, /, *, time: float, pose: Pose | None = None
) -> Body | None:
    """Return what hovers over a wind at `time` [s]: at a pose, or else along the wind's own path.

    That is None for most winds, and for any before it begins and after it ends. Raises QuarantinedError where the wind
    fails to say.
    """
    hover = hover_of(source, quarantine)
    if hover is None or not quarantine.ask(source, "its timeline", partial(is_on, source.primitive, time)):
        return None

    def path(moment: float) -> Pose:
        return pose or quarantine.ask_pose(source, time=moment)

    known, asked = _flown(source), (time, pose, top_at, hover)
    if known[0] != asked:  # the wind is asked where it blows, and what flies where it is drawn
        known[:] = asked, carried(path, time, top_at, height=hover.height, model=hover.model)
    return cast(Body, known[1])


@by_identity(most=256)
def _flown(_: WindSource) -> list[object]:
    """Return what was asked last of what hovers over a wind, and the answer."""
    return [None, None]


def may_fly(world: World, quarantine: Quarantine, /) -> bool:
    """Return whether anything flies, or hovers over a wind whenever that blows."""
    if any(True for _ in world.all(Body)):
        return True
    for _, source in world.all(WindSource):
        with suppress(QuarantinedError):
            if hover_of(source, quarantine) is not None:
                return True
    return False


def flying(world: World, top_at: Heights, quarantine: Quarantine, /, *, time: float) -> list[Body]:
    """Return what is in the air at `time` [s]: the bodies that entities have, and what hovers over winds.

    The latter flies where the wind is, along its path or with the pose of its entity, over the top of the grass.
    """
    own = dict(world.all(Body))
    bodies = list(own.values())
    for entity, source in world.all(WindSource):
        if entity not in own:
            with suppress(QuarantinedError):
                if hover_of(source, quarantine) is None:
                    continue
                pose = world.find(entity, Pose)
                if pose is not None and not world.stands(entity, pose, "the wind"):
                    continue
                body = hovering(source, top_at, quarantine, time=time, pose=pose)
                if body is not None:
                    bodies.append(body)
    return bodies
