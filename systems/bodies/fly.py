"""Flight of a body on its jet: height, attitude, and the foot of the jet on the ground."""

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
"""Position and heading over the ground, by time [s]."""

HOVER = 2.0
"""Height of a saucer's middle above the grass (paper, section 3.3) [m]."""

LOWEST = 1.0
"""Smallest height of a saucer's middle above any grass under it [m]."""

LEVEL_RADIUS = 3.0
"""Radius over which the height of the grass is averaged, so that a saucer glides over bumps [m]."""

GRAVITY = 9.81
"""[m/s²]."""

DRAG = 0.15
"""Deceleration by drag, per speed [1/s]."""

STEEPEST = 0.5
"""Asymptote of the tilt [rad]."""

PATH_STEP = 0.3
"""Time step of the finite differences along a path [s]."""

_ANGLES = np.arange(8) * (pi / 4)
_AROUND = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)]) * LEVEL_RADIUS
_UNDER = np.concatenate([np.zeros((1, 2)), 0.5 * _AROUND, _AROUND]).astype(np.float32)


def carried(path: Path, time: float, top_at: Heights, /, *, height: float = HOVER, model: Model = "saucer") -> Body:
    """Return the body that flies along a path, at one time [s] and at a height above the top of the grass [m].

    Its tilt follows from the path's velocity and acceleration, by differences over `PATH_STEP`.
    """
    before, here, after = (path(time + shift) for shift in (-PATH_STEP, 0.0, PATH_STEP))
    velocity = (after.x - before.x) / (2.0 * PATH_STEP), (after.z - before.z) / (2.0 * PATH_STEP)
    acceleration = (
        (after.x - 2.0 * here.x + before.x) / PATH_STEP**2,
        (after.z - 2.0 * here.z + before.z) / PATH_STEP**2,
    )
    nose, bank = lean(velocity, acceleration, here.yaw)
    y = level(here.x, here.z, top_at, height=height)
    return Body((here.x, y, here.z), here.yaw, nose, bank, model)


def level(x: float, z: float, top_at: Heights, /, *, height: float = HOVER) -> float:
    """Return the height y [m] of a body that keeps a height [m] above the grass around (x, z).

    `top_at` gives the height of the grass's top, which is averaged over a disc of radius `LEVEL_RADIUS`. The body stays
    at least `LOWEST` above the highest grass in that disc.
    """
    top = top_at(np.array([x, z], np.float32) + _UNDER).astype(np.float64)
    mean, most = np.add.reduce(top) / len(top), np.maximum.reduce(top)  # as `mean` and `max`, which are slow for few
    return max(float(mean) + height, float(most) + LOWEST)


def lean(velocity: Flat, acceleration: Flat, yaw: float, /) -> tuple[float, float]:
    """Return nose and bank [rad] of a saucer that its jet pushes along.

    `velocity` [m/s] and `acceleration` [m/s²] are along x and z. The saucer's up tilts towards the push, by less than
    `STEEPEST`.
    """
    push = acceleration[0] + DRAG * velocity[0], acceleration[1] + DRAG * velocity[1]
    strength = hypot(*push)
    if strength < 1e-9:
        return 0.0, 0.0
    tilt = STEEPEST * tanh(atan2(strength, GRAVITY) / STEEPEST)
    ahead = (sin(yaw) * push[0] - cos(yaw) * push[1]) / strength
    right = (cos(yaw) * push[0] + sin(yaw) * push[1]) / strength
    # Nose and bank are turned one after the other; together they tilt the up by `tilt` towards the push.
    nose = -atan2(sin(tilt) * ahead, cos(tilt))
    return nose, atan2(sin(tilt) * right, hypot(sin(tilt) * ahead, cos(tilt)))


def foot(body: Body, height_at: Heights, /) -> Pose:
    """Return the foot of a body's jet on the ground, with the body's heading.

    The jet points down along the body's own axis, so its foot is displaced by the height times the tangent of the tilt.
    """
    x, y, z = body.place
    height = y - float(height_at(np.array([[x, z]], np.float32))[0])
    ahead, right = height * tan(body.nose), -height * tan(body.bank) / cos(body.nose)
    c, s = cos(body.yaw), sin(body.yaw)
    return Pose(x + s * ahead + c * right, z - c * ahead + s * right, body.yaw)


def hover_of(source: WindSource, quarantine: Quarantine, /) -> Hover | None:
    """Return a wind's `hover`, None for most winds; raise QuarantinedError where the wind fails."""
    if type(source.primitive).hover is WindPrimitive.hover:
        return None  # the common case, asked several times a frame
    hover = quarantine.ask(source, "hover", source.primitive.hover)
    quarantine.must_be(source, "hover", hover, Hover, NoneType)
    return hover


def hovering(
    source: WindSource, top_at: Heights, quarantine: Quarantine, /, *, time: float, pose: Pose | None = None
) -> Body | None:
    """Return the body that hovers over a wind at `time` [s], at a pose or else on the wind's own path.

    It is None for most winds, and for all before they begin and after they end. Raise QuarantinedError where the wind
    fails.
    """
    hover = hover_of(source, quarantine)
    if hover is None or not quarantine.ask(source, "its timeline", partial(is_on, source.primitive, time)):
        return None

    def path(moment: float) -> Pose:
        return pose or quarantine.ask_pose(source, time=moment)

    last, question = _last_answer(source), (time, pose, top_at, hover)
    if last[0] != question:  # both blowing and drawing ask in a frame
        last[:] = question, carried(path, time, top_at, height=hover.height, model=hover.model)
    return cast(Body, last[1])


@by_identity(most=256)
def _last_answer(_: WindSource) -> list[object]:
    """Return the last question about a wind's body and its answer, as a list that the caller updates."""
    return [None, None]


def may_fly(world: World, quarantine: Quarantine, /) -> bool:
    """Return whether there is a body, or a wind with one that hovers over it."""
    if any(True for _ in world.all(Body)):
        return True
    for _, source in world.all(WindSource):
        with suppress(QuarantinedError):
            if hover_of(source, quarantine) is not None:
                return True
    return False


def flying(world: World, top_at: Heights, quarantine: Quarantine, /, *, time: float) -> list[Body]:
    """Return the bodies in the air at `time` [s]: those of entities, and those that hover over winds.

    The latter follow the wind, along its path or with its entity's pose, over the top of the grass.
    """
    of_entities = dict(world.all(Body))
    bodies = list(of_entities.values())
    for entity, source in world.all(WindSource):
        if entity not in of_entities:
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
