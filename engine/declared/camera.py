"""The camera of a scene."""

from pydantic import Field, model_validator

from ...components.declaration import Declaration, Pair, Triple
from .way import Timed, check_times


class Stop(Timed):
    """One point of a camera path."""

    target: Triple | None = None
    """Point looked at (x, height above its ground, z) [m]; without it yaw and pitch hold."""

    yaw: float = Field(default=0.0, ge=-3600.0, le=3600.0)
    """Viewing direction: 0 looks down -z, positive turns right [degrees]."""

    pitch: float = Field(default=0.0, ge=-89.0, le=89.0)
    """Viewing elevation, positive looks up [degrees]."""


class CameraSource(Declaration):
    """The camera of a scene: at a fixed place, or on a path walked in time."""

    position: Pair = Field(default=[0.0, 0.0])
    """Ground position (x, z) [m]."""

    eye: float = Field(default=1.7, ge=0.1, le=500.0)
    """Height of the eye above the ground [m]."""

    target: Triple | None = None
    """Point looked at (x, height above its ground, z) [m]; without it yaw and pitch hold."""

    yaw: float = Field(default=0.0, ge=-3600.0, le=3600.0)
    """Viewing direction: 0 looks down -z, positive turns right [degrees]."""

    pitch: float = Field(default=0.0, ge=-89.0, le=89.0)
    """Viewing elevation, positive looks up [degrees]."""

    view: float = Field(default=40.0, ge=5.0, le=120.0)
    """Vertical angle of view [degrees]."""

    path: list[Stop] = Field(default=[], max_length=1000)
    """Places walked through in time; the fixed place is where a picture is taken from."""

    @model_validator(mode="after")
    def _rising_times(self) -> "CameraSource":
        check_times(self.path)
        return self
