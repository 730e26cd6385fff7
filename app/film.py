"""A scene's camera path with its wind timeline, headless, at a fixed step."""

from collections.abc import Iterator

from .manifest import Manifest, Span
from .studio.encode import Picture, Reel, film_writer
from .studio.errors import InputError
from .studio.progress import busy, counted
from .studio.studio import Studio, about
from .studio.take import Take

STILL_SECONDS = 8.0
"""How long a film is whose camera has no path [s]."""

Frames = tuple[int, int | None]
"""The first frame, and the one after the last; None is the film's end."""


def film(take: Take, output: str, *, seconds: float | None = None, fps: int = 24, frames: Frames = (0, None)) -> None:
    """Film a scene from its time 0 on: frame k shows the time k / fps [s]. A manifest stands beside the film.

    Without `seconds` it lasts as long as the camera's path. Of `frames` only these are drawn; they are those of the
    whole film byte for byte, so that several machines can share it. Frames are drawn as they are written. Raises
    InputError where `output` cannot hold such a film or the film has no such frames, `SceneError` where the scene is
    wrong.
    """
    write = film_writer(output, take.size, fps)
    with busy("growing the prairie"):
        studio = Studio(take)
    with studio:
        span = _span(studio, seconds, fps, frames)
        manifest, count = Manifest(span), span.end - span.first
        drawn = counted(_frames(studio, span), total=count, doing="filming")
        told = {**about(studio.prairie, take), "time": f"{span.first / fps:.6g}"}
        write(Reel(manifest.noted(drawn), count, fps, told, span.first))
        renderer = str(studio.ctx.info["GL_RENDERER"])
        manifest.write(output, studio.prairie, take, renderer=renderer)


def _span(studio: Studio, seconds: float | None, fps: int, frames: Frames) -> Span:
    count = max(1, round((_length(studio) if seconds is None else seconds) * fps))
    first, end = frames
    if first >= count or (end or 0) > count:
        raise InputError(f"--frames: {first}:{end or ''}: the film has the frames 0:{count}")
    return Span(first, count if end is None else end, count, fps)


def _length(studio: Studio) -> float:
    path = studio.prairie.scene.camera.path
    return path[-1].at if path and path[-1].at > 0.0 else STILL_SECONDS


def _frames(studio: Studio, span: Span) -> Iterator[Picture]:
    for number in range(span.end):
        time = number / span.fps
        studio.prairie.advance(time - studio.prairie.time)
        if number < span.first:
            studio.follow(studio.camera(time))
        else:
            yield studio.picture(studio.camera(time))
