"""One picture, headless."""

import math
from dataclasses import replace

from ..engine.camera import Camera
from .studio.encode import picture_writer
from .studio.progress import busy
from .studio.studio import Studio, about, written
from .studio.take import Take


def shot(take: Take, output: str, *, time: float = 0.0, camera: Camera | None = None) -> None:
    """Draw one picture of a scene at `time` [s] into a PNG file, whose text entries say how it was made.

    Without `camera` it is the scene's fixed place; of `camera`, the angle of view is left to the scene.
    Raises InputError where `output` cannot be written, `SceneError` where the scene is wrong.
    """
    write = picture_writer(output)
    with busy("growing the prairie"), Studio(take) as studio:
        studio.prairie.advance(time)
        view = math.radians(studio.prairie.scene.camera.view)
        place = studio.camera(None) if camera is None else replace(camera, view=view)
        told = about(studio.prairie.scene, take, time=studio.prairie.time)
        write(studio.picture(place), {**told, "camera": written(place)})
