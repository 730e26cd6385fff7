"""A prairie before a camera, without a window, for stills and films."""

import math
from pathlib import Path

from ... import __version__
from ...components.arrays import Floats
from ...engine.camera import Camera, camera_at, projection_matrix, view_matrix
from ...engine.declared.scene import Scene
from ...engine.scene import LoadedScene, read_scene
from ...systems.overlay.overlay import Overlay
from ...systems.prairie import Prairie
from ...systems.reference import draw_truth
from .encode import Picture
from .offscreen import Offscreen
from .take import SAMPLES, Take


class Studio(Offscreen):
    """A prairie, and a framebuffer of the take's size to draw it into; a context manager.

    The scene is `loaded` if given, else the take's. Raises `SceneError` where the scene is wrong,
    MachineError where there is no OpenGL.
    """

    def __init__(self, take: Take, loaded: LoadedScene | None = None) -> None:
        super().__init__(take.size)  # first: without it, nothing is grown in vain
        self.take = take
        try:
            loaded = read_scene(take.scene) if loaded is None else loaded
            self.prairie = Prairie(loaded, preset=take.preset, lod=take.lod, live=False)
        except BaseException:
            self.release()
            raise
        self.overlay = Overlay(take.overlay)

    def __exit__(self, *_: object) -> None:
        self.make_current()
        self.overlay.release()
        self.prairie.release()
        self.release()

    def camera(self, time: float | None) -> Camera:
        """Return the scene's camera: on its path at `time` [s], or with None its fixed place."""
        return camera_at(self.prairie.scene.camera, time, self.prairie.height_at)

    def matrices(self, camera: Camera) -> tuple[Floats, Floats]:
        """Return the camera's view and projection matrices for pictures of the take's size."""
        width, height = self.size
        return view_matrix(camera), projection_matrix(camera.view, width / height)

    def follow(self, camera: Camera) -> None:
        """Let the prairie go through this instant as `picture` does, without drawing."""
        self.prairie.follow(*self.matrices(camera))

    def picture(self, camera: Camera) -> Picture:
        """Draw the prairie at this instant from a camera, and return the picture."""
        view, projection = self.matrices(camera)
        self.begin()
        self.prairie.draw(view, projection, depth="none")
        if self.take.reference:
            return draw_truth(self.prairie, view, projection, self.take.size, samples=SAMPLES).picture
        self.overlay.draw(self.prairie, view, projection)
        return self.read()


def about(scene: Scene, take: Take, *, time: float) -> dict[str, str]:
    """Return the metadata of a picture's or film's file: scene, seed, version and instant [s]."""
    return {
        "Software": f"tallgrass {__version__}",
        "version": __version__,
        "scene": Path(take.scene).stem,
        "seed": str(scene.seed),
        "time": f"{time:.6g}",
    }


def written(camera: Camera) -> str:
    """Return a camera as text for `tallgrass shot --camera`."""
    looks = (*camera.position, math.degrees(camera.yaw), math.degrees(camera.pitch))
    return ",".join(f"{number:.10g}" for number in looks)
