"""What a second viewer in a frame costs: each viewer's part of it, and what the same view costs alone."""

from dataclasses import replace
from math import cos, sin

import numpy as np

from ...engine.camera import Camera
from ..studio.progress import counted
from ..studio.studio import Studio
from ..studio.timing import timed
from .still import STEP, WARM_UP

FRAMES = 40
"""Frames measured."""

ASIDE = 5.0
"""How far each viewer stands to the right of the one before [m]."""


def side_by_side(studio: Studio, count: int, /) -> list[dict[str, object]]:
    """Return a row for each viewer, who stands beside the others and looks the same way: all in every frame.

    `frame_ms` is the median of its part of a frame, `ratio` that over the first viewer's, and `ratio_to_alone` that
    over what it costs where nobody else looks, taken in turn.
    """
    cameras = [_beside(studio.camera(None), number) for number in range(count)]
    together: list[list[float]] = [[] for _ in cameras]
    alone: list[list[float]] = [[] for _ in cameras]
    for frame in counted(range(WARM_UP + 2 * FRAMES), total=WARM_UP + 2 * FRAMES, doing="frames of all viewers"):
        studio.prairie.advance(STEP)
        measured, by_turns = frame >= WARM_UP, frame % 2
        for number, camera in enumerate(cameras):
            took = _part(studio, camera, f"viewer {number + 1}")
            if by_turns:  # once more at once: then nobody else has looked in between
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
