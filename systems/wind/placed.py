"""Winds that are somewhere: at a fixed place, or on their way along a path (paper, section 3.3)."""

from typing import Self

from pydantic import Field, model_validator

from ...components.declaration import Pair
from ...components.pose import Pose
from ...components.wind import WindPrimitive
from ...engine.declared.way import Waypoint, check_times, pose_on


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
        check_times(self.path)
        return self

    def pose(self, *, time: float) -> Pose:
        """Return where its frame is at `time` [s]."""
        return pose_on(self.path, self.position, self.yaw, time=time)
