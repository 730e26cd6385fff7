"""The cost of several viewers in a frame: each viewer's part, against the same view alone."""

from dataclasses import replace
from math import cos, sin

import numpy as np

from ...engine.camera import Camera
from ..studio.progress import counted
from ..studio.studio import Studio
from ..studio.timing import timed
from .still import STEP, WARM_UP

FRAMES = 40
"""Number of frames measured in each way."""

ASIDE = 5.0
"""Distance of each viewer to the right of the one before [m]."""


def side_by_side(studio: Studio, count: int, /) -> list[dict[str, object]]:
    """Measure frames of `count` viewers, side by side and with one direction of view; return a row for each.

    `frame_ms` is the median time of its part of a frame. `ratio` is relative to the first viewer, `ratio_to_alone`
    relative to a frame without other viewers, measured alternately.
    """
    cameras = [_beside(studio.camera(None), number) for number in range(count)]
    together: list[list[float]] = [[] for _ in cameras]
    alone: list[list[float]] = [[] for _ in cameras]
    for frame in counted(range(WARM_UP + 2 * FRAMES), total=WARM_UP + 2 * FRAMES, doing="frames of all viewers"):
        studio.prairie.advance(STEP)
        measured, by_turns = frame >= WARM_UP, frame % 2
        for number, camera in enumerate(cameras):
            took = _part(studio, camera, f"viewer {number + 1}")
            if by_turns:  # again at once, so that no other viewer has looked in between
                took_alone = _part(studio, camera, f"viewer {number + 1}")
            if measured:
                (alone if by_turns else together)[number].append(took_alone if by_turns else took)
    medians = [float(np.median(times)) for times in together]
    return [
        {
            "name": f"viewer {number + 1}",
            "frame_ms": round(median, 3),
            "ratio": round(median / medians[0], 3),
            "ratio_to_alone": round(median / float(np.median(alone[number])), 3),
        }
        for number, median in enumerate(medians)
    ]


def _beside(camera: Camera, number: int) -> Camera:
    x, y, z = camera.position
    aside = ASIDE * number
    return replace(camera, position=(x + aside * cos(camera.yaw), y, z + aside * sin(camera.yaw)))


def _part(studio: Studio, camera: Camera, viewer: str) -> float:
    view, projection = studio.matrices(camera)

    def draw() -> None:
        studio.begin()
        studio.prairie.draw(view, projection, viewer=viewer)

    return timed(studio.ctx, draw)
