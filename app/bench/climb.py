"""The climb that transitions are measured on besides the walk: up from eye height, and then a look straight down."""

import math
from dataclasses import replace

import numpy as np

from ...engine.camera import camera_at
from ...systems.prairie import Prairie
from ..studio.walker import EYE, FLY
from . import stroll
from .stroll import PITCH, REST, TURN, Leg

TOP = 60.0
"""How high above the ground it ends [m]."""

DOWN = math.radians(90.0)
"""How far below the horizon it looks in the end [rad]."""


def climb(prairie: Prairie, /) -> list[Leg]:
    """Return the climb over a prairie, at its camera's place: legs on which it rises, and then legs on which it tilts.

    Each begins where the one before ended, and all take as long as those of a walk; it is no faster than a flyer, and
    turns its head no faster than a walker.
    """
    rising = math.ceil((TOP - EYE) / (FLY * stroll.SECONDS))
    tilting = math.ceil((DOWN + PITCH) / (TURN * stroll.SECONDS))
    rise = (TOP - EYE) / (rising * stroll.SECONDS)
    tilt = (DOWN + PITCH) / (tilting * stroll.SECONDS)
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    half = np.asarray(prairie.site.ground.terrain.size) / 2.0
    x, z = np.clip(camera.position[::2], -half, half).tolist()

    plain = Leg("", 0.0, (x, z), camera.yaw, camera.yaw, pace=0.0)
    walk = []
    for number in range(rising):
        height = EYE + number * rise * stroll.SECONDS
        walk.append(replace(plain, name=f"up-{height:.0f}", height=height, rise=rise))
    for number in range(tilting):
        pitch = PITCH - number * tilt * stroll.SECONDS
        walk.append(replace(plain, name=f"tilt-{-math.degrees(pitch):.0f}", height=TOP, pitch=pitch, tilt=tilt))
    return [replace(leg, start=REST + number * (stroll.SECONDS + REST)) for number, leg in enumerate(walk)]
