"""A scene's camera path with its wind timeline, headless, at a fixed step."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from ..engine.declared.scene import Scene
from ..engine.scene import read_scene
from .grow import grow_ahead
from .manifest import Manifest, Span
from .studio.encode import Reel, film_writer, is_folder, make_room
from .studio.errors import InputError
from .studio.progress import busy, counted
from .studio.shooting import Shooting, Shot
from .studio.studio import about
from .studio.take import Take

STILL_SECONDS = 8.0
"""Default duration of a film whose camera has no path [s]."""

Frames = tuple[int, int | None]
"""The first frame, and the one after the last or None for the film's end."""


def film(
    take: Take,
    output: str,
    *,
    seconds: float | None = None,
    fps: int = 24,
    frames: Frames = (0, None),
    on: str | None = None,
) -> None:
    """Film a scene from its time 0 on: frame k shows the time k / fps [s]. A manifest stands beside the film.

    Without `seconds` it lasts as long as the camera's path. Of `frames` only these are drawn; they are those of the
    whole film byte for byte, so that several machines can share it. Frames are drawn as they are written: here, or on
    the workers that `on` names, as `farm.hands.hired` takes it. Raises InputError where `output` cannot hold such a
    film or the film has no such frames, `SceneError` where the scene is wrong, MachineError where nothing can draw it.
    """
    write = film_writer(output, take.size, fps)
    loaded = read_scene(take.scene)
    span = _span(loaded.scene, seconds, fps, frames)
    metadata = about(loaded.scene, take, time=span.first / fps)
    files = metadata if is_folder(output) else None
    manifest, count = Manifest(span), span.end - span.first
    make_room(manifest.place(output))
    if on is None:
        shooting = _shot_here(take, span, files)
    else:
        from .farm.film import shot_on

        shooting = shot_on(on, take, loaded, span, files)
    with shooting as shots:
        drawn = counted(shots, total=count, doing="filming")
        write(Reel(manifest.noted(drawn), count, fps, metadata, span.first))
    manifest.write(output, loaded, take)


def _span(scene: Scene, seconds: float | None, fps: int, frames: Frames) -> Span:
    path = scene.camera.path
    length = path[-1].at if path and path[-1].at > 0.0 else STILL_SECONDS
    count = max(1, round((length if seconds is None else seconds) * fps))
    first, end = frames
    if first >= count or (end or 0) > count:
        raise InputError(f"--frames: {first}:{end or ''}: the film has the frames 0:{count}")
    return Span(first, count if end is None else end, count, fps)


@contextmanager
def _shot_here(take: Take, span: Span, files: Mapping[str, str] | None) -> Iterator[Iterator[Shot]]:
    grow_ahead(take.scene, preset=take.preset)
    with busy("growing the prairie"):
        shooting = Shooting(take, span.fps)
    with shooting:
        yield shooting.shots(span.first, span.end, files=files)
