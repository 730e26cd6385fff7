"""Paths through a scene: places at times, and interpolation between them."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, radians
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from ...components.declaration import Declaration, DeclarationError, Pair
from ...components.pose import Pose
from ..curve import Curve
from ..memo import by_identity

_MOMENT = 0.05
"""Time before and after over which the direction of travel is measured [s]."""


class Timed(Declaration):
    """One point of a path."""

    at: float = Field(ge=0.0, le=36000.0)
    """Time at this point [s]."""

    position: Pair
    """Ground position (x, z) [m]."""


class Waypoint(Timed):
    """One point of the path of a wind, a presser or a lamp."""

    yaw: float | None = Field(default=None, ge=-3600.0, le=3600.0)
    """Heading, as a camera's yaw [degrees]; without it, along the path."""


def check_times(path: Sequence[Timed], /) -> None:
    """Raise DeclarationError if the times of a path do not rise."""
    for i, (before, stop) in enumerate(pairwise(path), 1):
        if stop.at <= before.at:
            raise DeclarationError(f"at must be later than {before.at:g} s, the point before", "path", i, "at")


def pose_on(path: list[Waypoint], position: list[float], yaw: float, /, *, time: float) -> Pose:
    """Return the pose on a path at `time` [s]; for an empty path, that of a position [m] and a yaw [degrees]."""
    if not path:
        return Pose(position[0], position[1], radians(yaw))
    ways = _ways(path)
    x, z = ways.place.at(time)
    return Pose(x, z, _heading(ways, time, radians(yaw)))


class Placed(Declaration):
    """A thing at a fixed place, or on a path."""

    position: Pair = Field(default=[0.0, 0.0])
    """Ground position (x, z) of its middle [m]."""

    yaw: float = Field(default=0.0, ge=-3600.0, le=3600.0)
    """Heading, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    path: list[Waypoint] = Field(default=[], max_length=1000)
    """Places it goes through in time, instead of `position` and `yaw`; it waits before the first and after the last."""

    @model_validator(mode="after")
    def _rising_times(self) -> Self:
        check_times(self.path)
        return self

    def pose(self, *, time: float) -> Pose:
        """Return the pose at `time` [s]."""
        return pose_on(self.path, self.position, self.yaw, time=time)


@dataclass(frozen=True, slots=True)
class _Ways:
    """A path as curves."""

    place: Curve
    """Ground position (x, z) [m]."""

    yaw: Curve | None
    """Heading through those points of the path that declare one [degrees]; None if none does."""

    legs: list[tuple[float, float]]
    """Times of departure and arrival of each leg between different places [s]."""


@by_identity(most=512)  # a scene has up to 200 winds and 200 pressers: a smaller cache would miss each time
def _ways(path: list[Waypoint]) -> _Ways:
    times = np.array([stop.at for stop in path], np.float64)
    declared = [(stop.at, stop.yaw) for stop in path if stop.yaw is not None]
    turns, yaws = np.array(declared, np.float64).T if declared else (np.zeros(0), np.zeros(0))
    return _Ways(
        Curve.through(times, np.array([stop.position for stop in path], np.float64)),
        Curve.through(turns, yaws[:, None]) if declared else None,
        [(here.at, there.at) for here, there in pairwise(path) if here.position != there.position],
    )


def _heading(ways: _Ways, time: float, first: float) -> float:
    """Return the heading on a path [rad]: declared by its points, or else along the present, last or first leg."""
    if ways.yaw is not None:
        return radians(ways.yaw.at(time)[0])
    if not ways.legs:
        return first
    begin, end = next((leg for leg in reversed(ways.legs) if leg[0] <= time), ways.legs[0])
    moment = max(min(time, end - _MOMENT), begin + _MOMENT)
    after, before = ways.place.at(moment + _MOMENT), ways.place.at(moment - _MOMENT)
    return atan2(after[0] - before[0], -(after[1] - before[1]))
