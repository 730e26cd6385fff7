"""A scene's camera path with its wind timeline, headless, at a fixed step."""

from collections.abc import Iterator

from .encode import Picture, Reel, film_writer
from .progress import busy, counted
from .studio import Studio, about
from .take import Take

STILL_SECONDS = 8.0
"""How long a film is whose camera has no path [s]."""


def film(take: Take, output: str, *, seconds: float | None = None, fps: int = 24) -> None:
    """Film a scene from its time 0 on: frame k shows the time k / fps [s].

    Without `seconds` it lasts as long as the camera's path. Frames are drawn as they are written. Raises InputError
    where `output` cannot hold such a film, `SceneError` where the scene is wrong.
    """
    write = film_writer(output, take.size, fps)
    with busy("growing the prairie"):
        studio = Studio(take)
    with studio:
        count = max(1, round((_length(studio) if seconds is None else seconds) * fps))
        frames = counted(_frames(studio, count, fps), total=count, doing="filming")
        write(Reel(frames, count, fps, about(studio.prairie, take)))


def _length(studio: Studio) -> float:
    path = studio.prairie.scene.camera.path
    return path[-1].at if path and path[-1].at > 0.0 else STILL_SECONDS


def _frames(studio: Studio, count: int, fps: int) -> Iterator[Picture]:
    for number in range(count):
        time = number / fps
        studio.prairie.advance(time - studio.prairie.time)
        yield studio.picture(studio.camera(time))
