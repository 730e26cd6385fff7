"""View and projection matrices, and camera paths in time."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from reprlib import repr as shortened

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Doubles, Floats, Place, Point
from .curve import Curve
from .declared.camera import CameraSource, Stop
from .handed import FARTHEST, as_floats

Heights = Callable[[Floats], Floats]
"""Returns heights [m], shape (n,), at ground positions (x, z) [m], shape (n, 2)."""

NEAR = 0.1
"""Distance of the near plane [m]: a viewer stands in the grass."""

FAR = 5000.0
"""Distance of the far plane [m]; with `NEAR`, 24 bits of depth still resolve 6 mm at 100 m."""

OUTERMOST = 1e9
"""Largest coordinate of an eye that a game hands in [m]: cells are counted in 32 bits."""

LARGEST = float(np.finfo(np.float32).max)
"""Largest number of single precision, in which shaders get the matrices."""


@dataclass(frozen=True, slots=True)
class Camera:
    """The camera of one instant: right-handed, y up, looking down its own -z."""

    position: tuple[float, float, float]
    """Eye (x, y, z) [m]."""

    yaw: float
    """0 looks down -z, positive turns right [rad]."""

    pitch: float
    """Positive looks up [rad]."""

    view: float
    """Vertical angle of view [rad]."""


@dataclass(frozen=True, eq=False)
class View:
    """View and projection matrix of a picture; never write to them."""

    view: NDArray[np.float32]
    """World to eye, shape (4, 4), column vectors: `view @ (x, y, z, 1)`."""

    projection: NDArray[np.float32]
    """Eye to clip space, shape (4, 4), column vectors."""

    @property
    def clip(self) -> Doubles:
        """World to clip space, shape (4, 4), column vectors."""
        return np.asarray(self._numbers[0, 2])

    @property
    def unclip(self) -> Doubles:
        """Clip space to the world, shape (4, 4), column vectors; raises LinAlgError where there is no way back."""
        return np.asarray(self._numbers[1, 2])

    @property
    def eye(self) -> tuple[float, float, float]:
        """Position of the eye (x, y, z) [m]; raises LinAlgError where a matrix has no inverse."""
        x, y, z = self._numbers[1, 0, :3, 3].tolist()
        return x, y, z

    @property
    def is_usable(self) -> bool:
        """Whether a picture can be drawn with it: `view_of` says what must hold."""
        try:
            return bool(max(map(abs, self.eye)) <= OUTERMOST and np.abs(self._numbers[:, 2]).max() <= LARGEST)
        except np.linalg.LinAlgError:
            return False

    @cached_property
    def _numbers(self) -> Doubles:
        """View, projection and their product, and the inverse of each, shape (2, 3, 4, 4)."""
        numbers = np.empty((2, 3, 4, 4))
        matrices, inverses = numbers
        matrices[0], matrices[1] = self.view, self.projection
        np.matmul(matrices[1], matrices[0], out=matrices[2])
        inverses[:] = np.linalg.inv(matrices)  # in one call a frame: a call costs more than its arithmetic
        return numbers


def forward(yaw: float, pitch: float, /) -> tuple[float, float, float]:
    """Return the unit vector in which a camera of this yaw and pitch [rad] looks: yaw 0 is -z, 90° is +x."""
    return math.sin(yaw) * math.cos(pitch), math.sin(pitch), -math.cos(yaw) * math.cos(pitch)


def ahead(place: Place, yaw: float, way: float, /) -> Place:
    """Return the place on the ground at a distance `way` [m] from another along a yaw [rad]."""
    return place[0] + way * math.sin(yaw), place[1] - way * math.cos(yaw)


def is_mirrored(view: View, /) -> bool | None:
    """Return whether a view shows a mirror image of the world, as for a reflection in water.

    It is None for a view without perspective, where this is unknown.
    """
    (a, b, c, _), (d, e, f, _), _, (g, h, i, _) = view.clip.tolist()
    handedness = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)  # of the axes right, up and ahead
    return handedness > 0.0 if handedness else None


def is_reversed(view: View, /) -> bool:
    """Return whether depth decreases with distance in a view, as in a projection for `GL_GREATER`."""
    (a, b), (c, d) = view.projection[2:, 2:].tolist()
    slope = a * d - b * c  # of depth along the eye's z; with perspective, times a positive factor
    return bool(slope * c < 0.0 if c else slope > 0.0)


def view_matrix(camera: Camera, /) -> Floats:
    """Return the matrix from the world to the eye, shape (4, 4), for column vectors."""
    ahead = np.array(forward(camera.yaw, camera.pitch))
    right = np.array([math.cos(camera.yaw), 0.0, math.sin(camera.yaw)])
    axes = np.stack([right, np.cross(right, ahead), -ahead])
    matrix = np.eye(4)
    matrix[:3, :3] = axes
    matrix[:3, 3] = -axes @ np.array(camera.position)
    return matrix.astype(np.float32)


def projection_matrix(view_angle: float, aspect: float, /) -> Floats:
    """Return the perspective matrix from the eye to clip space, shape (4, 4), for column vectors.

    `view_angle` is the vertical angle of view [rad], `aspect` the image's width over its height. Depth follows OpenGL:
    -1 at `NEAR`, 1 at `FAR`.
    """
    scale = 1.0 / math.tan(view_angle / 2.0)
    depth = FAR - NEAR
    return np.array(
        [
            [scale / aspect, 0.0, 0.0, 0.0],
            [0.0, scale, 0.0, 0.0],
            [0.0, 0.0, -(FAR + NEAR) / depth, -2.0 * FAR * NEAR / depth],
            [0.0, 0.0, -1.0, 0.0],
        ],
        np.float32,
    )


def camera_at(source: CameraSource, time: float | None, height_at: Heights, /) -> Camera:
    """Return a scene's camera on its path at `time` [s]; at its fixed place where `time` is None or there is no path.

    Before the first stop and after the last one the camera rests. The eye is `source.eye` above the ground; a target's
    height counts from the ground under it.
    """
    if time is None or not source.path:
        place: Doubles = np.array(source.position, np.float64)
        eye = _above(place, source.eye, height_at)
        yaw, pitch = _look(source, eye, height_at)
    else:
        times = np.array([stop.at for stop in source.path], np.float64)
        place = glide(times, np.array([stop.position for stop in source.path], np.float64), time)
        eye = _above(place, source.eye, height_at)
        yaw, pitch = _look_on_path(source, times, time, eye, height_at)
    return Camera((float(eye[0]), float(eye[1]), float(eye[2])), yaw, pitch, math.radians(source.view))


def glide(times: Doubles, values: Doubles, time: float, /) -> Doubles:
    """Return the value at one time on the `Curve` through all `values`, shape (k,).

    `times` rise, shape (n,); `values` have shape (n, k).
    """
    return np.array(Curve.through(times, values).at(time))


def parse_camera(text: str, /, *, view: float) -> Camera:
    """Return the camera written as `X,Y,Z,YAW,PITCH`: metres with an absolute y, and degrees.

    `view` is the vertical angle of view [rad]. Raises ValueError with a sentence that says what is wrong.
    """
    parts = text.split(",")
    if len(parts) != 5:
        raise ValueError(f"{text!r} is not five numbers X,Y,Z,YAW,PITCH")
    x, y, z, yaw, pitch = (_number(part) for part in parts)
    if max(abs(x), abs(y), abs(z)) > FARTHEST:
        raise ValueError(f"{text!r} lies beyond {FARTHEST:.0f} m")
    if abs(yaw) > 3600.0:
        raise ValueError(f"yaw {yaw:g} is not between -3600 and 3600 degrees")
    if abs(pitch) > 90.0:
        raise ValueError(f"pitch {pitch:g} is not between -90 and 90 degrees")
    return Camera((x, y, z), math.radians(yaw), math.radians(pitch), view)


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"{text.strip()!r} is not a number") from None
    if not math.isfinite(number):
        raise ValueError(f"{text.strip()!r} is not a finite number")
    return number


def _above(place: Doubles, height: float, height_at: Heights) -> Doubles:
    ground = float(height_at(np.array([place], np.float32))[0])
    return np.array([place[0], ground + height, place[1]])


def _target(target: list[float], height_at: Heights) -> Doubles:
    x, height, z = target
    return _above(np.array([x, z]), height, height_at)


def _angles(eye: Doubles, target: Doubles) -> tuple[float, float]:
    """Return yaw and pitch [rad] of the look from one point to another; straight up or down, yaw is 0."""
    x, y, z = (target - eye).tolist()
    flat = math.hypot(x, z)
    return (math.atan2(x, -z) if flat > 0.0 else 0.0), math.atan2(y, flat)


def _look(stop: CameraSource | Stop, eye: Doubles, height_at: Heights) -> tuple[float, float]:
    if stop.target is None:
        return math.radians(stop.yaw), math.radians(stop.pitch)
    return _angles(eye, _target(stop.target, height_at))


def _look_on_path(
    source: CameraSource, times: Doubles, time: float, eye: Doubles, height_at: Heights
) -> tuple[float, float]:
    targets = [_target(stop.target, height_at) for stop in source.path if stop.target is not None]
    if len(targets) == len(source.path):
        return _angles(eye, glide(times, np.stack(targets), time))
    looks: list[tuple[float, float]] = []
    for stop in source.path:
        yaw, pitch = _look(stop, _above(np.array(stop.position), source.eye, height_at), height_at)
        if stop.target is not None and looks:
            yaw += math.tau * round((looks[-1][0] - yaw) / math.tau)
        looks.append((yaw, pitch))
    yaw, pitch = glide(times, np.array(looks), time).tolist()
    return yaw, max(-math.pi / 2, min(math.pi / 2, pitch))


def view_of(view: object, projection: object, origin: Point = (0.0, 0.0, 0.0)) -> View:
    """Return the two matrices as numpy arrays for column vectors.

    Each is a 4x4 array, or pyglet's `Mat4`, whose 16 numbers run column by column. Where `view` scales, as for a game
    in centimetres, the scale is moved into the projection. `origin` is the scene's origin in the world of `view` [m];
    it is subtracted in double precision, so that large coordinates cancel. Raises ValueError for anything but 16 finite
    numbers, a singular matrix, a view with perspective, an eye beyond a million kilometres, and a product beyond single
    precision.
    """
    one, other = _matrix(view, "view"), _matrix(projection, "projection")
    if any(origin):
        moved = np.asarray(view, np.float64)
        moved = (moved.reshape(4, 4).T if moved.shape == (16,) else moved).copy()
        moved[:, 3] = moved @ (*origin, 1.0)
        one = moved.astype(np.float32)
    return _usable(one.tobytes(), other.tobytes())


def as_origin(place: object, /) -> Point:
    """Return a scene's origin [m]. Raises ValueError for anything but three numbers up to `OUTERMOST`."""
    due = "an origin is a place (x, y, z) [m]"
    found = as_floats(place, due)
    if found.shape != (3,) or np.abs(found).max() > OUTERMOST:
        raise ValueError(f"{due} no farther off than {OUTERMOST:.0e} m, not {shortened(place)}")
    x, y, z = np.asarray(place, np.float64).tolist()
    return x, y, z


ROUNDING = 1e-3
"""Tolerance for the zeros in the last row of a view matrix, and for its scale, for rounding of single precision."""


@lru_cache(maxsize=16)
def _usable(view: bytes, projection: bytes) -> View:
    """Return the view of two matrices' bytes, row by row; cached, so that equal matrices give the same object."""
    seen = View(*(np.frombuffer(each, np.float32).reshape(4, 4) for each in (view, projection)))
    if np.abs(seen.view[3, :3]).max() > ROUNDING:
        raise ValueError(
            "the view matrix has perspective: give the view first, with a last row of 0 0 0 1, then the projection"
        )
    if not seen.is_usable:
        _must_be_usable(seen)
    scale = math.hypot(*seen.view[2, :3].tolist())
    if abs(scale - 1.0) <= ROUNDING:
        return seen
    metres = np.array([scale, scale, scale, 1.0], np.float32)  # distances from the eye count in metres everywhere
    return View(seen.view / metres[:, None], seen.projection * metres)


def _must_be_usable(seen: View) -> None:
    """Raise ValueError for the first fault of a view's matrices."""
    for name, matrix in (("view", seen.view), ("projection", seen.projection)):
        if np.linalg.det(matrix.astype(np.float64)) == 0.0:
            raise ValueError(f"the {name} matrix has no inverse")
    if np.abs(np.linalg.inv(seen.view.astype(np.float64))[:3, 3]).max() > OUTERMOST:
        raise ValueError(f"the view matrix has its eye beyond {OUTERMOST:.0e} m")
    raise ValueError("the product of the view and projection matrices overflows or underflows single precision")


def _matrix(matrix: object, name: str) -> NDArray[np.float32]:
    due = f"the {name} matrix must have 4 x 4 finite numbers"
    array = as_floats(matrix, due)
    if array.shape == (16,):
        array = array.reshape(4, 4).T
    if array.shape != (4, 4):
        raise ValueError(f"{due}, not {array.shape}")
    return array


FAR_OFF = 2e4
"""Distance of a light with parallel rays [m]: single precision still resolves centimetres there."""


def light_from(view: View, place: tuple[float, float, float], /) -> tuple[float, float, float]:
    """Return the position of a light whose view this is [m]; for parallel rays, `FAR_OFF` from a place."""
    if view.projection[3, :3].any():
        return view.eye
    x, y, z = (float(at + FAR_OFF * part) for at, part in zip(place, view.view[2, :3], strict=True))
    return x, y, z
