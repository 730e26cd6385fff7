"""Drawing in tests: a camera, a GL context without a window, and a small framebuffer."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import radians
from reprlib import repr as shortened

import moderngl
import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Floats
from ..engine.camera import Camera, camera_at, projection_matrix, view_matrix
from ..engine.gl.headless import standalone_context
from ..engine.gl.stream import release_all
from ..systems.prairie import Prairie

Picture = NDArray[np.float64]


def looking(x: float, y: float, z: float, *, yaw: float = 0.0, pitch: float = 0.0, view: float = 45.0) -> Camera:
    """Return a camera at a position (x, y, z) [m]; y is absolute, not above the ground.

    `yaw`, `pitch` and the vertical angle of `view` are in degrees: yaw 0 looks down -z and a positive one turns right;
    a positive pitch looks up.
    """
    return Camera((x, y, z), radians(yaw), radians(pitch), radians(view))


def must_be_camera(thing: object, /) -> None:
    """Raise TypeError for anything but a camera."""
    if not isinstance(thing, Camera):
        raise TypeError(f"a camera is made by looking(x, y, z), unlike {shortened(thing)}")


@contextmanager
def headless_context() -> Iterator[moderngl.Context]:
    """Make a context of OpenGL 3.3 or newer without a window, and release it in the end.

    A small framebuffer is bound in it, as there is no window to draw into. A software rasteriser will do. Raises
    NoContextError, a RuntimeError of one sentence that says what to install, where there is no OpenGL. A second context
    becomes current in place of the first: make one for a whole run of tests.
    """
    ctx = standalone_context()
    try:
        ctx.simple_framebuffer((1, 1)).use()
        yield ctx
    finally:
        ctx.release()


class Stage:
    """A framebuffer of 8-bit RGB colour and depth, as a host's; `size` is (width, height) [pixels].

    Raises ValueError for a size without pixels.
    """

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int] = (160, 90)) -> None:
        if min(size) < 1:
            raise ValueError(f"a stage has 1 by 1 pixels at least, not {size[0]} by {size[1]}")
        self.ctx, self.size = ctx, size
        self.color, self.depth_map = ctx.texture(size, 3, alignment=1), ctx.depth_texture(size)
        self.target = ctx.framebuffer([self.color], self.depth_map)

    def matrices(self, camera: Camera, /) -> tuple[Floats, Floats]:
        """Return a camera's view and projection matrix for this stage's size, shape (4, 4) each."""
        must_be_camera(camera)
        width, height = self.size
        return view_matrix(camera), projection_matrix(camera.view, width / height)

    def shot(self, prairie: Prairie, camera: Camera | None = None) -> Picture:
        """Draw a prairie from a camera, by default the scene's own; return display colours from 0 to 255.

        The picture has its top row first, shape (height, width, 3).
        """
        seen = camera_at(prairie.scene.camera, None, prairie.height_at) if camera is None else camera
        self.begin()
        prairie.draw(*self.matrices(seen))
        return self.read()

    def begin(self) -> None:
        """Bind the framebuffer and clear it, for drawing."""
        self.target.use()
        self.target.clear(depth=1.0)

    def read(self) -> Picture:
        """Return the picture: display colours from 0 to 255, top row first, shape (height, width, 3)."""
        width, height = self.size
        data = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8)
        return data.reshape(height, width, 3)[::-1].astype(np.float64)

    def depth(self) -> Floats:
        """Return the depth of each pixel, 1 for sky, top row first, shape (height, width)."""
        width, height = self.size
        return np.frombuffer(self.depth_map.read(alignment=1), np.float32).reshape(height, width)[::-1]

    def ground(self, camera: Camera, level: float = 0.0) -> NDArray[np.float64]:
        """Return the intersection (x, z) [m] of each pixel's ray with the plane y = `level` [m], (height, width, 2).

        Above the horizon it is NaN.
        """
        width, height = self.size
        view, projection = self.matrices(camera)
        x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
        rays = np.stack([x / projection[0, 0], y / projection[1, 1], -np.ones_like(x)], -1) @ view[:3, :3]
        down = np.where(rays[..., 1] < -1e-6, rays[..., 1], np.nan)
        reach = (level - camera.position[1]) / down
        return np.asarray(np.array(camera.position)[[0, 2]] + reach[..., None] * rays[..., ::2])

    def project(self, camera: Camera, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points (x, y, z) [m] (n, 3) in the picture: column and row [pixels] from the top left, (n, 2)."""
        view, projection = self.matrices(camera)
        clip = np.column_stack([place, np.ones(len(place))]) @ (projection.astype(float) @ view).T
        across, up = clip[:, 0] / clip[:, 3], clip[:, 1] / clip[:, 3]
        return np.stack([(across + 1) / 2 * self.size[0], (1 - up) / 2 * self.size[1]], 1)

    def release(self) -> None:
        """Delete the framebuffer."""
        release_all(self.target, self.color, self.depth_map)


@contextmanager
def stage(ctx: moderngl.Context, size: tuple[int, int] = (160, 90)) -> Iterator[Stage]:
    """Make a `Stage` of a size [pixels] in a context, and release it in the end.

    Raises ValueError for a size without pixels.
    """
    made = Stage(ctx, size)
    try:
        yield made
    finally:
        made.release()
