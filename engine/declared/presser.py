"""Who walks through a scene's grass, as its file declares it."""

from dataclasses import fields
from typing import Self

from pydantic import Field, model_validator

from ...components.declaration import Declaration, DeclarationError, Pair
from ...components.pose import Pose
from ...components.presser import Presser
from .way import Waypoint, check_times, pose_on

LARGEST = 20.0

SHAPE = tuple(field.name for field in fields(Presser))
"""What a presser says of its shape; a scene may declare it under the same names."""


class PresserOnPath(Declaration):
    """A footprint that presses grass down, at a fixed place or on its way along a path."""

    radius: float = Field(default=0.3, ge=0.02, le=LARGEST)
    """Radius of a disc, and half the width of a capsule [m]."""

    length: float = Field(default=0.0, ge=0.0, le=LARGEST)
    """Distance between the middles of a capsule's round ends, along its heading [m]."""

    corners: list[Pair] = Field(default=[], max_length=64)
    """Corners (x, z) of a polygon, x to its right and -z ahead, instead of `radius` and `length` [m]."""

    strength: float = Field(default=1.0, ge=0.0, le=1.0)
    """How much it presses: 1 lays grass of stiffness 1 flat."""

    position: Pair = Field(default=[0.0, 0.0])
    """Ground position (x, z) of its middle [m]."""

    yaw: float = Field(default=0.0, ge=-3600.0, le=3600.0)
    """Heading, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    path: list[Waypoint] = Field(default=[], max_length=1000)
    """Places it goes through in time, instead of `position` and `yaw`; it waits before the first and after the last."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        check_times(self.path)
        try:
            self.footprint()
        except ValueError as error:
            raise DeclarationError(str(error), "corners") from error
        return self

    def footprint(self) -> Presser:
        """Return what it presses with."""
        return Presser(**{name: getattr(self, name) for name in SHAPE if name in type(self).model_fields})

    def pose(self, *, time: float) -> Pose:
        """Return where it is at `time` [s]."""
        return pose_on(self.path, self.position, self.yaw, time=time)
