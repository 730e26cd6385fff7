"""Winds that the window's viewer sets off at the place it looks at."""

from itertools import count
from math import degrees, isnan, remainder, tau
from typing import Literal

import numpy as np

from ..components.wind import WindPrimitive
from ..engine.camera import Camera, ahead, forward
from ..engine.declared.way import Waypoint
from ..engine.terrain.pick import pick
from ..engine.terrain.record import Terrain
from ..systems.prairie import Prairie
from ..systems.wind.blast import Blast, Shape
from ..systems.wind.gust import Gust
from ..systems.wind.whirlwind import Whirlwind
from .studio.walker import Ground, on_terrain

Raised = Literal["gust", "whirlwind", "blast"]
"""Kinds of wind that keys set off."""

FARTHEST = 60.0
"""Largest distance of a new wind [m]."""

AHEAD = 20.0
"""Distance of a new wind when the viewer looks at the sky [m]."""

GUST_WIDTH, GUST_REACH = 24.0, 50.0
"""Width of a gust's front, and length of its path [m]."""

SPIN_TIME, SPIN_WAY = 9.0, 8.0
"""Duration of a whirlwind [s], and length of its path [m]."""

BLAST_TIME, BLAST_RADIUS = 1.6, 5.0
"""Duration of a single blast [s], and its radius [m]."""


def looked_at(camera: Camera, ground: Ground, terrain: Terrain, /) -> tuple[float, float]:
    """Return the ground position (x, z) [m] at which a camera's ray meets the terrain.

    Without an intersection within `FARTHEST` it is the ground `AHEAD`.
    """
    eye, ray = np.array([camera.position]), np.array([forward(camera.yaw, camera.pitch)])
    x, _, z = pick(terrain, eye, ray, farthest=FARTHEST)[0].tolist()
    if isnan(x):
        x, z = ahead(camera.position[::2], camera.yaw, AHEAD)
    return on_terrain(x, z, ground)[:2]


def raised(kind: Raised, place: tuple[float, float], yaw: float, time: float, /) -> WindPrimitive:
    """Return a wind that begins at `time` [s] at a place (x, z) [m], moves along `yaw` [rad], and ends."""
    x, z = place
    yaw = remainder(yaw, tau)
    if kind == "gust":
        gust = Gust(position=[x, z], direction=degrees(yaw), width=GUST_WIDTH, reach=GUST_REACH, start=time)
        return gust.model_copy(update={"stop": time + gust.life})
    if kind == "blast":
        disc = Shape(disc=BLAST_RADIUS)
        return Blast(position=[x, z], outline=disc, start=time, stop=time + BLAST_TIME, ease=0.35)
    end = [*ahead(place, yaw, SPIN_WAY)]
    path = [Waypoint(at=time, position=[x, z]), Waypoint(at=time + SPIN_TIME, position=end)]
    return Whirlwind(path=path, start=time, stop=time + SPIN_TIME, ease=1.0)


class Weather:
    """The running winds that keys have set off in a prairie."""

    def __init__(self, prairie: Prairie) -> None:
        self._prairie = prairie
        self._numbers = count(1)
        self._ends: dict[int, float] = {}

    def __len__(self) -> int:
        return len(self._ends)

    def raise_wind(self, kind: Raised, camera: Camera, ground: Ground) -> None:
        """Set off a wind where a camera looks."""
        terrain = self._prairie.site.ground.terrain
        wind = raised(kind, looked_at(camera, ground, terrain), camera.yaw, self._prairie.time)
        assert wind.stop is not None
        self._ends[self._prairie.add(wind, name=f"{kind} {next(self._numbers)}")] = wind.stop

    def settle(self) -> None:
        """Remove the winds that have ended."""
        for entity in [entity for entity, end in self._ends.items() if self._prairie.time >= end]:
            self._prairie.remove(entity)
            del self._ends[entity]
