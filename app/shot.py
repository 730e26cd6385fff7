"""One picture, headless."""

import math
import sys
from dataclasses import replace
from pathlib import Path

from ..engine.camera import Camera
from ..engine.scene import LoadedScene, read_scene
from .grow import grow_ahead
from .studio.encode import picture_writer
from .studio.errors import InputError
from .studio.progress import busy
from .studio.studio import Studio, about, written
from .studio.take import Take


def shot(take: Take, output: str, *, time: float = 0.0, camera: Camera | None = None) -> None:
    """Draw one picture of a scene at `time` [s] into a PNG file, with metadata as text entries.

    The default camera is the scene's fixed one. The angle of view of `camera` is replaced by the scene's.
    Raises InputError where `output` cannot be written, `SceneError` where the scene is wrong.
    """
    write = picture_writer(output)
    _spare(output, read_scene(take.scene))
    grow_ahead(take.scene, preset=take.preset)
    with busy("growing the prairie"), Studio(take) as studio:
        studio.prairie.advance(time)
        view = math.radians(studio.prairie.scene.camera.view)
        place = studio.camera(None) if camera is None else replace(camera, view=view)
        x, y, z = place.position
        depth = float(studio.prairie.height_at([(x, z)])[0]) - y
        if depth > 0.0:
            print(f"the camera is {depth:.1f} m below the ground: y is a height in the scene", file=sys.stderr)
        metadata = about(studio.prairie.scene, take, time=studio.prairie.time)
        write(studio.picture(place), {**metadata, "camera": written(place)})


def _spare(output: str, loaded: LoadedScene) -> None:
    """Raise InputError where a picture would replace a file that its scene reads."""
    for name, path in loaded.paths.items():
        if Path(output).resolve() == path.resolve():
            raise InputError(f"-o: {output}: the scene reads '{name}': choose another name")
