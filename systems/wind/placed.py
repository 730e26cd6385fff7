"""Winds that are somewhere: at a fixed place, or on their way along a path (paper, section 3.3)."""

from dataclasses import dataclass
from itertools import pairwise
from math import atan2, radians
from typing import Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ...components.declaration import Declaration, DeclarationError, Pair
from ...components.pose import Pose
from ...components.wind import WindPrimitive
from ...engine.curve import Curve
from ...engine.memo import by_identity

Doubles = NDArray[np.float64]

_MOMENT = 0.05
"""Time on either side over which the direction of travel is taken [s]."""


class Waypoint(Declaration):
    """One point of a wind's path."""

    at: float = Field(ge=0.0, le=36000.0)
    """When it is here [s]."""

    position: Pair
    """Ground position (x, z) [m]."""

    yaw: float | None = Field(default=None, ge=-3600.0, le=3600.0)
    """Heading, as a camera's yaw; without it, where the path leads [degrees]."""


class PlacedWind(WindPrimitive):
    """A wind with a place of its own, that may travel and turn; its mask and action are asked in its own frame."""

    position: Pair = Field(default=[0.0, 0.0])
    """Ground position (x, z) of its middle [m]."""

    yaw: float = Field(default=0.0, ge=-3600.0, le=3600.0)
    """Heading, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    path: list[Waypoint] = Field(default=[], max_length=1000)
    """Places it goes through in time, instead of `position` and `yaw`; it waits before the first and after the last."""

    ease: float = Field(default=0.6, ge=0.0, le=60.0)
    """How long it takes to set in and to die down [s]; a wind that starts at 0 is there from the beginning."""

    @model_validator(mode="after")
    def _rising_times(self) -> Self:
        for i, (before, stop) in enumerate(pairwise(self.path), 1):
            if stop.at <= before.at:
                raise DeclarationError(f"at must be later than {before.at:g} s, the point before", "path", i, "at")
        return self

    def pose(self, *, time: float) -> Pose:
        """Return where its frame is at `time` [s]."""
        if not self.path:
            return Pose(self.position[0], self.position[1], radians(self.yaw))
        x, z = _ways(self.path).place.at(time)
        return Pose(x, z, _heading(self.path, time, radians(self.yaw)))


@dataclass(frozen=True, slots=True)
class _Ways:
    """A path as curves."""

    place: Curve
    """Ground position (x, z) [m]."""

    yaw: Curve | None
    """Heading, where points of the path declare it [degrees]."""

    legs: list[tuple[float, float]]
    """When it sets out and arrives on each leg that leads somewhere [s]."""


@by_identity(most=256)
def _ways(path: list[Waypoint]) -> _Ways:
    times = np.array([stop.at for stop in path], np.float64)
    declared = [(stop.at, stop.yaw) for stop in path if stop.yaw is not None]
    turns, yaws = np.array(declared, np.float64).T if declared else (np.zeros(0), np.zeros(0))
    return _Ways(
        Curve.through(times, np.array([stop.position for stop in path], np.float64)),
        Curve.through(turns, yaws[:, None]) if declared else None,
        [(here.at, there.at) for here, there in pairwise(path) if here.position != there.position],
    )


def along(path: list[Waypoint], time: float, /) -> Doubles:
    """Return the ground position (x, z) [m] on a path at `time` [s], shape (2,)."""
    return np.array(_ways(path).place.at(time))


def _heading(path: list[Waypoint], time: float, first: float) -> float:
    """Return the heading on a path [rad]: what its points declare, or else where it leads, last led, or will lead."""
    ways = _ways(path)
    if ways.yaw is not None:
        return radians(ways.yaw.at(time)[0])
    if not ways.legs:
        return first
    begin, end = next((leg for leg in reversed(ways.legs) if leg[0] <= time), ways.legs[0])
    moment = max(min(time, end - _MOMENT), begin + _MOMENT)
    after, before = ways.place.at(moment + _MOMENT), ways.place.at(moment - _MOMENT)
    return atan2(after[0] - before[0], -(after[1] - before[1]))
