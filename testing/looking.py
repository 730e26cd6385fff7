"""Somebody who looks at a prairie."""

from math import radians
from reprlib import repr as shortened

from ..engine.camera import Camera


def looking(x: float, y: float, z: float, *, yaw: float = 0.0, pitch: float = 0.0, view: float = 45.0) -> Camera:
    """Return a camera at a place [m], y counted from 0 and not from the ground.

    `yaw`, `pitch` and the vertical angle of `view` are in degrees: yaw 0 looks down -z and a positive one turns right;
    a positive pitch looks up.
    """
    return Camera((x, y, z), radians(yaw), radians(pitch), radians(view))


def must_be_camera(thing: object, /) -> None:
    """Raise TypeError for what is no camera."""
    if not isinstance(thing, Camera):
        raise TypeError(f"a camera is made by looking(x, y, z), unlike {shortened(thing)}")
