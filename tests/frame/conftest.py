"""What the tests of whole frames share: a stage to draw small pictures on, and prairies that are grown once."""

from collections.abc import Callable, Iterator
from math import radians
from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.camera import Camera
from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix
from tallgrass.engine.gl.stream import release_all
from tallgrass.systems.prairie import Prairie

LITTLE = """\
tallgrass: 1
seed: 5
terrain: { noise: rolling, seed: 2, size: [60, 60], feature: 30, scale: 4 }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, root: "#5a5a2c", tip: "#dcc98f" }
  short: { height: [0.2, 0.4], width: 0.02, root: "#27401a", tip: "#8fae4a", stiffness: 2 }
wind:
  - { kind: breeze, strength: 0.4 }
camera: { position: [0, 20], eye: 1.7, pitch: -12, view: 45 }
quality:
  blades: 60
  models: 2
  blade_rings: [{ to: 1, segments: 3 }, { to: 2, segments: 2 }]
  strip_rings:
    - { to: 5, strips: 4, columns: 2, sections: 2, texel: 0.02 }
    - { to: 8, strips: 2, columns: 1, sections: 1, texel: 0.03 }
  carpet_to: 12
  carpet: 32
"""

Picture = NDArray[np.float64]
Load = Callable[..., Prairie]


class Stage:
    """A framebuffer to draw prairies into, as a host would."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]) -> None:
        self.ctx, self.size = ctx, size
        self.color, self.depth_map = ctx.texture(size, 3, alignment=1), ctx.depth_texture(size)
        self.target = ctx.framebuffer([self.color], self.depth_map)

    def matrices(self, camera: Camera) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """The camera's view and projection for this stage's size."""
        width, height = self.size
        return view_matrix(camera), projection_matrix(camera.view, width / height)

    def shot(self, prairie: Prairie, camera: Camera | None = None) -> Picture:
        """What a camera sees, or the scene's own: display colours 0 to 255, top row first, (height, width, 3)."""
        seen = camera_at(prairie.scene.camera, None, prairie.height_at) if camera is None else camera
        self.target.use()
        self.target.clear(depth=1.0)
        prairie.draw(*self.matrices(seen))
        return self.read()

    def read(self) -> Picture:
        """What has been drawn."""
        width, height = self.size
        data = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8)
        return data.reshape(height, width, 3)[::-1].astype(np.float64)

    def depth(self) -> NDArray[np.float32]:
        """How deep each pixel is, 1 where nothing but the sky is, top row first, (height, width)."""
        width, height = self.size
        return np.frombuffer(self.depth_map.read(alignment=1), np.float32).reshape(height, width)[::-1]

    def ground(self, camera: Camera, level: float = 0.0) -> NDArray[np.float64]:
        """Where each pixel's ray meets the plane y = `level`, (x, z), nan above the horizon, (height, width, 2)."""
        width, height = self.size
        view, projection = self.matrices(camera)
        x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
        rays = np.stack([x / projection[0, 0], y / projection[1, 1], -np.ones_like(x)], -1) @ view[:3, :3]
        down = np.where(rays[..., 1] < -1e-6, rays[..., 1], np.nan)
        reach = (level - camera.position[1]) / down
        return np.asarray(np.array(camera.position)[[0, 2]] + reach[..., None] * rays[..., ::2])

    def project(self, camera: Camera, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where points (n, 3) are in the picture: column and row, in pixels from the top left, (n, 2)."""
        view, projection = self.matrices(camera)
        clip = np.column_stack([place, np.ones(len(place))]) @ (projection.astype(float) @ view).T
        across, up = clip[:, 0] / clip[:, 3], clip[:, 1] / clip[:, 3]
        return np.stack([(across + 1) / 2 * self.size[0], (1 - up) / 2 * self.size[1]], 1)

    def release(self) -> None:
        release_all(self.target, self.color, self.depth_map)


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Iterator[Stage]:
    """A stage of 160 by 90 pixels."""
    made = Stage(ctx, (160, 90))
    yield made
    made.release()


@pytest.fixture(scope="module")
def load(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Load]:
    """Load a scene from its text, or a bundled one by its name; all are released in the end."""
    loaded: list[Prairie] = []

    def scene(text: str = LITTLE, **options: str) -> Prairie:
        path: str | Path = text
        if "\n" in text:
            path = tmp_path_factory.mktemp("scene") / "scene.yaml"
            Path(path).write_text(text, "utf-8")
        loaded.append(Prairie.load(path, ctx=ctx, **options))  # type: ignore[arg-type]
        return loaded[-1]

    yield scene
    for prairie in loaded:
        prairie.release()


def looking(x: float, y: float, z: float, *, yaw: float = 0.0, pitch: float = 0.0, view: float = 45.0) -> Camera:
    """A camera at a place [m], with its angles in degrees."""
    return Camera((x, y, z), radians(yaw), radians(pitch), radians(view))


@pytest.fixture(scope="session")
def camera() -> Callable[..., Camera]:
    """Make a camera: `camera(x, y, z, yaw=, pitch=, view=)`."""
    return looking
